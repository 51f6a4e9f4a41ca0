//! `Snapshot`: what an observer sees of a run; `Observer`: who looks on.

use std::sync::Arc;

use alewife_mesh::{Mesh, Point};

use super::{RunError, SavedState, StepErrorReport};
use crate::body::{Pose, Twist, Wrench};
use crate::case::{Asked, Case, Recording};
use crate::gait::RecoilCorrection;
use crate::scalar::ScalarField;
use crate::step::StopRequest;
use crate::timing::Timing;
use crate::tracer::Cloud;

/// One body at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyReport {
    /// Name in the case file.
    pub name: String,
    /// Where it is.
    pub pose: Pose,
    /// Its rigid velocity.
    pub twist: Twist,
    /// Load of the fluid, by the residual of the discrete momentum equation.
    pub load: Wrench,
    /// The same by integrating the stress over the surface: a cross-check of lower order.
    pub surface_load: Wrench,
    /// Integral of the size of the viscous stress over the surface (N).
    pub friction: f64,
    /// Load of contact with other bodies and walls.
    pub contact: Wrench,
    /// Rate of work of the body's surface on the fluid (W).
    pub power: f64,
    /// What is subtracted from the gait of a body that deforms.
    pub recoil: Option<RecoilCorrection>,
}

/// A run at one accepted step, seen but not touched.
#[derive(Debug, Clone, Copy)]
pub struct Snapshot<'a, const D: usize> {
    /// The case that is run.
    pub case: &'a Case,
    /// Number of the step, 0 for the initial state.
    pub step: usize,
    /// Time (s).
    pub time: f64,
    /// Size of the step that led here (s), 0 for the initial state or a steady solution.
    pub time_step: f64,
    /// The mesh now.
    pub mesh: &'a Mesh<D>,
    /// Velocity at the P2 nodes (m/s), in the laboratory frame.
    pub velocity: &'a [Point<D>],
    /// Pressure at the vertices (Pa).
    pub pressure: &'a [f64],
    /// Particles that the flow carries, a cloud for each `[[tracer]]` of the case.
    pub tracers: &'a [Cloud<D>],
    /// What it carries and what diffuses, one for each `[[scalar]]` of the case.
    pub scalars: &'a [ScalarField],
    /// All bodies.
    pub bodies: &'a [BodyReport],
    /// Names of the quantities of a row of `series.csv`, without `time`.
    pub names: &'a [String],
    /// Their values now.
    pub values: &'a [f64],
    /// Unknowns of the linear system.
    pub n_dofs: usize,
    /// Linear systems solved in the step.
    pub iterations: usize,
    /// What the steps so far leave; none of a steady solution.
    pub step_errors: Option<StepErrorReport>,
    /// Time spent so far.
    pub timing: &'a Timing,
    /// Whether the run ends here.
    pub is_last: bool,
}

/// The last fields of a run that failed: of the last accepted step, or the last iterate of a
/// steady solution that was not found.
#[derive(Debug, Clone, Copy)]
pub struct LastState<'a, const D: usize> {
    /// Time (s).
    pub time: f64,
    /// The mesh.
    pub mesh: &'a Mesh<D>,
    /// Velocity at the P2 nodes (m/s).
    pub velocity: &'a [Point<D>],
    /// Pressure at the vertices (Pa).
    pub pressure: &'a [f64],
    /// What the flow carries and what diffuses.
    pub scalars: &'a [ScalarField],
    /// All that evolves, for a run that resumes; none of a steady solution.
    pub saved: Option<&'a SavedState<D>>,
}

/// What is recorded of a session.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Recorded<'a> {
    /// All that was recorded before, once at its beginning.
    Before(&'a Recording),
    /// Something is asked for.
    Asked(&'a Asked),
    /// It pauses at a time (s).
    Pause(f64),
}

/// Sees everything, changes nothing.
pub trait Observer<const D: usize> {
    /// Called once for the initial state and once for each accepted step.
    ///
    /// # Errors
    /// When a file cannot be written; the run stops with it.
    fn on_step(&mut self, snapshot: &Snapshot<'_, D>) -> std::io::Result<()>;

    /// Whether it is to be given the state after the step it was just notified of.
    fn wants_state(&mut self, _snapshot: &Snapshot<'_, D>) -> bool {
        false
    }

    /// Called of all observers, in order, with a state that one of them wanted.
    ///
    /// # Errors
    /// When a file cannot be written.
    fn on_state(&mut self, _state: &Arc<SavedState<D>>) -> std::io::Result<()> {
        Ok(())
    }

    /// What to ask whether the run is to end, once at its beginning.
    fn stop_request(&self) -> Option<StopRequest> {
        None
    }

    /// Called with all that is recorded of a session, or of a run that repeats one; not of other runs.
    ///
    /// # Errors
    /// When a file cannot be written.
    fn on_recorded(&mut self, _recorded: Recorded<'_>) -> std::io::Result<()> {
        Ok(())
    }

    /// Called once after the last step of a run that reached its end, with all its time.
    ///
    /// # Errors
    /// When a file cannot be written.
    fn on_end(&mut self, _timing: &Timing) -> std::io::Result<()> {
        Ok(())
    }

    /// Called once when a run ends before its time, with the reason and the last fields there
    /// were, if any.
    ///
    /// # Errors
    /// When a file cannot be written.
    fn on_failure(
        &mut self,
        _error: &RunError,
        _last: Option<&LastState<'_, D>>,
    ) -> std::io::Result<()> {
        Ok(())
    }
}

/// An observer that somebody else owns.
pub(super) struct Borrowed<'a, const D: usize>(pub &'a mut dyn Observer<D>);

impl<const D: usize> Observer<D> for Borrowed<'_, D> {
    fn on_step(&mut self, snapshot: &Snapshot<'_, D>) -> std::io::Result<()> {
        self.0.on_step(snapshot)
    }

    fn wants_state(&mut self, snapshot: &Snapshot<'_, D>) -> bool {
        self.0.wants_state(snapshot)
    }

    fn on_state(&mut self, state: &Arc<SavedState<D>>) -> std::io::Result<()> {
        self.0.on_state(state)
    }

    fn stop_request(&self) -> Option<StopRequest> {
        self.0.stop_request()
    }

    fn on_recorded(&mut self, recorded: Recorded<'_>) -> std::io::Result<()> {
        self.0.on_recorded(recorded)
    }

    fn on_end(&mut self, timing: &Timing) -> std::io::Result<()> {
        self.0.on_end(timing)
    }

    fn on_failure(
        &mut self,
        error: &RunError,
        last: Option<&LastState<'_, D>>,
    ) -> std::io::Result<()> {
        self.0.on_failure(error, last)
    }
}
