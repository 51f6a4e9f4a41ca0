//! `IterativeSolver`: FGMRES for saddle-point systems, with a direct solver as the last resort.

use super::super::direct::DirectSolver;
use super::super::fingerprint::Fingerprints;
use super::super::krylov::{fgmres, norm};
use super::super::solver::{Accuracy, LinearError, LinearSolver};
use super::data::{SaddlePoint, Weights};
use super::guess::{EarlierSolutions, Guess};
use super::numbering::{Numbering, Place};
use super::operator::{ColumnGroups, Operator};
use super::preconditioner::Preconditioner;
use crate::sparse::{Pattern, SparseMatrix};

/// When iterations end, and what happens then.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IterativeSettings {
    /// Euclidean norm of the residual over that of the right-hand side that is reached; momentum and
    /// mass are scaled against each other.
    pub tolerance: f64,
    /// Iterations after which FGMRES starts anew.
    pub restart: usize,
    /// Iterations of one solution at most.
    pub max_iterations: usize,
    /// Entries of the factors up to which a direct solver takes over when iterations stall.
    pub max_factor_entries: usize,
}

impl Default for IterativeSettings {
    fn default() -> Self {
        // Factors of three gigabytes
        Self { tolerance: 1e-8, restart: 60, max_iterations: 180, max_factor_entries: 400_000_000 }
    }
}

/// The residual that the sum of the corrections may leave beyond what was asked for, by rounding.
const ROUNDING: f64 = 2.0;

/// FGMRES with the preconditioner of the last set-up.
#[derive(Debug)]
pub struct IterativeSolver {
    system: SaddlePoint,
    weights: Weights,
    settings: IterativeSettings,
    numbering: Numbering,
    groups: ColumnGroups,
    fingerprints: Fingerprints,
    /// Of the matrix and weights it was made for.
    set_up: Option<SetUp>,
    earlier: EarlierSolutions,
    iterations: usize,
    /// In place of everything else, once iterations have stalled.
    direct: Option<Box<DirectSolver>>,
}

#[derive(Debug)]
struct SetUp {
    matrix: u64,
    preconditioner: Preconditioner,
    scales: Vec<f64>,
}

impl IterativeSolver {
    /// For the matrices of a pattern.
    ///
    /// # Panics
    /// When parts, weights and pattern have different numbers of unknowns.
    #[must_use]
    pub fn new(
        pattern: &Pattern,
        system: SaddlePoint,
        weights: Weights,
        settings: IterativeSettings,
    ) -> Self {
        assert_eq!(system.parts.len(), pattern.n(), "a part for each unknown");
        let numbering = Numbering::new(&system);
        let groups = ColumnGroups::new(pattern);
        let solver = Self {
            system,
            weights,
            settings,
            numbering,
            groups,
            fingerprints: Fingerprints::default(),
            set_up: None,
            earlier: EarlierSolutions::default(),
            iterations: 0,
            direct: None,
        };
        solver.check(&solver.weights);
        solver
    }

    /// Other weights, for matrices from now on.
    ///
    /// # Panics
    /// When they do not fit the unknowns.
    pub fn set_weights(&mut self, weights: Weights) {
        self.check(&weights);
        self.weights = weights;
        self.set_up = None;
    }

