//! `IterativeSolver`: GCR for saddle-point systems, with a direct solver as the last resort.

use alewife_interrupt::check;

use super::super::direct::DirectSolver;
use super::super::fingerprint::{Fingerprints, hash, hash_of_values};
use super::super::memory::{ForeignMemory, SolverMemory};
use super::super::solver::{Accuracy, LinearError, LinearSolver};
use super::data::{SaddlePoint, Weights};
use super::guess::EarlierSolutions;
use super::krylov_space::{Correction, KrylovSpace};
use super::mass_rows::{AIM, CYCLE, MassRows};
use super::matrix::SaddleMatrix;
use super::preconditioner::Preconditioner;
use super::scaled::{Iterate, Scaled};
use crate::sparse::SparseMatrix;
use crate::sparse::single::single;

/// When iterations end, and what happens then.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IterativeSettings {
    /// Euclidean norm of the residual over that of the right-hand side that is reached; momentum and
    /// mass are scaled against each other.
    pub tolerance: f64,
    /// Iterations after which GCR restarts.
    pub restart: usize,
    /// Iterations of one solution at most.
    pub max_iterations: usize,
    /// Entries of the factors up to which a direct solver takes over when iterations stall.
    pub max_factor_entries: usize,
}

impl Default for IterativeSettings {
    fn default() -> Self {
        // Factors of three gigabytes
        Self { tolerance: 1e-8, restart: 240, max_iterations: 480, max_factor_entries: 400_000_000 }
    }
}

/// Iterations after which the residual is looked at.
const LONG: usize = 60;
/// Part of the first residual that iterations without hope leave then.
const HOPELESS: f64 = 0.7;

/// GCR with the preconditioner of the last set-up.
#[derive(Debug)]
pub struct IterativeSolver {
    system: SaddlePoint,
    weights: Weights,
    settings: IterativeSettings,
    fingerprints: Fingerprints,
    /// Of the matrix and weights it was made for.
    set_up: Option<SetUp>,
    earlier: EarlierSolutions,
    marked: Marked,
    iterations: usize,
    /// Largest sum of the sizes of the residuals of pressures.
    mass_limit: f64,
    /// In place of everything else, once iterations have stalled.
    direct: Option<Box<Direct>>,
}

/// What it kept from system to system when that was marked.
#[derive(Debug, Default)]
struct Marked {
    earlier: EarlierSolutions,
    is_direct: bool,
}

/// A direct solver with the matrix in its form.
#[derive(Debug)]
struct Direct {
    solver: DirectSolver,
    matrix: SparseMatrix,
}

#[derive(Debug)]
struct SetUp {
    matrix: u64,
    preconditioner: Preconditioner,
    /// What the solutions with this matrix have been made of since it was set up or marked: the next ones,
    /// of other loads on the same bodies, meet the same few slow directions.
    space: KrylovSpace,
}

impl IterativeSolver {
    /// For the matrices of a system.
    ///
    /// # Panics
    /// When parts and weights have different numbers of unknowns.
    #[must_use]
    pub fn new(system: SaddlePoint, weights: Weights, settings: IterativeSettings) -> Self {
        let solver = Self {
            system,
            weights,
            settings,
            fingerprints: Fingerprints::default(),
            set_up: None,
            earlier: EarlierSolutions::default(),
            marked: Marked::default(),
            iterations: 0,
            mass_limit: f64::INFINITY,
            direct: None,
        };
        solver.weights.check(&solver.system);
        solver
    }

    /// Other weights, for matrices from now on.
    ///
    /// # Panics
    /// When they do not fit the unknowns.
    pub fn set_weights(&mut self, weights: Weights) {
        weights.check(&self.system);
        self.weights = weights;
        self.set_up = None;
    }

    /// The sum of the sizes of the residuals of pressures that solutions leave from now on at most, whatever part of
    /// the right-hand side that is; infinite at first.
    pub fn limit_mass(&mut self, limit: f64) {
        self.mass_limit = limit;
    }

    /// Iterations of the last solution.
    #[must_use]
    pub fn iterations(&self) -> usize {
        self.iterations
    }

    /// Whether a direct solver has taken over.
    #[must_use]
    pub fn is_direct(&self) -> bool {
        self.direct.is_some()
    }

    /// Memory of the preconditioner (bytes).
    #[must_use]
    pub fn n_bytes(&self) -> usize {
        self.set_up.as_ref().map_or(0, |set_up| set_up.preconditioner.n_bytes())
    }

    /// Marks what it keeps at present as its memory, which may be asked for later.
    pub fn mark(&mut self) {
        self.marked = Marked { earlier: self.earlier.clone(), is_direct: self.is_direct() };
        // No part of the memory: whoever recalls that continues without
        if let Some(set_up) = &mut self.set_up {
            set_up.space = KrylovSpace::default();
        }
        if let Some(direct) = &mut self.direct {
            direct.solver.mark();
        }
    }

