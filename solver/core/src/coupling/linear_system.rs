//! `LinearSystem`: matrix and solver of fluid and bodies on one mesh.

use std::sync::Arc;

use super::preconditioning::Coefficients;
use crate::algebra::{
    Accuracy, AffineConstraints, CellMaps, DirectSolver, IterativeSettings, IterativeSolver,
    LinearError, LinearSolver, SaddleMatrix, SaddlePoint, SolverMemory, SparseMatrix, Term,
    Unknowns, Weights,
};
use crate::flow::Assembly;
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

/// A matrix in the form that its solver takes, and what the solver keeps from matrix to matrix.
enum Method {
    Direct {
        maps: CellMaps,
        matrix: SparseMatrix,
        /// None before the first system.
        solver: Option<Box<DirectSolver>>,
    },
    Iterative {
        matrix: Box<SaddleMatrix>,
        /// None before the first system.
        solver: Option<Box<IterativeSolver>>,
        settings: IterativeSettings,
        /// What the weights of the solver were made for; none for another mesh.
        weighted_by: Option<Coefficients>,
    },
}

/// The matrix last assembled, with what solves it.
pub(super) struct LinearSystem {
    method: Method,
    accuracy: Accuracy,
    saddle_point: SaddlePoint,
    unknowns: Unknowns,
    /// What the solver is to go on from once it is made.
    recalled: Option<SolverMemory>,
}

impl LinearSystem {
    /// A zero matrix for the cells of an assembly.
    pub(super) fn new<const D: usize>(
        assembly: &Assembly<D>,
        constraints: &AffineConstraints,
        saddle_point: SaddlePoint,
        choice: SolverChoice,
    ) -> Self {
        let method = match choice.iterative(D, constraints.n_unknowns()) {
            Some(settings) => {
                let cells = assembly.cell_unknowns(constraints);
                let matrix = Box::new(SaddleMatrix::new(&saddle_point, &cells));
                Method::Iterative { matrix, solver: None, settings, weighted_by: None }
            }
            None => {
                let maps = assembly.maps(constraints);
                let matrix = SparseMatrix::zeros(Arc::clone(maps.pattern()));
                Method::Direct { maps, matrix, solver: None }
            }
        };
        let unknowns = saddle_point.unknowns();
        Self { method, accuracy: Accuracy::default(), saddle_point, unknowns, recalled: None }
    }

    /// Marks what the solver keeps at present as its memory.
    pub(super) fn mark(&mut self) {
        match &mut self.method {
            Method::Direct { solver: Some(solver), .. } => solver.mark(),
            Method::Iterative { solver: Some(solver), .. } => solver.mark(),
            Method::Direct { .. } | Method::Iterative { .. } => {}
        }
    }

    /// What the solver kept from system to system when that was marked.
    pub(super) fn memory(&self) -> SolverMemory {
        let memory = match &self.method {
            Method::Direct { solver, .. } => solver.as_ref().map(|solver| solver.memory()),
            Method::Iterative { matrix, solver, .. } => {
                solver.as_ref().map(|solver| solver.memory(matrix))
            }
        };
        memory.or_else(|| self.recalled.clone()).unwrap_or_default()
    }

    /// Goes on as the system of the same unknowns whose solver kept this.
    ///
    /// # Errors
    /// When it was another system.
    pub(super) fn recall(&mut self, memory: SolverMemory) -> Result<(), LinearError> {
        match &mut self.method {
            Method::Direct { matrix, solver, .. } => {
                let mut new = DirectSolver::new(matrix.pattern(), &self.unknowns);
                new.recall(&matrix.shared_pattern(), &memory)?;
                *solver = Some(Box::new(new));
            }
            // Made with the weights of the first system
            Method::Iterative { .. } => self.recalled = Some(memory),
        }
        Ok(())
    }

    /// Takes note that the mesh has moved.
    pub(super) fn forget_weights(&mut self) {
        if let Method::Iterative { weighted_by, .. } = &mut self.method {
            *weighted_by = None;
        }
    }

    /// Gives an iterative solver the weights for these coefficients, unless it has them.
    pub(super) fn prepare(
        &mut self,
        coefficients: Coefficients,
        weights: impl FnOnce() -> Weights,
        timing: &mut Timing,
    ) {
        let Method::Iterative { solver, settings, weighted_by, .. } = &mut self.method else {
            return;
        };
        if solver.is_some() && *weighted_by == Some(coefficients) {
            return;
        }
        timing.measure(Stage::Factorisation, || match solver {
            Some(solver) => solver.set_weights(weights()),
            None => {
                let saddle_point = self.saddle_point.clone();
                let iterative = IterativeSolver::new(saddle_point, weights(), *settings);
                *solver = Some(Box::new(iterative));
            }
        });
        *weighted_by = Some(coefficients);
    }

    /// Has a solver that has its weights recall what it is to go on from.
    ///
    /// # Errors
    /// When another system kept it.
    pub(super) fn recall_with_weights(&mut self) -> Result<(), LinearError> {
        match (&mut self.method, self.recalled.take()) {
            (Method::Iterative { matrix, solver: Some(solver), .. }, Some(memory)) => {
                solver.recall(matrix, &memory)
            }
            (_, recalled) => {
                self.recalled = recalled;
                Ok(())
            }
        }
    }

    /// Has solutions by iterations leave no larger sum of the sizes of the residuals of pressures (m3/s) than this, once
    /// the solver is prepared.
    pub(super) fn limit_mass(&mut self, limit: f64) {
        if let Method::Iterative { solver: Some(solver), .. } = &mut self.method {
            solver.limit_mass(limit);
        }
    }

