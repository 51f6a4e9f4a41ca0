//! Matrix and solver of fluid and bodies on one mesh, by the method that is chosen for them.

mod direct;
mod iterative;
mod preconditioning;
mod system_solver;
mod wall_distance;

use self::direct::DirectSystem;
use self::iterative::IterativeSystem;
pub(super) use self::preconditioning::{Coefficients, Discretised, saddle_point};
pub(super) use self::system_solver::SystemSolver;
use crate::algebra::{AffineConstraints, IterativeSettings, SaddlePoint};
use crate::flow::Assembly;

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

/// What the matrix of a system has beside the cells of its mesh.
pub(super) struct NewSystem<'a> {
    pub constraints: &'a AffineConstraints,
    /// What each unknown is.
    pub saddle_point: SaddlePoint,
    /// Unknowns of bodies that couple with each other without a cell.
    pub blocks: Vec<Vec<u32>>,
}

/// A zero matrix for the cells of an assembly, with the chosen solver.
pub(super) fn system_solver<const D: usize>(
    assembly: &Assembly<D>,
    system: NewSystem<'_>,
    choice: SolverChoice,
) -> Box<dyn SystemSolver> {
    let NewSystem { constraints, saddle_point, blocks } = system;
    match choice.iterative(D, constraints.n_unknowns()) {
        Some(settings) => {
            let cells = assembly.cell_unknowns(constraints, &blocks);
            Box::new(IterativeSystem::new(&cells, saddle_point, settings))
        }
        None => {
            let maps = assembly.maps(constraints, &blocks);
            Box::new(DirectSystem::new(maps, saddle_point.unknowns()))
        }
    }
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