    /// What it kept from system to system when that was marked; `matrix` is one of them.
    #[must_use]
    pub fn memory(&self, matrix: &SaddleMatrix) -> SolverMemory {
        let Marked { earlier, is_direct } = &self.marked;
        let direct = self.direct.as_ref().filter(|_| *is_direct);
        let direct = direct.map(|direct| direct.solver.memory());
        SolverMemory {
            solutions: earlier.iter().map(|x| matrix.numbering().values(x)).collect(),
            is_direct: *is_direct,
            ..direct.unwrap_or_default()
        }
    }

    /// Goes on as the solver of the same system whose memory it is; `matrix` is one of the system.
    ///
    /// # Errors
    /// When it is the memory of another system, or its matrix cannot be factorised.
    pub fn recall(
        &mut self,
        matrix: &SaddleMatrix,
        memory: &SolverMemory,
    ) -> Result<(), LinearError> {
        let n_unknowns = matrix.n();
        for solution in &memory.solutions {
            if solution.len() != n_unknowns {
                return Err(ForeignMemory { n_unknowns }.into());
            }
            let values: Vec<f64> = solution.iter().map(|&value| f64::from(value)).collect();
            self.earlier.keep(matrix.numbering().split(&values, |_, value| single(value)));
        }
        if memory.is_direct {
            let matrix = matrix.to_sparse();
            let mut solver = DirectSolver::new(&matrix.shared_pattern(), &self.system.unknowns())?;
            solver.recall(&matrix.shared_pattern(), memory)?;
            self.direct = Some(Box::new(Direct { solver, matrix }));
        }
        self.mark();
        Ok(())
    }

    /// Solves by GCR until the residual is `reduction` times the right-hand side.
    fn iterate(
        &mut self,
        matrix: &SaddleMatrix,
        rhs: &[f64],
        reduction: f64,
        uses_earlier: bool,
    ) -> Result<Iterated, LinearError> {
        let set_up = self.set_up.as_mut();
        let SetUp { preconditioner, space, .. } =
            set_up.expect("a matrix is set up before systems with it are solved");
        let mut system = Scaled { matrix, preconditioner };
        let initial = system.norm(rhs);
        let tolerance = reduction * initial;
        let mut iterate = Iterate { x: vec![0.0; rhs.len()], residual: rhs.to_vec() };
        let mut reached = initial;
        if uses_earlier && !self.earlier.is_empty() && initial > 0.0 {
            let guess = system.guess(&self.earlier, rhs, initial);
            let better = system.corrected(&iterate, rhs, initial, &guess);
            let norm = system.norm(&better.residual);
            if norm < reached {
                (iterate, reached) = (better, norm);
            }
        }
        let (mut iterations, start) = (0, reached);
        let limit = if uses_earlier { self.mass_limit } else { f64::INFINITY };
        let mut mass = MassRows::new(limit, self.system.has_held_pressure, tolerance);
        loop {
            check()?;
            if !reached.is_finite() {
                return Err(LinearError::NotFinite);
            }
            if reached <= mass.goal {
                if mass.is_met(&mut system, rhs, &mut iterate, &mut reached) {
                    break;
                }
                continue;
            }
            let left = self.settings.max_iterations.saturating_sub(iterations);
            let is_hopeless = iterations >= LONG && reached > HOPELESS * start;
            if reached <= tolerance && (left == 0 || is_hopeless) {
                break;
            }
            if left == 0 || is_hopeless {
                let stalled_at = Some(reached / initial);
                return Ok(Iterated { iterate, iterations, stalled_at });
            }
            if space.n_directions() >= self.settings.restart {
                *space = KrylovSpace::default();
            }
            let most = left.min(LONG).min(self.settings.restart - space.n_directions());
            let wanted = (AIM * mass.goal / reached).max(CYCLE);
            let b = system.single(&iterate.residual, reached);
            let Correction { x, iterations: more } =
                space.correction(&mut system, b, |iterations, residual| {
                    iterations < most && residual > wanted && check().is_ok()
                });
            iterations += more.max(1);
            iterate = system.corrected(&iterate, rhs, reached, &x);
            reached = system.norm(&iterate.residual);
            tracing::trace!(iterations, residual = reached / initial, "iterations");
        }
        Ok(Iterated { iterate, iterations, stalled_at: None })
    }

    /// A direct solver for the system, if its factors are small enough, once iterations have left a part
    /// of the right-hand side.
    fn take_over(&self, matrix: &SaddleMatrix, residual: f64) -> Result<Direct, LinearError> {
        let matrix = matrix.to_sparse();
        let solver = DirectSolver::new(&matrix.shared_pattern(), &self.system.unknowns())?;
        let n_factor_entries = solver.n_factor_entries();
        let (iterations, n_unknowns) = (self.iterations, matrix.n());
        if n_factor_entries > self.settings.max_factor_entries {
            return Err(LinearError::Stalled {
                residual,
                iterations,
                n_unknowns,
                n_factor_entries,
            });
        }
        tracing::warn!(
            "{iterations} iterations with {n_unknowns} unknowns leave {residual:.1e} of the right-hand \
             side; a direct solver takes over, with {n_factor_entries} entries of factors"
        );
        Ok(Direct { solver, matrix })
    }

