//! `LinearSystem`: matrix and solver of fluid and bodies on one mesh.

use std::sync::Arc;

use super::preconditioning::Coefficients;
use crate::algebra::{
    Accuracy, DirectSolver, IterativeSettings, IterativeSolver, LinearError, LinearSolver, Pattern,
    SaddlePoint, SparseMatrix, Term, Unknowns, Weights,
};
use crate::timing::{Stage, Timing};

/// Unknowns in space up to which factors cost less than iterations.
const DIRECT_IN_SPACE: usize = 7000;

/// By which method systems are solved.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum SolverChoice {
    /// By factors in the plane and for few unknowns in space, else by iterations.
    #[default]
    Automatic,
    /// By factors.
    Direct,
    /// By iterations.
    Iterative(IterativeSettings),
}

impl SolverChoice {
    /// The settings of an iterative solver, if this is one for such a system.
    fn iterative(self, dimension: usize, n_unknowns: usize) -> Option<IterativeSettings> {
        match self {
            Self::Direct => None,
            Self::Iterative(settings) => Some(settings),
            Self::Automatic => {
                (dimension == 3 && n_unknowns > DIRECT_IN_SPACE).then(IterativeSettings::default)
            }
        }
    }
}

/// A method with what it keeps from matrix to matrix.
enum Solver {
    Direct(Box<DirectSolver>),
    Iterative(Box<IterativeSolver>),
}

impl Solver {
    fn get(&mut self) -> &mut dyn LinearSolver {
        match self {
            Self::Direct(solver) => solver.as_mut(),
            Self::Iterative(solver) => solver.as_mut(),
        }
    }
}

/// The matrix last assembled, with what solves it.
pub(super) struct LinearSystem {
    matrix: SparseMatrix,
    solver: Option<Solver>,
    accuracy: Accuracy,
    saddle_point: SaddlePoint,
    unknowns: Unknowns,
    /// How the solver iterates, if it does.
    settings: Option<IterativeSettings>,
    /// What the weights of the solver were made for; none for another mesh.
    weighted_by: Option<Coefficients>,
}

impl LinearSystem {
    /// A zero matrix.
    pub(super) fn new(pattern: Arc<Pattern>, saddle_point: SaddlePoint, dimension: usize) -> Self {
        let settings = SolverChoice::Automatic.iterative(dimension, pattern.n());
        Self {
            matrix: SparseMatrix::zeros(pattern),
            solver: None,
            accuracy: Accuracy::default(),
            unknowns: saddle_point.unknowns(),
            saddle_point,
            settings,
            weighted_by: None,
        }
    }

    /// Another method from now on.
    pub(super) fn choose(&mut self, choice: SolverChoice, dimension: usize) {
        self.settings = choice.iterative(dimension, self.matrix.n());
        self.solver = None;
        self.weighted_by = None;
    }

    /// Takes note that the mesh has moved.
    pub(super) fn forget_weights(&mut self) {
        self.weighted_by = None;
    }

    /// Gives an iterative solver the weights for these coefficients, unless it has them.
    pub(super) fn prepare(
        &mut self,
        coefficients: Coefficients,
        weights: impl FnOnce() -> Weights,
        timing: &mut Timing,
    ) {
        let Some(settings) = self.settings else { return };
        if self.solver.is_some() && self.weighted_by == Some(coefficients) {
            return;
        }
        timing.measure(Stage::Factorisation, || match &mut self.solver {
            Some(Solver::Iterative(solver)) => solver.set_weights(weights()),
            Some(Solver::Direct(_)) | None => {
                let saddle_point = self.saddle_point.clone();
                let pattern = self.matrix.pattern();
                let solver = IterativeSolver::new(pattern, saddle_point, weights(), settings);
                self.solver = Some(Solver::Iterative(Box::new(solver)));
            }
        });
        self.weighted_by = Some(coefficients);
    }

    /// Memory of the preconditioner (bytes), zero with factors.
    pub(super) fn preconditioner_bytes(&self) -> usize {
        match &self.solver {
            Some(Solver::Iterative(solver)) => solver.n_bytes(),
            Some(Solver::Direct(_)) | None => 0,
        }
    }

