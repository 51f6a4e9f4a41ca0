//! Contact forces of one pass: found for the gaps at the end of the step, and added to the flow.

use nalgebra::DMatrix;

use super::error::StepError;
use super::newton::{Flow, flow_residual};
use super::pass::PassEquations;
use super::predict::integrate_poses;
use super::state::State;
use super::stepper::TimeStepper;
use super::workspace::Workspace;
use super::{RunError, Stage};
use crate::body::{Pose, Twist};
use crate::contact::{ContactLoads, ContactSolution, ContactStep, Gaps, Law};
use crate::coupling::{BodyLoad, LoadedBody, SolveError};

/// Contact is looked for where bodies may get to with this times their displacement.
const CONTACT_MARGIN: f64 = 2.0;

/// What contact needs to know of a pass.
pub(super) struct PassContact<'a, const D: usize> {
    pub stepper: &'a TimeStepper<'a, D>,
    pub state: &'a State<D>,
    pub gaps: Option<&'a dyn Gaps>,
    pub equations: &'a PassEquations<'a, D>,
}

impl<const D: usize> PassContact<'_, D> {
    /// Adds contact to a flow found without it; loads of contact on all bodies.
    ///
    /// # Errors
    /// When contact forces are not found, or the linear system cannot be solved.
    pub fn apply(
        &self,
        work: &mut Workspace<D>,
        flow: &mut Flow<D>,
    ) -> Result<ContactLoads, StepError> {
        let none = ContactLoads::none(self.state.poses.len());
        let (Some(law), Some(gaps)) = (self.stepper.contact, self.gaps) else { return Ok(none) };
        let candidates = self.candidate_bodies(gaps, law, &flow.solution.twists);
        if candidates.is_empty() {
            return Ok(none);
        }
        let Workspace { system, timing, .. } = &mut *work;
        let step = &self.equations.history.step;
        let fail = |error: SolveError| RunError::from_solve(error, step.number, step.time);
        let constraints = &self.equations.pass.constraints;
        let loaded = loaded_bodies(gaps, &candidates);
        let mobility = system.mobility(constraints, &loaded, timing).map_err(fail)?;
        let loads = self.solve(gaps, law, &candidates, &flow.solution.twists, &mobility)?.loads;
        add_to_flow(work, self.equations, &loads, &candidates, flow)?;
        Ok(loads)
    }

    /// Poses as seen from where the frame is in this pass: its way is no part of the unknowns.
    fn seen(&self, poses: &[Pose]) -> Vec<Pose> {
        let origin = self.state.origin_at(self.stepper.problem, &self.equations.pass.poses);
        self.state.in_frame(&origin, poses)
    }

    /// The bodies that may get within the range of something with velocities found without contact.
    fn candidate_bodies(&self, gaps: &dyn Gaps, law: &Law, twists: &[Twist]) -> Vec<usize> {
        let step = &self.equations.history.step;
        let without = integrate_poses(self.stepper, self.state, step, twists);
        let (from, to) = (self.seen(&self.state.poses), self.seen(&without));
        gaps.candidate_bodies(&from, &to, CONTACT_MARGIN, law.range())
    }

    /// The contact forces for velocities found without them.
    fn solve(
        &self,
        gaps: &dyn Gaps,
        law: &Law,
        bodies: &[usize],
        twists: &[Twist],
        mobility: &DMatrix<f64>,
    ) -> Result<ContactSolution, StepError> {
        let (state, bdf) = (self.state, &self.equations.history.step.bdf);
        let poses = &self.equations.pass.poses;
        let free_velocities: Vec<Twist> = bodies.iter().map(|&body| twists[body]).collect();
        let predicted_velocities: Vec<Twist> = bodies
            .iter()
            .map(|&body| {
                state.poses[body].velocity_to(bdf, &poses[body], &state.previous_poses[body])
            })
            .collect();
        let step = ContactStep {
            gaps,
            law,
            modes: self.stepper.problem.modes(),
            bodies,
            free_velocities: &free_velocities,
            mobility,
            predicted: &self.seen(poses),
            predicted_velocities: &predicted_velocities,
            coefficient: 1.0 / bdf.next,
            start: &self.seen(&state.poses),
        };
        Ok(step.solve()?)
    }
}

/// Bodies that may be in contact, as the mobility is asked for them: contact does not turn those that are round.
pub(super) fn loaded_bodies(gaps: &dyn Gaps, bodies: &[usize]) -> Vec<LoadedBody> {
    let loaded = |&body: &usize| LoadedBody { body, turns: !gaps.is_round(body) };
    bodies.iter().map(loaded).collect()
}

/// Adds what loads of contact on some bodies change in a flow found without them, and its residual.
///
/// # Errors
/// When the linear system cannot be solved.
pub(super) fn add_to_flow<const D: usize>(
    work: &mut Workspace<D>,
    equations: &PassEquations<'_, D>,
    loads: &ContactLoads,
    bodies: &[usize],
    flow: &mut Flow<D>,
) -> Result<(), StepError> {
    let Workspace { system, mesh, timing } = work;
    let on_body = |&body: &usize| BodyLoad { body, load: loads.wrenches[body].to_vector() };
    let on_bodies: Vec<BodyLoad> = bodies.iter().map(on_body).collect();
    if on_bodies.iter().any(|on_body| on_body.load.iter().any(|part| *part != 0.0)) {
        let step = &equations.history.step;
        system
            .apply_body_loads(&equations.pass.constraints, &on_bodies, &mut flow.solution, timing)
            .map_err(|error| RunError::from_solve(error, step.number, step.time))?;
    }
    let at = equations.pass.at(equations.problem, mesh);
    flow.residual =
        timing.measure(Stage::Loads, || flow_residual(system, &at, equations, &flow.solution));
    Ok(())
}
