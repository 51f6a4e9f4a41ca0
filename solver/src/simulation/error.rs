//! `RunError`: what stopped a run, at which step, for which body or cell.

use alewife_mesh::Point;
use thiserror::Error;

use crate::coupling::SolveError;

/// Every way a run can stop before its end.
#[derive(Debug, Error)]
pub enum RunError {
    /// Newton's method did not converge.
    #[error(
        "{}: Newton's method stopped at residual {residual:.3e} after {iterations} iterations; {}",
        if *step == 0 { "steady flow".to_owned() } else { format!("step {step} (t = {time})") },
        if *step == 0 {
            "refine the mesh, raise time.steady.max_iterations, or lower the Reynolds number: \
             there may be no steady flow"
        } else {
            "lower time.unsteady.step or refine the mesh"
        }
    )]
    NewtonStalled {
        /// Step, 0 for a steady solution.
        step: usize,
        /// Time (s).
        time: f64,
        /// Residual relative to the first one.
        residual: f64,
        /// Iterations made.
        iterations: usize,
    },
    /// A velocity or pressure is no longer a number.
    #[error(
        "step {step} (t = {time}): the solution is not finite near {place:?}; \
         lower time.unsteady.step or refine the mesh there"
    )]
    NotFinite {
        /// Step.
        step: usize,
        /// Time (s).
        time: f64,
        /// Where (m).
        place: Point<2>,
    },
    /// The linear system is singular.
    #[error("step {step} (t = {time}): the linear system cannot be solved: {reason}")]
    Singular {
        /// Step.
        step: usize,
        /// Time (s).
        time: f64,
        /// Which unknown, and why it may be.
        reason: String,
    },
    /// The system would not fit into memory.
    #[error(
        "{n_dofs} unknowns need about {needed:.0} GB of memory and {available:.0} GB are free; \
         raise mesh.size, mesh.surface or mesh.growth, or lower mesh.gap_layers"
    )]
    TooLarge {
        /// Velocities and pressures.
        n_dofs: usize,
        /// Estimate (GB).
        needed: f64,
        /// Free memory (GB).
        available: f64,
    },
    /// A request the solver cannot meet (a case that `check` should have refused).
    #[error("{0}")]
    Unsupported(String),
    /// The mesh could not be made.
    #[error("mesh: {0}")]
    Mesh(String),
    /// An observer could not write.
    #[error("output: {0}")]
    Output(#[from] std::io::Error),
    /// A signal asked the run to stop.
    #[error("stopped by a signal at step {step} (t = {time})")]
    Stopped {
        /// Step.
        step: usize,
        /// Time (s).
        time: f64,
    },
}

impl RunError {
    /// The failure of a linear solve, at a step and time.
    #[must_use]
    pub fn from_solve(error: SolveError, step: usize, time: f64) -> Self {
        match error {
            SolveError::Singular(reason) => Self::Singular { step, time, reason },
            SolveError::NotFinite { place } => Self::NotFinite { step, time, place },
        }
    }
}
