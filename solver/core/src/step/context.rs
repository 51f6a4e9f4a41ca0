//! `StepContext`: what a step starts from, and its parts: predict, place, solve, integrate, finish.

use super::configuration::{StepConfiguration, StepEquations};
use super::coupled_flow::{CoupledFlow, FlowUnderLoads};
use super::error::StepError;
use super::error_estimate::{local_error, pose_errors};
use super::history::StepHistory;
use super::new_level::ConvergedStep;
use super::newton::{Criterion, Flow, newton};
use super::stepper::{Step, StepReport, StepResult, TimeStepper};
use super::workspace::Workspace;
use crate::body::{Pose, Twist};
use crate::contact::{
    BodyDynamics, ByMobility, ByQuasiNewton, ContactLoads, ContactPrediction, CoupledContact,
    CoupledSolver, Gaps,
};
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
    /// Poses of the bodies at the new time, in the laboratory.
    pub poses: Vec<Pose>,
    /// Poses in which bodies are apart.
    apart: Vec<Pose>,
    /// First guess of the flow.
    pub guess: Guess<D>,
}

/// What a flow is solved from.
pub(super) struct Guess<const D: usize> {
    solution: Solution<D>,
    /// First residual of the first iteration, which all others are relative to.
    scale: Option<f64>,
    /// Linear systems solved before.
    n_systems: usize,
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
        let gaps = stepper.path.gaps(&history.shapes);
        Self { stepper, state, history, gaps }
    }

    /// The gaps between bodies as they are shaped at the new time, and walls.
    pub fn gaps(&self) -> Option<&dyn Gaps> {
        self.gaps.as_deref()
    }

    /// How contact is found in the flow of this step.
    pub fn contact_method(&self, work: &Workspace<D>) -> Box<dyn CoupledSolver<StepError>> {
        if work.system.is_iterative() {
            Box::new(ByQuasiNewton::default())
        } else {
            Box::new(ByMobility)
        }
    }

    /// Poses and flow at the new time, extrapolated, with contact as it is expected there.
    pub fn predict(&self, work: &Workspace<D>) -> Iterate<D> {
        let twists = self.extrapolated_twists();
        let poses = self.integrate(&twists);
        let in_contact = self.predict_contact(work, &twists, &poses);
        Iterate {
            poses: in_contact.map_or(poses, |twists| self.integrate(&twists)),
            apart: self.state.poses.clone(),
            guess: Guess::new(self.history.extrapolated.clone()),
        }
    }

    /// Velocities at the new time with contact as it is expected, where there may be any.
    fn predict_contact(
        &self,
        work: &Workspace<D>,
        extrapolated: &[Twist],
        poses: &[Pose],
    ) -> Option<Vec<Twist>> {
        let Self { stepper: TimeStepper { problem, .. }, state, history, .. } = self;
        let equations = history.body_equations(problem, &state.poses);
        let prediction = ContactPrediction {
            contact: self.contact_at(poses, &equations)?,
            extrapolated,
            velocities: &state.now.twists,
            accelerations: &state.accelerations,
            older: equations.bodies.iter().map(|body| body.history).collect(),
            loads: &state.contact,
        };
        let bodies = state.in_mesh(&state.poses);
        let time = history.boundary_shapes().time();
        prediction.velocities(|loaded| work.system.free_motions_at(problem, &bodies, time, loaded))
    }

    /// What contact is to know of a configuration with bodies at poses; none where bodies have no contact.
    fn contact_at(
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
            start: state.in_frame(&origin, &state.poses),
            predicted: state.in_frame(&origin, poses),
            predicted_velocities: levels.map(velocity).collect(),
            dynamics: BodyDynamics {
                rate: history.step.bdf.next,
                inertia: equations.bodies.iter().map(|body| body.inertia).collect(),
                resistance: equations.bodies.iter().map(|body| body.resistance).collect(),
                viscosity: stepper.problem.viscosity,
            },
        })
    }

    /// Shortens displacements where bodies would get too near to each other: predictions know nothing of what is in the way.
    pub fn keep_gaps_open(&self, iterate: &mut Iterate<D>) {
        let Some(gaps) = self.gaps() else { return };
        let Iterate { poses, apart, .. } = iterate;
        let between = |part: f64| -> Vec<Pose> {
            let pairs = apart.iter().zip(&*poses);
            pairs.map(|(from, to)| from.displaced(&(to.displacement_from(from) * part))).collect()
        };
        let part = gaps.part_that_keeps_open(&|part| {
            let seen = |poses: &[Pose]| self.state.in_own_frame(self.stepper.problem, poses);
            match part {
                0.0 => seen(apart),
                1.0 => seen(poses),
                part => seen(&between(part)),
            }
        });
        if part < 1.0 {
            *poses = between(part);
        }
    }

    /// Solves for flow and contact on a configuration.
    ///
    /// # Errors
    /// When the linear system cannot be solved, Newton's method stalls, or contact forces are not found.
    pub fn solve(
        &self,
        work: &mut Workspace<D>,
        configuration: &mut StepConfiguration<D>,
        method: &mut dyn CoupledSolver<StepError>,
        guess: Guess<D>,
    ) -> Result<CoupledFlow<D>, StepError> {
        let contact = self.contact_at(&configuration.poses, &configuration.bodies);
        let first = contact.as_ref().and_then(|contact| method.first_loads(contact));
        if let Some(loads) = &first {
            configuration.bodies.add_external(&loads.wrenches);
        }
        let has_contact = first.is_some_and(|loads| !loads.contacts.is_empty());
        let (first_scale, n_systems) = (guess.scale, guess.n_systems);
        let flow = self.solve_flow(work, configuration, guess, has_contact)?;
        let scale = first_scale.unwrap_or(flow.scale);
        let mut flow = FlowUnderLoads::new(self, configuration, work, flow);
        let loads = match &contact {
            Some(contact) => method.solve(contact, &mut flow)?,
            None => ContactLoads::none(self.state.poses.len()),
        };
        let mut flow = flow.with_contact(loads);
        (flow.scale, flow.n_systems) = (scale, flow.n_systems + n_systems);
        Ok(flow)
    }

    /// Solves for the flow on a configuration with the loads on its bodies.
    ///
    /// # Errors
    /// When the linear system cannot be solved, or Newton's method stalls.
    pub fn solve_flow(
        &self,
        work: &mut Workspace<D>,
        configuration: &StepConfiguration<D>,
        guess: Guess<D>,
        has_contact: bool,
    ) -> Result<Flow<D>, StepError> {
        let equations = self.equations(configuration);
        let Workspace { system, mesh, timing } = work;
        let at = configuration.system(self.stepper.problem, mesh);
        let start = system.constrained(at.constraints, &guess.solution);
        let criterion = Criterion::of_step(equations.is_linear(), guess.scale, has_contact);
        newton(system, timing, &at, &equations, &criterion, start)
            .map_err(|failure| failure.in_step(&self.history.step).into())
    }

    /// The equations of the flow on a configuration.
    pub fn equations<'b>(
        &'b self,
        configuration: &'b StepConfiguration<D>,
    ) -> StepEquations<'b, D> {
        let TimeStepper { problem, convection, .. } = self.stepper;
        StepEquations { problem, convection, history: &self.history, configuration }
    }

    /// What the next iteration for the poses starts from.
    pub fn iterate_again(
        &self,
        configuration: StepConfiguration<D>,
        flow: CoupledFlow<D>,
        reached: Vec<Pose>,
    ) -> Iterate<D> {
        let CoupledFlow { solution, scale, n_systems, .. } = flow;
        let guess = Guess { solution, scale: Some(scale), n_systems };
        Iterate { poses: reached, apart: configuration.poses, guess }
    }

    /// The step with its loads, its error and the level it leads to.
    ///
    /// # Errors
    /// When the mesh degenerates where the bodies get to.
    pub fn finish(
        &self,
        work: &mut Workspace<D>,
        configuration: &StepConfiguration<D>,
        mut flow: CoupledFlow<D>,
        reached: Vec<Pose>,
    ) -> Result<StepResult<D>, StepError> {
        let Self { stepper, state, history, .. } = self;
        let loads = self.loads(work, configuration, &mut flow);
        let mut error = local_error(stepper, state, &history.step, &flow.solution);
        if history.step.bdf.is_second_order() {
            let errors = pose_errors(state, &history.step, &reached);
            error = error.max(stepper.gap_error(self.gaps(), state, &reached, &errors));
        }
        let report = StepReport { loads: loads.surfaces, iterations: flow.n_systems, error };
        let end = ConvergedStep {
            contact: stepper.with_minimum_gap(flow.contact, self.gaps(), state, &reached),
            solution: flow.solution,
            poses: reached,
        };
        let level = self.new_level(work, configuration, end, &loads.propulsion)?;
        Ok(StepResult { level, report })
    }
}