    fn check(&self, weights: &Weights) {
        let n = self.system.parts.len();
        let n_pressures =
            self.numbering.pressures.len() + usize::from(self.system.has_held_pressure);
        assert_eq!(weights.interpolation.n(), n, "a sum for each unknown");
        assert_eq!(weights.pressure_mass.n(), n_pressures, "a row for each pressure");
        if let Some(damping) = &weights.damping {
            assert_eq!(damping.len(), n, "a damping for each unknown");
        }
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

    /// Solves by FGMRES until the residual is `reduction` times the right-hand side.
    fn iterate(
        &mut self,
        matrix: &SparseMatrix,
        rhs: &[f64],
        reduction: f64,
        uses_earlier: bool,
    ) -> Result<Iterated, LinearError> {
        let Some(SetUp { preconditioner, scales, .. }) = &mut self.set_up else {
            return Err(LinearError::NotFinite);
        };
        let operator = Operator { matrix, groups: &self.groups, scales };
        let b: Vec<f64> =
            rhs.iter().zip(scales.iter()).map(|(value, scale)| value * scale).collect();
        let tolerance = reduction * norm(&b);
        let unscaled = |x: &[f64]| -> Vec<f64> {
            x.iter().zip(scales.iter()).map(|(value, scale)| value * scale).collect()
        };
        let Guess { mut x, mut residual } = if uses_earlier {
            self.earlier.guess(
                |x, y| {
                    let scaled: Vec<f64> =
                        x.iter().zip(scales.iter()).map(|(x, scale)| x / scale).collect();
                    operator.multiply(&scaled, y);
                },
                &b,
            )
        } else {
            Guess { x: vec![0.0; b.len()], residual: b.clone() }
        };
        // The guess is in the unknowns, the corrections are scaled
        for (x, scale) in x.iter_mut().zip(scales.iter()) {
            *x /= scale;
        }
        let mut iterations = 0;
        loop {
            let reached = norm(&residual);
            if !reached.is_finite() {
                return Err(LinearError::NotFinite);
            }
            if reached <= ROUNDING * tolerance {
                break;
            }
            let left = self.settings.max_iterations.saturating_sub(iterations);
            if left == 0 {
                let reached = reached / norm(&b);
                return Ok(Iterated { x: unscaled(&x), iterations, stalled_at: Some(reached) });
            }
            let most = left.min(self.settings.restart);
            let found = fgmres(
                |z: &[f32], y| operator.multiply(z, y),
                |r, z| preconditioner.apply(&self.numbering, scales, r, z),
                &residual,
                |iterations, residual| iterations < most && residual > tolerance,
            );
            iterations += found.iterations.max(1);
            for (x, correction) in x.iter_mut().zip(&found.x) {
                *x += correction;
            }
            operator.multiply(&x, &mut residual);
            for (residual, b) in residual.iter_mut().zip(&b) {
                *residual = b - *residual;
            }
        }
        Ok(Iterated { x: unscaled(&x), iterations, stalled_at: None })
    }

    /// Overwrites a right-hand side with the solution for the matrix of the last set-up, to a Euclidean norm
    /// of the residual over that of the right-hand side, in place of the one in the settings.
    ///
    /// # Errors
    /// When iterations stall, or a value is not finite.
    pub fn solve_to(
        &mut self,
        matrix: &SparseMatrix,
        rhs: &mut [f64],
        reduction: f64,
    ) -> Result<Accuracy, LinearError> {
        self.solved(matrix, rhs, reduction, true)
    }

    /// A direct solver for the system, if its factors are small enough.
    fn take_over(&self, matrix: &SparseMatrix, stall: &LinearError) -> Option<DirectSolver> {
        let direct = DirectSolver::new(matrix.pattern(), &self.system.unknowns());
        let entries = direct.n_factor_entries();
        let is_affordable = entries <= self.settings.max_factor_entries;
        if is_affordable {
            tracing::warn!(
                "{stall}; a direct solver takes over, with {entries} entries of factors"
            );
        }
        is_affordable.then_some(direct)
    }

    fn solved(
        &mut self,
        matrix: &SparseMatrix,
        rhs: &mut [f64],
        reduction: f64,
        uses_earlier: bool,
    ) -> Result<Accuracy, LinearError> {
        if let Some(direct) = &mut self.direct {
            return direct.solve(matrix, rhs);
        }
        if rhs.iter().any(|value| !value.is_finite()) {
            return Err(LinearError::NotFinite);
        }
        let Iterated { x, iterations, stalled_at } =
            self.iterate(matrix, rhs, reduction, uses_earlier)?;
        self.iterations = iterations;
        if let Some(residual) = stalled_at {
            let stall = LinearError::Stalled { residual, iterations, n_unknowns: rhs.len() };
            let Some(mut direct) = self.take_over(matrix, &stall) else { return Err(stall) };
            direct.set_up(matrix)?;
            let accuracy = direct.solve(matrix, rhs)?;
            self.direct = Some(Box::new(direct));
            return Ok(accuracy);
        }
        let residual = matrix.residual(&x, rhs).relative();
        rhs.copy_from_slice(&x);
        if uses_earlier {
            self.earlier.keep(x);
        }
        tracing::debug!(iterations, residual, "solved by iterations");
        Ok(Accuracy { residual, refinements: iterations })
    }
}

/// What iterations have led to.
struct Iterated {
    x: Vec<f64>,
    iterations: usize,
    /// Residual over the right-hand side, where it is too large.
    stalled_at: Option<f64>,
}

impl LinearSolver for IterativeSolver {
    fn set_up(&mut self, matrix: &SparseMatrix) -> Result<(), LinearError> {
        if let Some(direct) = &mut self.direct {
            return direct.set_up(matrix);
        }
        let hash = self.fingerprints.hash_of(matrix);
        if self.set_up.as_ref().is_some_and(|set_up| set_up.matrix == hash) {
            return Ok(());
        }
        self.set_up = None;
        if matrix.values().iter().any(|value| !value.is_finite()) {
            return Err(LinearError::NotFinite);
        }
        let preconditioner =
            Preconditioner::new(&self.system, &self.numbering, &self.weights, matrix);
        let scales = scales(matrix, &self.numbering);
        tracing::debug!(bytes = preconditioner.n_bytes(), "set up a preconditioner");
        self.set_up = Some(SetUp { matrix: hash, preconditioner, scales });
        Ok(())
    }

