//! `IterativeSystem`: a saddle-point matrix by blocks, solved by iterations.

use super::direct::solved_transposed;
use super::preconditioning::Coefficients;
use super::system_solver::{Scatter, SystemSolver, corrected, set_up_and, solved};
use crate::algebra::{
    Accuracy, CellUnknowns, DirectSolver, IterativeSettings, IterativeSolver, LinearError,
    LinearSolver, SaddleMatrix, SaddlePoint, SolverMemory, SparseMatrix, Unknowns, Weights,
};
use crate::timing::{Stage, Timing};

/// Part of the right-hand side that iterations for an adjoint flow leave.
const ADJOINT: f64 = 1e-9;

/// A matrix by blocks with the solver that iterates with it.
pub(super) struct IterativeSystem {
    matrix: SaddleMatrix,
    saddle_point: SaddlePoint,
    unknowns: Unknowns,
    settings: IterativeSettings,
    /// None before the first system.
    solver: Option<Box<IterativeSolver>>,
    /// What the weights of the solver were made for; none for another mesh.
    weighted_by: Option<Coefficients>,
    /// What the solver is to continue from once it is made with the weights of the first system.
    recalled: Option<SolverMemory>,
    accuracy: Accuracy,
}

impl IterativeSystem {
    /// A zero matrix of cells.
    pub(super) fn new(
        cells: &CellUnknowns,
        saddle_point: SaddlePoint,
        settings: IterativeSettings,
    ) -> Self {
        Self {
            matrix: SaddleMatrix::new(&saddle_point, cells),
            unknowns: saddle_point.unknowns(),
            saddle_point,
            settings,
            solver: None,
            weighted_by: None,
            recalled: None,
            accuracy: Accuracy::default(),
        }
    }
}

/// The iterative solver.
fn prepared(solver: &mut Option<Box<IterativeSolver>>) -> &mut IterativeSolver {
    solver.as_mut().expect("weights are made before the first system is solved")
}

impl SystemSolver for IterativeSystem {
    fn assemble(&mut self, cells: &mut dyn FnMut(&mut Scatter<'_>)) {
        let matrix = &mut self.matrix;
        matrix.clear();
        cells(&mut |cell, of_cell| matrix.add_cell(cell, of_cell));
        matrix.complete();
    }

    fn add(&mut self, row: usize, column: usize, value: f64) {
        self.matrix.add(row, column, value);
    }

    fn prepare(
        &mut self,
        coefficients: Coefficients,
        weights: &dyn Fn() -> Weights,
        timing: &mut Timing,
    ) {
        let Self { solver, weighted_by, .. } = self;
        if solver.is_some() && *weighted_by == Some(coefficients) {
            return;
        }
        timing.measure(Stage::Factorisation, || match solver {
            Some(solver) => solver.set_weights(weights()),
            None => {
                let saddle_point = self.saddle_point.clone();
                let iterative = IterativeSolver::new(saddle_point, weights(), self.settings);
                *solver = Some(Box::new(iterative));
            }
        });
        *weighted_by = Some(coefficients);
    }

    fn forget_weights(&mut self) {
        self.weighted_by = None;
    }

    fn solve_correction(
        &mut self,
        free: &[f64],
        rhs: &mut [f64],
        reduction: Option<f64>,
        timing: &mut Timing,
    ) -> Result<(), LinearError> {
        let Self { matrix, solver, .. } = self;
        let accuracy = corrected(prepared(solver), matrix, free, rhs, reduction, timing)?;
        self.accuracy = accuracy.unwrap_or(self.accuracy);
        Ok(())
    }

    fn solve(
        &mut self,
        rhs: &mut [f64],
        reduction: Option<f64>,
        timing: &mut Timing,
    ) -> Result<(), LinearError> {
        let Self { matrix, solver, .. } = self;
        solved(prepared(solver), matrix, rhs, reduction, timing).map(drop)
    }

    fn solve_transposed(
        &mut self,
        sides: &mut [Vec<f64>],
        is_symmetric: bool,
        timing: &mut Timing,
    ) -> Result<(), LinearError> {
        if is_symmetric {
            return sides.iter_mut().try_for_each(|side| self.solve(side, Some(ADJOINT), timing));
        }
        let matrix = self.matrix.to_sparse();
        let analyse = || DirectSolver::new(&matrix.shared_pattern(), &self.unknowns);
        let mut solver = timing.measure(Stage::Factorisation, analyse)?;
        let n_factor_entries = solver.n_factor_entries();
        if n_factor_entries > self.settings.max_factor_entries {
            return Err(LinearError::TooLarge { n_unknowns: matrix.n(), n_factor_entries });
        }
        solved_transposed(&mut solver, &matrix, sides, timing)
    }

    fn inverse_of(
        &mut self,
        rigid: &[usize],
        timing: &mut Timing,
    ) -> Result<Vec<f64>, LinearError> {
        let Self { matrix, solver, .. } = self;
        let invert = |solver: &mut IterativeSolver| solver.inverse_of_dense(matrix, rigid);
        set_up_and(invert, prepared(solver), matrix, timing)
    }

    fn mark(&mut self) {
        if let Some(solver) = &mut self.solver {
            solver.mark();
        }
    }

    fn memory(&self) -> SolverMemory {
        let memory = self.solver.as_ref().map(|solver| solver.memory(&self.matrix));
        memory.or_else(|| self.recalled.clone()).unwrap_or_default()
    }

    fn recall(&mut self, memory: SolverMemory) -> Result<(), LinearError> {
        self.recalled = Some(memory);
        Ok(())
    }

    fn recall_with_weights(&mut self) -> Result<(), LinearError> {
        let Some(solver) = &mut self.solver else { return Ok(()) };
        match self.recalled.take() {
            Some(memory) => solver.recall(&self.matrix, &memory),
            None => Ok(()),
        }
    }

    fn accuracy(&self) -> Accuracy {
        self.accuracy
    }

    fn unknowns(&self) -> &Unknowns {
        &self.unknowns
    }

    fn n_entries(&self) -> usize {
        self.matrix.n_entries()
    }

    fn matrix(&self) -> SparseMatrix {
        self.matrix.to_sparse()
    }

    fn is_iterative(&self) -> bool {
        true
    }

    fn limit_mass(&mut self, limit: f64) {
        if let Some(solver) = &mut self.solver {
            solver.limit_mass(limit);
        }
    }

    fn preconditioner_bytes(&self) -> usize {
        self.solver.as_ref().map_or(0, |solver| solver.n_bytes())
    }
}