    fn solved(
        &mut self,
        matrix: &SaddleMatrix,
        rhs: &mut [f64],
        reduction: f64,
        uses_earlier: bool,
    ) -> Result<Accuracy, LinearError> {
        if let Some(direct) = &mut self.direct {
            return direct.solver.solve(&direct.matrix, rhs);
        }
        if rhs.iter().any(|value| !value.is_finite()) {
            return Err(LinearError::NotFinite);
        }
        let Iterated { iterate, iterations, stalled_at } =
            self.iterate(matrix, rhs, reduction, uses_earlier)?;
        self.iterations = iterations;
        if let Some(residual) = stalled_at {
            let mut direct = self.take_over(matrix, residual)?;
            direct.solver.set_up(&direct.matrix)?;
            let accuracy = direct.solver.solve(&direct.matrix, rhs)?;
            self.direct = Some(Box::new(direct));
            return Ok(accuracy);
        }
        let largest = |values: &[f64]| values.iter().fold(0.0f64, |most, v| most.max(v.abs()));
        let size = largest(rhs);
        let residual = if size > 0.0 { largest(&iterate.residual) / size } else { 0.0 };
        rhs.copy_from_slice(&iterate.x);
        if uses_earlier {
            self.earlier.keep(matrix.numbering().split(&iterate.x, |_, value| single(value)));
        }
        tracing::debug!(iterations, residual, "solved by iterations");
        Ok(Accuracy { residual, refinements: iterations })
    }
}

/// What iterations have led to.
struct Iterated {
    iterate: Iterate,
    iterations: usize,
    /// Residual over the right-hand side, where it is too large.
    stalled_at: Option<f64>,
}

impl LinearSolver for IterativeSolver {
    type Matrix = SaddleMatrix;

    fn set_up(&mut self, matrix: &SaddleMatrix) -> Result<(), LinearError> {
        let of_part = |part: &[f32]| hash_of_values(part, |value| u64::from(value.to_bits()));
        let of_all = || hash(matrix.parts().into_iter().map(of_part));
        let hash = self.fingerprints.hash_of(matrix.revision(), of_all);
        if self.set_up.as_ref().is_some_and(|set_up| set_up.matrix == hash) {
            return Ok(());
        }
        self.set_up = None;
        if !matrix.is_finite() {
            return Err(LinearError::NotFinite);
        }
        if let Some(direct) = &mut self.direct {
            direct.matrix = matrix.to_sparse();
            return direct.solver.set_up(&direct.matrix);
        }
        check()?;
        let preconditioner = Preconditioner::new(&self.system, &self.weights, matrix);
        tracing::debug!(bytes = preconditioner.n_bytes(), "set up a preconditioner");
        let space = KrylovSpace::default();
        self.set_up = Some(SetUp { matrix: hash, preconditioner, space });
        Ok(())
    }

    fn solve(&mut self, matrix: &SaddleMatrix, rhs: &mut [f64]) -> Result<Accuracy, LinearError> {
        self.solve_to(matrix, rhs, self.settings.tolerance)
    }

    /// By the Euclidean norms of the scaled residual and right-hand side.
    fn solve_to(
        &mut self,
        matrix: &SaddleMatrix,
        rhs: &mut [f64],
        reduction: f64,
    ) -> Result<Accuracy, LinearError> {
        self.solved(matrix, rhs, reduction, true)
    }

    fn solve_with_earlier_set_up(
        &mut self,
        matrix: &SaddleMatrix,
        rhs: &mut [f64],
        typical: &[f64],
    ) -> Result<bool, LinearError> {
        // A set-up costs no more than a few iterations: one for each matrix
        match &mut self.direct {
            Some(direct) => {
                direct.matrix = matrix.to_sparse();
                direct.solver.solve_with_earlier_set_up(&direct.matrix, rhs, typical)
            }
            None => Ok(false),
        }
    }

    fn inverse_of_dense(
        &mut self,
        matrix: &SaddleMatrix,
        unknowns: &[usize],
    ) -> Result<Vec<f64>, LinearError> {
        if let Some(direct) = &mut self.direct {
            return direct.solver.inverse_of_dense(&direct.matrix, unknowns);
        }
        let mut inverse = Vec::with_capacity(unknowns.len() * unknowns.len());
        for &unknown in unknowns {
            let mut column = vec![0.0; matrix.n()];
            column[unknown] = 1.0;
            self.solved(matrix, &mut column, self.settings.tolerance, false)?;
            inverse.extend(unknowns.iter().map(|&row| column[row]));
        }
        Ok(inverse)
    }
}
