//! `RunError`: what stopped a run, at which step, for which body or cell.

use alewife_mesh::MeshError;
use thiserror::Error;

use super::resume::ResumeError;
use super::scene::RemeshError;
use crate::case::rounded;
use crate::contact::ContactError;
use crate::coupling::{ShapeError, SolveError, coordinates};
use crate::motion::MotionError;

/// Why a step was not made. Remeshing or a shorter step may help where it is not `Run`.
#[derive(Debug, Error)]
pub enum StepError {
    /// Neither would help.
    #[error(transparent)]
    Run(#[from] RunError),
    /// A cell is inverted, or nearly so, where the bodies go.
    #[error("the mesh degenerates at {}: a cell has quality {quality:.2e}", coordinates(.center))]
    DegenerateCell {
        /// Centre of the cell (m).
        center: Vec<f64>,
        /// Its quality.
        quality: f64,
    },
    /// No contact forces were found.
    #[error(transparent)]
    Contact(#[from] ContactError),
    /// The step is too long for the accuracy asked for.
    #[error("the error of the step is {error:.2e}, and {tolerance:.2e} is accepted")]
    LocalErrorTooLarge {
        /// Estimate of the error, relative to the velocities.
        error: f64,
        /// What is accepted.
        tolerance: f64,
    },
    /// Contact is stiff in an explicit step.
    #[error(
        "contact moves the bodies back within {time_scale:.2e}, too fast for a step of {size:.2e} of \
         the scheme `rk3`; lower the step, soften the contact, or write scheme = \"bdf2\""
    )]
    StiffContact {
        /// Size of the step (s).
        size: f64,
        /// Time in which it does (s).
        time_scale: f64,
    },
    /// Poses of bodies and flow do not come to agree.
    #[error("bodies are not where the flow was solved for after {passes} passes")]
    CouplingNotConverged {
        /// Passes made.
        passes: usize,
    },
}

impl From<ShapeError> for StepError {
    fn from(error: ShapeError) -> Self {
        Self::Run(error.into())
    }
}

impl From<MotionError> for StepError {
    fn from(error: MotionError) -> Self {
        Self::Run(error.into())
    }
}

/// Where in a run something happened.
pub(super) fn at(step: usize, time: f64) -> String {
    format!("step {step} (t = {})", rounded(time))
}