    fn solve(&mut self, matrix: &SparseMatrix, rhs: &mut [f64]) -> Result<Accuracy, LinearError> {
        self.solve_to(matrix, rhs, self.settings.tolerance)
    }

    fn solve_with_earlier_set_up(
        &mut self,
        matrix: &SparseMatrix,
        rhs: &mut [f64],
        typical: &[f64],
    ) -> Result<bool, LinearError> {
        // A set-up costs no more than a few iterations: one for each matrix
        match &mut self.direct {
            Some(direct) => direct.solve_with_earlier_set_up(matrix, rhs, typical),
            None => Ok(false),
        }
    }

    fn inverse_of_dense(
        &mut self,
        matrix: &SparseMatrix,
        unknowns: &[usize],
    ) -> Result<Vec<f64>, LinearError> {
        if let Some(direct) = &mut self.direct {
            return direct.inverse_of_dense(matrix, unknowns);
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

/// Factors of the equations that make those of momentum, mass, forces and torques weigh the same: rows and
/// columns of pressures get the ratio of the velocities' diagonal to the gradient, those of rotations the
/// inverse of the body's radius of resistance.
fn scales(matrix: &SparseMatrix, numbering: &Numbering) -> Vec<f64> {
    let pattern = matrix.pattern();
    let diagonal = |unknown: u32| {
        let entry = pattern.entry(unknown as usize, unknown as usize);
        entry.map_or(0.0, |entry| matrix.values()[entry].abs())
    };
    let mean = |blocks: &[[Option<u32>; 3]]| {
        let unknowns = || blocks.iter().flatten().flatten();
        unknowns().map(|&unknown| diagonal(unknown)).sum::<f64>() / unknowns().count().max(1) as f64
    };
    let velocity = mean(&numbering.blocks[..numbering.n_nodes]);
    let largest = |&unknown: &u32| {
        let values = &matrix.values()[pattern.entries(unknown as usize)];
        values.iter().fold(0.0f64, |most, value| most.max(value.abs()))
    };
    let gradient = numbering.pressures.iter().map(largest).sum::<f64>()
        / numbering.pressures.len().max(1) as f64;
    let positive = |value: f64| if value.is_normal() && value > 0.0 { value } else { 1.0 };
    let pressure = positive(velocity / gradient);
    let mut rotation = Vec::with_capacity(numbering.n_bodies);
    for blocks in numbering.blocks[numbering.n_nodes..].chunks_exact(2) {
        let [translation, turn] = [mean(&blocks[..1]), mean(&blocks[1..])];
        rotation.push(positive((translation / turn).sqrt()));
    }
    let scale = |place: &Place| match *place {
        Place::Pressure(_) => pressure,
        Place::Velocity { row, .. } => match (row as usize).checked_sub(numbering.n_nodes) {
            Some(row) if row % 2 == 1 => rotation[row / 2],
            _ => 1.0,
        },
    };
    numbering.places.iter().map(scale).collect()
}
