//! `LinearSystem`: matrix and solver of fluid and bodies on one mesh.

use std::sync::Arc;

use crate::algebra::{
    Accuracy, AffineConstraints, DirectSolver, LinearError, LinearSolver, Pattern, SparseMatrix,
    Term, Unknowns,
};
use crate::flow::pressure_unknowns;
use crate::space::DofLayout;
use crate::timing::{Stage, Timing};

/// The matrix last assembled, with what solves it.
pub(super) struct LinearSystem {
    matrix: SparseMatrix,
    solver: Option<Box<dyn LinearSolver>>,
    accuracy: Accuracy,
    unknowns: Unknowns,
}

impl LinearSystem {
    /// A zero matrix.
    pub(super) fn new(pattern: Arc<Pattern>, unknowns: Unknowns) -> Self {
        let matrix = SparseMatrix::zeros(pattern);
        Self { matrix, solver: None, accuracy: Accuracy::default(), unknowns }
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

    /// Solves with the matrix, in place, for a correction of the free unknowns `free`.
    pub(super) fn solve_correction(
        &mut self,
        free: &[f64],
        rhs: &mut [f64],
        timing: &mut Timing,
    ) -> Result<(), LinearError> {
        let (matrix, unknowns) = (&self.matrix, &self.unknowns);
        let solver = timing.measure(Stage::Factorisation, || {
            self.solver.get_or_insert_with(|| analyse(matrix, unknowns))
        });
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
            let solver = self.solver.get_or_insert_with(|| analyse(matrix, unknowns));
            solver.set_up(matrix)?;
            Ok(Factorised { matrix, solver: solver.as_mut() })
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

/// A solver for matrices with the pattern of this one.
fn analyse(matrix: &SparseMatrix, unknowns: &Unknowns) -> Box<dyn LinearSolver> {
    Box::new(DirectSolver::new(matrix.pattern(), unknowns))
}

/// What the linear solver has to know of each free unknown.
pub(super) fn unknowns<const D: usize>(
    layout: &DofLayout<D>,
    constraints: &AffineConstraints,
) -> Unknowns {
    let is_pressure = pressure_unknowns(layout, constraints);
    let mut unknowns =
        Unknowns { node: vec![0; is_pressure.len()], is_pressure, dense: Vec::new() };
    for node in layout.nodes() {
        let velocities = (0..D).map(|axis| layout.velocity(node, axis));
        let pressure = (node.index() < layout.n_vertices).then(|| layout.pressure(node));
        for unknown in velocities.chain(pressure).filter_map(|raw| constraints.unknown(raw)) {
            unknowns.node[unknown] = u32::from(node);
        }
    }
    let rigid = layout.n_fluid()..layout.n_raw();
    unknowns.dense = rigid.filter_map(|raw| constraints.unknown(raw)).collect();
    unknowns
}