/// Every way a run can stop before its end.
#[derive(Debug, Error)]
pub enum RunError {
    /// Newton's method did not converge.
    #[error(
        "{}: Newton's method stopped at residual {residual:.3e} after {iterations} iteration{}; {}",
        if *step == 0 { "steady flow".to_owned() } else { at(*step, *time) },
        if *iterations == 1 { "" } else { "s" },
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
        "{}: the solution is not finite near {}; \
         lower time.unsteady.step or refine the mesh there",
        at(*step, *time),
        coordinates(.near)
    )]
    NotFinite {
        /// Step.
        step: usize,
        /// Time (s).
        time: f64,
        /// Where (m).
        near: Vec<f64>,
    },
    /// The fluid is far faster than what drives it.
    #[error(
        "{}: the flow has blown up: on average it is {times:.0} times as fast as \
         the fastest boundary ever was, most near {}; CFL number {cfl:.3e}, cell Reynolds number \
         {cell_reynolds:.3e}; look at failure/flow.vtu, and start again with a finer mesh there, a \
         shorter time.unsteady.step, or time.unsteady.convection = \"newton\"",
        at(*step, *time),
        coordinates(.near)
    )]
    BlownUp {
        /// Step.
        step: usize,
        /// Time (s).
        time: f64,
        /// Root mean square of the velocity over the largest speed of a boundary so far.
        times: f64,
        /// CFL number of the step.
        cfl: f64,
        /// Largest cell Reynolds number.
        cell_reynolds: f64,
        /// Where the fluid is fastest (m).
        near: Vec<f64>,
    },
    /// The linear system is singular.
    #[error("{}: the linear system cannot be solved: {reason}", at(*step, *time))]
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
    /// The mesh would not fit into memory; it has not been made.
    #[error(
        "the cell sizes ask for {n_cells:.1e} cells or more, which need {needed:.0} GB of memory, and \
         {available:.0} GB are free; raise mesh.size, mesh.surface or mesh.growth, or lower \
         mesh.gap_layers: cells {coarser:.1} times as large would fit"
    )]
    TooManyCells {
        /// Estimate, or where it ended.
        n_cells: f64,
        /// Memory of a system on them (GB).
        needed: f64,
        /// Free memory (GB).
        available: f64,
        /// Factor on all sizes with which it would fit.
        coarser: f64,
    },
    /// A request the solver cannot meet (a case that `check` should have refused).
    #[error("{0}")]
    Unsupported(String),
    /// No shorter step helps.
    #[error(
        "{}: {reason}, with steps down to {smallest:.3e}{advice}",
        at(*step, *time)
    )]
    StepSizeUnderflow {
        /// Step.
        step: usize,
        /// Time (s).
        time: f64,
        /// The smallest step tried (s).
        smallest: f64,
        /// What went wrong in it.
        reason: String,
        /// What else is known, and what may help, behind semicolons.
        advice: String,
    },
    /// Remeshing failed.
    #[error("{}: remeshing failed: {reason}", at(*step, *time))]
    Remesh {
        /// Step.
        step: usize,
        /// Time (s).
        time: f64,
        /// Which body, and why.
        #[source]
        reason: Box<RemeshError>,
    },
    /// A gait gives its body no shape at some time.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// Contact cannot be solved for.
    #[error("{}: {reason}", at(*step, *time))]
    Contact {
        /// Step.
        step: usize,
        /// Time (s).
        time: f64,
        /// Which bodies, and why.
        reason: Box<ContactError>,
    },
    /// The mesh could not be generated.
    #[error("mesh: {0}")]
    Mesh(#[from] MeshError),
    /// The mesh could not be moved.
    #[error("mesh: {0}")]
    MeshMotion(#[from] MotionError),
    /// A run cannot resume from a state.
    #[error("cannot resume from this state: {0}")]
    Resume(#[from] ResumeError),
    /// An observer could not write.
    #[error("output: {0}")]
    Output(#[from] std::io::Error),
    /// A signal, a file or a limit of time asked the run to stop.
    #[error(
        "stopped {}",
        if *step == 0 && *time == 0.0 {
            "before the first flow was found".to_owned()
        } else {
            format!("at {}", at(*step, *time))
        }
    )]
    Stopped {
        /// Step.
        step: usize,
        /// Time (s).
        time: f64,
    },
}

impl RunError {
    /// A mesh that could not be set up at the start.
    pub(super) fn from_remesh(error: RemeshError) -> Self {
        match error {
            RemeshError::Mesh(error) => Self::Mesh(error),
            RemeshError::Motion(error) => Self::MeshMotion(error),
            RemeshError::Shape(error) => Self::Shape(error),
            error => Self::Unsupported(error.to_string()),
        }
    }

    /// The failure of a linear solve, at a step and time.
    #[must_use]
    pub fn from_solve(error: SolveError, step: usize, time: f64) -> Self {
        match error {
            SolveError::NotFinite { near } => Self::NotFinite { step, time, near },
            error => Self::Singular { step, time, reason: error.to_string() },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_and_its_noun_agree() {
        let told = |iterations| {
            let (step, time, residual) = (3, 0.5, 1e-2);
            RunError::NewtonStalled { step, time, residual, iterations }.to_string()
        };
        assert!(told(1).contains("after 1 iteration;"), "{}", told(1));
        assert!(told(2).contains("after 2 iterations;"), "{}", told(2));
    }

    #[test]
    fn contact_too_stiff_for_explicit_steps_says_what_helps() {
        let told = StepError::StiffContact { size: 0.1, time_scale: 0.02 }.to_string();
        for remedy in ["lower the step", "soften the contact", "scheme = \"bdf2\""] {
            assert!(told.contains(remedy), "{told}");
        }
    }

    #[test]
    fn times_are_told_without_the_rounding_of_their_last_digits() {
        let told = RunError::Stopped { step: 6, time: 0.6000000000000001 }.to_string();
        assert_eq!(told, "stopped at step 6 (t = 0.6)");
    }

    #[test]
    fn a_flow_at_the_start_that_is_stopped_has_no_step() {
        let told = |step, time| RunError::Stopped { step, time }.to_string();
        assert!(!told(0, 0.0).contains("step 0"), "{}", told(0, 0.0));
        assert!(told(3, 0.5).contains("step 3 (t = 0.5)"), "{}", told(3, 0.5));
    }
}