    pub(super) fn pattern(&self) -> &Pattern {
        self.matrix.pattern()
    }

    /// The matrix last assembled.
    pub(super) fn matrix(&self) -> &SparseMatrix {
        &self.matrix
    }

    /// The values of the matrix, to be written.
    pub(super) fn values_mut(&mut self) -> &mut [f64] {
        self.matrix.values_mut()
    }

    /// What each unknown is.
    pub(super) fn unknowns(&self) -> &Unknowns {
        &self.unknowns
    }

    /// How well the last system was solved for which the matrix was factorised.
    pub(super) fn accuracy(&self) -> Accuracy {
        self.accuracy
    }

    /// Whether systems are solved by iterations: how accurately is then a choice.
    pub(super) fn is_iterative(&self) -> bool {
        self.settings.is_some()
    }

    /// Solves with the matrix, in place, for a correction of the free unknowns `free`. Iterations end at a
    /// residual of `reduction` times the right-hand side, by default that of the settings.
    pub(super) fn solve_correction(
        &mut self,
        free: &[f64],
        rhs: &mut [f64],
        reduction: Option<f64>,
        timing: &mut Timing,
    ) -> Result<(), LinearError> {
        let (matrix, unknowns) = (&self.matrix, &self.unknowns);
        let solver = timing.measure(Stage::Factorisation, || {
            self.solver.get_or_insert_with(|| analyse(matrix, unknowns))
        });
        if let (Solver::Iterative(solver), Some(reduction)) = (&mut *solver, reduction) {
            timing.measure(Stage::Factorisation, || solver.set_up(matrix))?;
            let solved = timing.measure(Stage::Solve, || solver.solve_to(matrix, rhs, reduction));
            self.accuracy = solved?;
            return Ok(());
        }
        let solver = solver.get();
        let is_solved =
            timing.measure(Stage::Solve, || solver.solve_with_earlier_set_up(matrix, rhs, free))?;
        if !is_solved {
            timing.measure(Stage::Factorisation, || solver.set_up(matrix))?;
            self.accuracy = timing.measure(Stage::Solve, || solver.solve(matrix, rhs))?;
        }
        Ok(())
    }

    /// Solves with factors of the matrix, in place.
    pub(super) fn solve(
        &mut self,
        rhs: &mut [f64],
        timing: &mut Timing,
    ) -> Result<(), LinearError> {
        let Factorised { matrix, solver } = self.factorised(timing)?;
        timing.measure(Stage::Solve, || solver.solve(matrix, rhs)).map(drop)
    }

    /// The solver with factors of the matrix.
    pub(super) fn factorised(
        &mut self,
        timing: &mut Timing,
    ) -> Result<Factorised<'_>, LinearError> {
        let (matrix, unknowns) = (&self.matrix, &self.unknowns);
        timing.measure(Stage::Factorisation, || {
            let solver = self.solver.get_or_insert_with(|| analyse(matrix, unknowns)).get();
            solver.set_up(matrix)?;
            Ok(Factorised { matrix, solver })
        })
    }

    /// Adds factor * v w^T with row vectors v and w of some unknowns.
    pub(super) fn add_product(&mut self, v: &[Term<u32>], w: &[Term<u32>], factor: f64) {
        if factor == 0.0 {
            return;
        }
        for one in v {
            for other in w {
                let entry =
                    self.matrix.pattern().entry(one.unknown as usize, other.unknown as usize);
                if let Some(entry) = entry {
                    self.matrix.values_mut()[entry] += one.weight * other.weight * factor;
                }
            }
        }
    }
}

/// A matrix with a solver that is set up for it.
pub(super) struct Factorised<'a> {
    pub matrix: &'a SparseMatrix,
    pub solver: &'a mut dyn LinearSolver,
}

/// Factors for matrices with the pattern of this one.
fn analyse(matrix: &SparseMatrix, unknowns: &Unknowns) -> Solver {
    Solver::Direct(Box::new(DirectSolver::new(matrix.pattern(), unknowns)))
}
