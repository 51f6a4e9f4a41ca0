//! `TimeStepper`: problem, mesh motion and contact law of a step; `Step` and what it leaves.

use std::sync::Arc;

use super::error::{FlowError, StepError};
use super::mesh_path::MeshPath;
use crate::case::Convection;
use crate::contact::Law;
use crate::coupling::{Problem, SurfaceLoads};
use crate::state::{NewLevel, State, StepErrors};
use crate::time::Bdf;

/// Whether a run is to end, asked between steps and within long ones; what is not yet a whole step is
/// then left out.
pub type StopRequest = Arc<dyn Fn() -> bool + Send + Sync>;

/// What stays the same from step to step while the mesh lasts.
#[derive(Clone, Copy)]
pub struct TimeStepper<'a, const D: usize> {
    /// What is solved.
    pub problem: &'a Problem<D>,
    /// How convection is taken.
    pub convection: Convection,
    /// How the mesh moves.
    pub path: MeshPath<'a, D>,
    /// The law of contact, if any.
    pub contact: Option<&'a Law>,
    /// What to ask whether the run is to end.
    pub stop: Option<&'a StopRequest>,
}

impl<const D: usize> TimeStepper<'_, D> {
    /// Ends a step where the run is to end.
    ///
    /// # Errors
    /// When it is.
    pub(super) fn check_stop(&self, state: &State<D>) -> Result<(), StepError> {
        match self.stop {
            Some(stop) if stop() => {
                Err(FlowError::Stopped { step: state.step, time: state.time }.into())
            }
            _ => Ok(()),
        }
    }
}

/// A step in time.
#[derive(Debug, Clone, Copy)]
pub struct Step {
    /// Its number, from one.
    pub number: usize,
    /// The new time (s).
    pub time: f64,
    /// Backward differences at the new time.
    pub bdf: Bdf,
}

impl Step {
    /// The step from a state by some backward differences.
    #[must_use]
    pub fn from<const D: usize>(state: &State<D>, bdf: Bdf) -> Self {
        Self { number: state.step + 1, time: state.time + bdf.step, bdf }
    }
}

/// What a step leaves for measurements and for the choice of the next step.
#[derive(Debug, Clone)]
pub struct StepReport {
    /// Loads of the fluid on the bodies, where the flow was solved for.
    pub loads: SurfaceLoads,
    /// Linear systems of the flow solved, without those for contact.
    pub iterations: usize,
    /// Estimate of the error of the step, relative to the largest speed, or ten times that of the smallest gap, relative to
    /// it, where that is more; zero for a step of first order.
    pub error: f64,
    /// Error of the step in the energy of bodies in contact, over what is accepted; zero without contact or inertia.
    pub contact_error: f64,
    /// What the step leaves in flow and poses.
    pub errors: StepErrors,
}

/// What a step leads to.
#[derive(Debug, Clone)]
pub struct StepResult<const D: usize> {
    /// The new level, which [`State::accept`] takes on.
    pub level: NewLevel<D>,
    /// What is reported of the step.
    pub report: StepReport,
}