    /// Memory of the preconditioner (bytes), zero with factors.
    pub(super) fn preconditioner_bytes(&self) -> usize {
        match &self.method {
            Method::Iterative { solver, .. } => {
                solver.as_ref().map_or(0, |solver| solver.n_bytes())
            }
            Method::Direct { .. } => 0,
        }
    }

    /// Entries of the matrix.
    pub(super) fn n_entries(&self) -> usize {
        match &self.method {
            Method::Direct { matrix, .. } => matrix.pattern().n_entries(),
            Method::Iterative { matrix, .. } => matrix.n_entries(),
        }
    }

    /// A copy of the matrix last assembled.
    pub(super) fn matrix(&self) -> SparseMatrix {
        match &self.method {
            Method::Direct { matrix, .. } => matrix.copied(),
            Method::Iterative { matrix, .. } => matrix.to_sparse(),
        }
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
        matches!(self.method, Method::Iterative { .. })
    }

    /// Overwrites the matrix with what `cells` gives of each cell.
    pub(super) fn assemble(&mut self, cells: impl FnOnce(&mut (dyn FnMut(usize, &[f64]) + Send))) {
        match &mut self.method {
            Method::Direct { maps, matrix, .. } => {
                let values = matrix.values_mut();
                values.fill(0.0);
                cells(&mut |cell, of_cell| maps.scatter(cell, of_cell, values));
            }
            Method::Iterative { matrix, .. } => {
                matrix.clear();
                cells(&mut |cell, of_cell| matrix.add_cell(cell, of_cell));
                matrix.complete();
            }
        }
    }

    /// Adds factor * v w^T with row vectors v and w of some velocities.
    pub(super) fn add_product(&mut self, v: &[Term<u32>], w: &[Term<u32>], factor: f64) {
        if factor == 0.0 {
            return;
        }
        for one in v {
            for other in w {
                let (row, column) = (one.unknown as usize, other.unknown as usize);
                let value = one.weight * other.weight * factor;
                match &mut self.method {
                    Method::Direct { matrix, .. } => matrix.add(row, column, value),
                    Method::Iterative { matrix, .. } => matrix.add(row, column, value),
                }
            }
        }
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
        let accuracy = match &mut self.method {
            Method::Direct { matrix, solver, .. } => {
                let solver = analysed(solver, matrix, &self.unknowns, timing);
                corrected(solver, matrix, free, rhs, reduction, timing)?
            }
            Method::Iterative { matrix, solver, .. } => {
                corrected(prepared(solver), matrix, free, rhs, reduction, timing)?
            }
        };
        self.accuracy = accuracy.unwrap_or(self.accuracy);
        Ok(())
    }

    /// Solves with a set-up for the matrix, in place. Iterations end as in [`Self::solve_correction`].
    pub(super) fn solve(
        &mut self,
        rhs: &mut [f64],
        reduction: Option<f64>,
        timing: &mut Timing,
    ) -> Result<(), LinearError> {
        match &mut self.method {
            Method::Direct { matrix, solver, .. } => {
                let solver = analysed(solver, matrix, &self.unknowns, timing);
                solved(solver, matrix, rhs, reduction, timing)?;
            }
            Method::Iterative { matrix, solver, .. } => {
                solved(prepared(solver), matrix, rhs, reduction, timing)?;
            }
        }
        Ok(())
    }

    /// The block of the inverse in the rows and columns of some rigid velocities, column by column.
    pub(super) fn inverse_of(
        &mut self,
        rigid: &[usize],
        timing: &mut Timing,
    ) -> Result<Vec<f64>, LinearError> {
        match &mut self.method {
            Method::Direct { matrix, solver, .. } => {
                let solver = analysed(solver, matrix, &self.unknowns, timing);
                set_up_and(|solver| solver.inverse_of_dense(matrix, rigid), solver, matrix, timing)
            }
            Method::Iterative { matrix, solver, .. } => {
                let invert = |solver: &mut IterativeSolver| solver.inverse_of_dense(matrix, rigid);
                set_up_and(invert, prepared(solver), matrix, timing)
            }
        }
    }
}

/// Sets a solver up for a matrix, then has it solve.
fn set_up_and<S: LinearSolver, T>(
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
fn corrected<S: LinearSolver>(
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
fn solved<S: LinearSolver>(
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

/// The direct solver, made for the pattern of a matrix if there is none.
fn analysed<'a>(
    solver: &'a mut Option<Box<DirectSolver>>,
    matrix: &SparseMatrix,
    unknowns: &Unknowns,
    timing: &mut Timing,
) -> &'a mut DirectSolver {
    timing.measure(Stage::Factorisation, || {
        solver.get_or_insert_with(|| Box::new(DirectSolver::new(matrix.pattern(), unknowns)))
    })
}

/// The iterative solver.
fn prepared(solver: &mut Option<Box<IterativeSolver>>) -> &mut IterativeSolver {
    solver.as_mut().expect("weights are made before the first system is solved")
}

/// Memory a system takes with its factors, or in space with its preconditioner (bytes), from the
/// velocities and pressures of its mesh.
///
/// Fitted to the peaks of 40 runs of planar cases with 7 10^3 to 5 10^4 free unknowns, which lie within
/// 0.87 and 1.25 of it; 1.9 10^5 take 0.88 of it. In space, to four Stokes flows with 7 10^4 to 1.2 10^6,
/// within 9 %.
#[must_use]
pub fn memory_estimate(dimensions: usize, n_dofs: f64) -> f64 {
    let of_ten_thousand = if dimensions == 3 { 16e6 } else { 33e6 };
    12e6 + of_ten_thousand * n_dofs / 1e4
}
