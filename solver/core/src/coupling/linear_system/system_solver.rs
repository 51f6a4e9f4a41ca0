//! `SystemSolver`: a matrix in the form that its solver takes, with the solver.

use super::preconditioning::Coefficients;
use crate::algebra::{
    Accuracy, LinearError, LinearSolver, SolverMemory, SparseMatrix, Term, Unknowns, Weights,
};
use crate::timing::{Stage, Timing};

/// Takes what each cell adds to a matrix, cell by cell.
pub(in super::super) type Scatter<'a> = dyn FnMut(usize, &[f64]) + Send + 'a;

/// The matrix last assembled, with what solves it and what that keeps from matrix to matrix.
pub(in super::super) trait SystemSolver: Send + Sync {
    /// Overwrites the matrix with what `cells` gives of each cell.
    fn assemble(&mut self, cells: &mut dyn FnMut(&mut Scatter<'_>));

    /// Adds to an entry of the matrix, if it is stored.
    fn add(&mut self, row: usize, column: usize, value: f64);

    /// Adds factor * v w^T with row vectors v and w of some velocities.
    fn add_product(&mut self, v: &[Term<u32>], w: &[Term<u32>], factor: f64) {
        if factor == 0.0 {
            return;
        }
        for one in v {
            for other in w {
                let value = one.weight * other.weight * factor;
                self.add(one.unknown as usize, other.unknown as usize, value);
            }
        }
    }

    /// Gives an iterative solver the weights for these coefficients, unless it has them.
    fn prepare(
        &mut self,
        _coefficients: Coefficients,
        _weights: &dyn Fn() -> Weights,
        _timing: &mut Timing,
    ) {
    }

    /// Has solutions by iterations leave no larger sum of the sizes of the residuals of pressures (m3/s) than this, once
    /// the solver is prepared.
    fn limit_mass(&mut self, _limit: f64) {}

    /// Takes note that the mesh has moved.
    fn forget_weights(&mut self) {}

    /// Solves with the matrix, in place, for a correction of the free unknowns `free`. Iterations end at a
    /// residual of `reduction` times the right-hand side, by default that of the settings.
    ///
    /// # Errors
    /// When the matrix is singular or the solution not finite.
    fn solve_correction(
        &mut self,
        free: &[f64],
        rhs: &mut [f64],
        reduction: Option<f64>,
        timing: &mut Timing,
    ) -> Result<(), LinearError>;

    /// Solves with a set-up for the matrix, in place. Iterations end as in [`Self::solve_correction`].
    ///
    /// # Errors
    /// When the matrix is singular or the solution not finite.
    fn solve(
        &mut self,
        rhs: &mut [f64],
        reduction: Option<f64>,
        timing: &mut Timing,
    ) -> Result<(), LinearError>;

    /// Whether there are factors, and they are of the matrix last assembled.
    fn is_factorised(&mut self) -> bool {
        false
    }

    /// Overwrites a right-hand side with its solution by one substitution with the factors at hand, which may be of an
    /// earlier matrix; false where there are none.
    fn substitute(&mut self, _rhs: &mut [f64], _timing: &mut Timing) -> bool {
        false
    }

    /// Solves with the transpose of the matrix, in place, for some right-hand sides: by factors, or where the solver
    /// iterates and the matrix is symmetric by iterations.
    ///
    /// # Errors
    /// When the matrix is singular, its factors are too large, or the solution is not finite.
    fn solve_transposed(
        &mut self,
        sides: &mut [Vec<f64>],
        is_symmetric: bool,
        timing: &mut Timing,
    ) -> Result<(), LinearError>;

    /// The block of the inverse in the rows and columns of some rigid velocities, column by column.
    ///
    /// # Errors
    /// When the matrix is singular or the block not finite.
    fn inverse_of(&mut self, rigid: &[usize], timing: &mut Timing)
    -> Result<Vec<f64>, LinearError>;

    /// Marks what the solver keeps at present as its memory.
    fn mark(&mut self);

    /// What the solver kept from system to system when that was marked.
    fn memory(&self) -> SolverMemory;

    /// Continues as the system of the same unknowns whose solver kept this.
    ///
    /// # Errors
    /// When it was another system.
    fn recall(&mut self, memory: SolverMemory) -> Result<(), LinearError>;

    /// Has a solver that has its weights recall what it is to continue from.
    ///
    /// # Errors
    /// When another system kept it.
    fn recall_with_weights(&mut self) -> Result<(), LinearError> {
        Ok(())
    }

    /// How well the last system was solved for which the matrix was factorised.
    fn accuracy(&self) -> Accuracy;

    /// What each unknown is.
    fn unknowns(&self) -> &Unknowns;

    /// Entries of the matrix.
    fn n_entries(&self) -> usize;

    /// A copy of the matrix last assembled.
    fn matrix(&self) -> SparseMatrix;

    /// Whether systems are solved by iterations: how accurately is then a choice.
    fn is_iterative(&self) -> bool {
        false
    }

    /// Memory of the preconditioner (bytes), zero with factors.
    fn preconditioner_bytes(&self) -> usize {
        0
    }
}

/// Sets a solver up for a matrix, then has it solve.
pub(super) fn set_up_and<S: LinearSolver, T>(
    solve: impl FnOnce(&mut S) -> Result<T, LinearError>,
    solver: &mut S,
    matrix: &S::Matrix,
    timing: &mut Timing,
) -> Result<T, LinearError> {
    timing.measure(Stage::Factorisation, || solver.set_up(matrix))?;
    timing.measure(Stage::Solve, || solve(solver))
}

/// Solves for a correction of the free unknowns, in place: by an earlier set-up if that is enough, else how
/// accurately by one for this matrix.
pub(super) fn corrected<S: LinearSolver>(
    solver: &mut S,
    matrix: &S::Matrix,
    free: &[f64],
    rhs: &mut [f64],
    reduction: Option<f64>,
    timing: &mut Timing,
) -> Result<Option<Accuracy>, LinearError> {
    let by_earlier = || solver.solve_with_earlier_set_up(matrix, rhs, free);
    if timing.measure(Stage::Solve, by_earlier)? {
        return Ok(None);
    }
    solved(solver, matrix, rhs, reduction, timing).map(Some)
}

/// Solves by a set-up for this matrix, in place.
pub(super) fn solved<S: LinearSolver>(
    solver: &mut S,
    matrix: &S::Matrix,
    rhs: &mut [f64],
    reduction: Option<f64>,
    timing: &mut Timing,
) -> Result<Accuracy, LinearError> {
    let solve = |solver: &mut S| match reduction {
        Some(reduction) => solver.solve_to(matrix, rhs, reduction),
        None => solver.solve(matrix, rhs),
    };
    set_up_and(solve, solver, matrix, timing)
}
