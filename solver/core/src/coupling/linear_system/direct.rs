//! `DirectSystem`: a matrix by compressed rows, solved by its factors.

use std::sync::Arc;

use super::system_solver::{Scatter, SystemSolver, corrected, set_up_and, solved};
use crate::algebra::{
    Accuracy, CellMaps, DirectSolver, LinearError, LinearSolver, SolverMemory, SparseMatrix,
    Unknowns,
};
use crate::timing::{Stage, Timing};

/// A matrix by compressed rows with the solver that factorises it.
pub(super) struct DirectSystem {
    maps: CellMaps,
    matrix: SparseMatrix,
    unknowns: Unknowns,
    /// None before the first system.
    solver: Option<Box<DirectSolver>>,
    accuracy: Accuracy,
}

impl DirectSystem {
    /// A zero matrix of the pattern of cells.
    pub(super) fn new(maps: CellMaps, unknowns: Unknowns) -> Self {
        let matrix = SparseMatrix::zeros(Arc::clone(maps.pattern()));
        Self { maps, matrix, unknowns, solver: None, accuracy: Accuracy::default() }
    }
}

/// The direct solver, made for the pattern of a matrix if there is none.
fn analysed<'a>(
    solver: &'a mut Option<Box<DirectSolver>>,
    matrix: &SparseMatrix,
    unknowns: &Unknowns,
    timing: &mut Timing,
) -> Result<&'a mut DirectSolver, LinearError> {
    timing.measure(Stage::Factorisation, || {
        let solver = match solver {
            Some(solver) => solver,
            none => {
                let analysed = DirectSolver::new(&matrix.shared_pattern(), unknowns)?;
                none.insert(Box::new(analysed))
            }
        };
        Ok(&mut **solver)
    })
}

/// Solves with the transpose of a matrix, in place, for some right-hand sides.
pub(super) fn solved_transposed(
    solver: &mut DirectSolver,
    matrix: &SparseMatrix,
    sides: &mut [Vec<f64>],
    timing: &mut Timing,
) -> Result<(), LinearError> {
    let solve = |solver: &mut DirectSolver| {
        sides.iter_mut().try_for_each(|side| solver.solve_transposed(matrix, side).map(drop))
    };
    set_up_and(solve, solver, matrix, timing)
}

impl SystemSolver for DirectSystem {
    fn assemble(&mut self, cells: &mut dyn FnMut(&mut Scatter<'_>)) {
        let Self { maps, matrix, .. } = self;
        let values = matrix.values_mut();
        values.fill(0.0);
        cells(&mut |cell, of_cell| maps.scatter(cell, of_cell, values));
    }

    fn add(&mut self, row: usize, column: usize, value: f64) {
        self.matrix.add(row, column, value);
    }

    fn solve_correction(
        &mut self,
        free: &[f64],
        rhs: &mut [f64],
        reduction: Option<f64>,
        timing: &mut Timing,
    ) -> Result<(), LinearError> {
        let Self { matrix, unknowns, solver, .. } = self;
        let solver = analysed(solver, matrix, unknowns, timing)?;
        let accuracy = corrected(solver, matrix, free, rhs, reduction, timing)?;
        self.accuracy = accuracy.unwrap_or(self.accuracy);
        Ok(())
    }

    fn solve(
        &mut self,
        rhs: &mut [f64],
        reduction: Option<f64>,
        timing: &mut Timing,
    ) -> Result<(), LinearError> {
        let Self { matrix, unknowns, solver, .. } = self;
        let solver = analysed(solver, matrix, unknowns, timing)?;
        solved(solver, matrix, rhs, reduction, timing).map(drop)
    }

    fn is_factorised(&mut self) -> bool {
        let Self { matrix, solver, .. } = self;
        solver.as_mut().is_some_and(|solver| solver.has_factors_of(matrix))
    }

    fn substitute(&mut self, rhs: &mut [f64], timing: &mut Timing) -> bool {
        let Some(solver) = &mut self.solver else { return false };
        timing.measure(Stage::Solve, || solver.substitute(rhs))
    }

    fn solve_transposed(
        &mut self,
        sides: &mut [Vec<f64>],
        _is_symmetric: bool,
        timing: &mut Timing,
    ) -> Result<(), LinearError> {
        let Self { matrix, unknowns, solver, .. } = self;
        let solver = analysed(solver, matrix, unknowns, timing)?;
        solved_transposed(solver, matrix, sides, timing)
    }

    fn inverse_of(
        &mut self,
        rigid: &[usize],
        timing: &mut Timing,
    ) -> Result<Vec<f64>, LinearError> {
        let Self { matrix, unknowns, solver, .. } = self;
        let solver = analysed(solver, matrix, unknowns, timing)?;
        set_up_and(|solver| solver.inverse_of_dense(matrix, rigid), solver, matrix, timing)
    }

    fn mark(&mut self) {
        if let Some(solver) = &mut self.solver {
            solver.mark();
        }
    }

    fn memory(&self) -> SolverMemory {
        self.solver.as_ref().map(|solver| solver.memory()).unwrap_or_default()
    }

    fn recall(&mut self, memory: SolverMemory) -> Result<(), LinearError> {
        let mut solver = DirectSolver::new(&self.matrix.shared_pattern(), &self.unknowns)?;
        solver.recall(&self.matrix.shared_pattern(), &memory)?;
        self.solver = Some(Box::new(solver));
        Ok(())
    }

    fn accuracy(&self) -> Accuracy {
        self.accuracy
    }

    fn unknowns(&self) -> &Unknowns {
        &self.unknowns
    }

    fn n_entries(&self) -> usize {
        self.matrix.pattern().n_entries()
    }

    fn matrix(&self) -> SparseMatrix {
        self.matrix.copied()
    }
}
