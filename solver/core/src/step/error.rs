//! `StepError` and `FlowError`: why a step was not made, why no flow was found.

use thiserror::Error;

use crate::algebra::LinearError;
use crate::case::rounded;
use crate::contact::ContactError;
use crate::coupling::{ShapeError, SolveError, coordinates};
use crate::motion::MotionError;

/// Why a step was not made. A shorter step or a new mesh may help, but against [`ContactError::TooWeak`] and flow errors
/// other than [`FlowError::NewtonStalled`].
#[derive(Debug, Error)]
pub enum StepError {
    /// No flow was found.
    #[error(transparent)]
    Flow(#[from] FlowError),
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
    /// The step is too long for the contact of bodies.
    #[error(
        "contact is not resolved in time: the step changes its energy {excess:.1e} times as much as is accepted"
    )]
    ContactNotResolved {
        /// Error in the energy over what is accepted.
        excess: f64,
    },
    /// The fixed-point iteration for the poses did not converge.
    #[error(
        "the poses of the bodies and the flow did not come to agree within {iterations} iterations"
    )]
    PosesNotConverged {
        /// Iterations made.
        iterations: usize,
    },
    /// Coordinates go away from where body and flow agree.
    #[error("where bodies bend and the flow differ by more from iteration to iteration")]
    PosesDiverge,
}

impl From<ShapeError> for StepError {
    fn from(error: ShapeError) -> Self {
        Self::Flow(error.into())
    }
}

impl From<MotionError> for StepError {
    fn from(error: MotionError) -> Self {
        Self::Flow(error.into())
    }
}

/// Where in a run something happened.
#[must_use]
pub fn at_step(step: usize, time: f64) -> String {
    format!("step {step} (t = {})", rounded(time))
}

/// Why no flow was found on a configuration of mesh and bodies.
#[derive(Debug, Error)]
pub enum FlowError {
    /// Newton's method did not converge.
    #[error(
        "{}: Newton's method stopped at residual {residual:.3e} after {iterations} iteration{}; {}{}",
        if *step == 0 { "steady flow".to_owned() } else { at_step(*step, *time) },
        if *iterations == 1 { "" } else { "s" },
        match *step {
            // More iterations help one that comes nearer
            0 if *residual < 1.0 => {
                "refine the mesh, raise time.steady.max_iterations, or lower the Reynolds number: \
                 there may be no steady flow"
            }
            0 => {
                "it went away from the flow: refine the mesh, or lower the Reynolds number: there may be no \
                 steady flow"
            }
            _ => "lower time.unsteady.step or refine the mesh",
        },
        found.map_or_else(String::new, |found| found.to_string())
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
        /// What a flow was found with, of a steady one.
        found: Option<FoundWith>,
    },
    /// A velocity or pressure is no longer a number.
    #[error(
        "{}: the solution is not finite near {}; \
         lower time.unsteady.step or refine the mesh there",
        at_step(*step, *time),
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
    /// The linear system is singular.
    #[error("{}: the linear system cannot be solved: {reason}", at_step(*step, *time))]
    Singular {
        /// Step.
        step: usize,
        /// Time (s).
        time: f64,
        /// Which unknown, and why it may be.
        reason: String,
    },
    /// A gait gives its body no shape at some time.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// The mesh could not be moved.
    #[error("mesh: {0}")]
    MeshMotion(#[from] MotionError),
    /// A signal, a file or a limit of time asked the run to stop.
    #[error(
        "stopped {}",
        if *step == 0 && *time == 0.0 {
            "before the first flow was found".to_owned()
        } else {
            format!("at {}", at_step(*step, *time))
        }
    )]
    Stopped {
        /// Step.
        step: usize,
        /// Time (s).
        time: f64,
    },
}

/// The part of what is not linear with which a flow was found, where it was not with all of it.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error(
    "; the last flow that was found, {}, is in failure/flow.vtu",
    if *part == 0.0 { format!("without {of}") } else { format!("with {part:.3} of the {of}") }
)]
pub struct FoundWith {
    /// Between 0 and 1.
    pub part: f64,
    /// What it is a part of.
    pub of: &'static str,
}

impl FlowError {
    /// The failure of a linear solve at a step and time (s).
    #[must_use]
    pub fn from_solve(error: SolveError, step: usize, time: f64) -> Self {
        match error {
            SolveError::NotFinite { near } => Self::NotFinite { step, time, near },
            SolveError::Linear(LinearError::Stopped(_)) => Self::Stopped { step, time },
            error => Self::Singular { step, time, reason: error.to_string() },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_and_its_noun_agree() {
        let message = |iterations| {
            let (step, time, residual) = (3, 0.5, 1e-2);
            FlowError::NewtonStalled { step, time, residual, iterations, found: None }.to_string()
        };
        assert!(message(1).contains("after 1 iteration;"), "{}", message(1));
        assert!(message(2).contains("after 2 iterations;"), "{}", message(2));
    }

    #[test]
    fn contact_too_stiff_for_explicit_steps_says_what_helps() {
        let message = ContactError::Stiff { size: 0.1, time_scale: 0.02 }.to_string();
        for remedy in ["lower the step", "soften the contact", "scheme = \"bdf2\""] {
            assert!(message.contains(remedy), "{message}");
        }
    }

    #[test]
    fn times_are_shown_without_the_rounding_of_their_last_digits() {
        let message = FlowError::Stopped { step: 6, time: 0.6000000000000001 }.to_string();
        assert_eq!(message, "stopped at step 6 (t = 0.6)");
    }

    #[test]
    fn a_flow_at_the_start_that_is_stopped_has_no_step() {
        let message = |step, time| FlowError::Stopped { step, time }.to_string();
        assert!(!message(0, 0.0).contains("step 0"), "{}", message(0, 0.0));
        assert!(message(3, 0.5).contains("step 3 (t = 0.5)"), "{}", message(3, 0.5));
    }
}
