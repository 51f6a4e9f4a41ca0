//! `StepContext`: what a step starts from; `Iterate`: what each iteration for the poses starts from.

use super::configuration::{StepConfiguration, StepEquations};
use super::error::StepError;
use super::history::StepHistory;
use super::placement::Placement;
use super::stepper::{Step, TimeStepper};
use crate::body::Pose;
use crate::contact::{BodyDynamics, CoupledContact, Gaps};
use crate::coupling::{RigidBodyEquations, Solution};
use crate::motion::GapsAt;
use crate::state::State;
use crate::time::Bdf;

/// A step that is made from a state, which stays as it is.
pub(super) struct StepContext<'a, const D: usize> {
    pub stepper: TimeStepper<'a, D>,
    pub state: &'a State<D>,
    pub history: StepHistory<D>,
    gaps: Option<GapsAt<'a>>,
}

/// What an iteration for the poses starts from.
pub(super) struct Iterate<const D: usize> {
    /// Where bodies are at the new time.
    pub placement: Placement,
    /// Where bodies are expected to be apart.
    pub apart: Apart,
    /// First guess of the flow.
    pub guess: Guess<D>,
}

/// Where bodies are expected to be apart.
pub(super) struct Apart {
    pub poses: Vec<Pose>,
    /// Coordinates of all bodies that have some.
    pub coordinates: Vec<f64>,
}

/// What a flow is solved from.
pub(super) struct Guess<const D: usize> {
    pub solution: Solution<D>,
    /// Initial residual of the first iteration for the poses: it sets the linear tolerance of later ones.
    pub scale: Option<f64>,
    /// Linear systems of the flow solved before, without those for contact.
    pub n_systems: usize,
}

impl<const D: usize> Guess<D> {
    /// Nothing but a solution.
    pub fn new(solution: Solution<D>) -> Self {
        Self { solution, scale: None, n_systems: 0 }
    }
}

impl<'a, const D: usize> StepContext<'a, D> {
    /// A step by backward differences.
    ///
    /// # Errors
    /// When a gait gives its body no shape.
    pub fn new(
        stepper: TimeStepper<'a, D>,
        state: &'a State<D>,
        bdf: Bdf,
    ) -> Result<Self, StepError> {
        let history = StepHistory::new(&stepper, state, Step::from(state, bdf))?;
        Ok(Self::with_history(stepper, state, history))
    }

    /// A step, or a stage of one, with its history.
    pub fn with_history(
        stepper: TimeStepper<'a, D>,
        state: &'a State<D>,
        history: StepHistory<D>,
    ) -> Self {
        let shapes = &history.shapes;
        let has_elastic = stepper.contact.is_some() && stepper.problem.n_coordinates() > 0;
        let before = has_elastic
            .then(|| shapes.with_coordinates(&stepper.problem.bodies, &state.shapes.now).ok());
        let gaps = stepper.path.gaps(before.flatten().as_ref().unwrap_or(shapes));
        Self { stepper, state, history, gaps }
    }

    /// The gaps between bodies as they are shaped at the new time, and walls; with contact, bodies with coordinates have
    /// those before the step.
    pub fn gaps(&self) -> Option<&dyn Gaps> {
        self.gaps.as_deref()
    }

    /// What contact is to know of a configuration with bodies at poses; none where bodies have no contact.
    pub fn contact_at(
        &self,
        poses: &[Pose],
        equations: &RigidBodyEquations,
    ) -> Option<CoupledContact<'_>> {
        let Self { stepper, state, history, .. } = self;
        let (law, gaps) = (stepper.contact?, self.gaps()?);
        let origin = state.origin_at(stepper.problem, poses);
        let levels = state.poses.iter().zip(poses).zip(&state.previous_poses);
        let velocity = |((now, next), before): ((&Pose, &Pose), &Pose)| {
            now.velocity_to(&history.step.bdf, next, before)
        };
        Some(CoupledContact {
            gaps,
            law,
            start: state.in_frame(&origin, &state.poses).into_vec(),
            predicted: state.in_frame(&origin, poses).into_vec(),
            predicted_velocities: levels.map(velocity).collect(),
            dynamics: BodyDynamics {
                rate: history.step.bdf.next,
                inertia: equations.bodies.iter().map(|body| body.inertia).collect(),
                resistance: equations.bodies.iter().map(|body| body.resistance).collect(),
                viscosity: stepper.problem.viscosity.zero_shear(),
            },
            elastic: self.elastic_at(origin, equations),
        })
    }

    /// The equations of the flow on a configuration.
    pub fn equations<'b>(
        &'b self,
        configuration: &'b StepConfiguration<D>,
    ) -> StepEquations<'b, D> {
        let TimeStepper { problem, convection, contact, .. } = self.stepper;
        let has_contact = contact.is_some();
        StepEquations { problem, convection, history: &self.history, configuration, has_contact }
    }
}
