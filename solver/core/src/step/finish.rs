//! The end of a step: loads, error, and the level it leads to, with the mesh where the bodies get to.

use super::accuracy::{StepEnd, acceleration, local_error, pose_errors};
use super::configuration::StepConfiguration;
use super::context::StepContext;
use super::coupled_flow::CoupledFlow;
use super::error::StepError;
use super::placement::Placement;
use super::stepper::{StepReport, StepResult, TimeStepper};
use super::workspace::Workspace;
use crate::body::{Pose, Twist};
use crate::contact::{ContactLoads, Gaps};
use crate::coupling::{Group, MeanMotion, Problem, PropulsionPower, Solution, mean_motion};
use crate::state::{Leg, NewLevel, PowerShare, PropulsionStep, StagePoint, State, Waypoint};

/// What the last iteration of a step has found.
struct ConvergedStep<const D: usize> {
    /// Where the bodies get to.
    pub reached: Placement,
    pub solution: Solution<D>,
    pub contact: ContactLoads,
}

impl<const D: usize> TimeStepper<'_, D> {
    /// Loads of contact with the smallest gap of bodies at these poses.
    pub(super) fn with_minimum_gap(
        &self,
        contact: ContactLoads,
        gaps: Option<&dyn Gaps>,
        state: &State<D>,
        poses: &[Pose],
    ) -> ContactLoads {
        let Some(gaps) = gaps else { return contact };
        let minimum_gap = gaps.minimum_gap(&state.in_own_frame(self.problem, poses));
        ContactLoads { minimum_gap, ..contact }
    }
}

impl<const D: usize> StepContext<'_, D> {
    /// The step with its loads, its error and the level it leads to.
    ///
    /// # Errors
    /// When the mesh degenerates where the bodies get to.
    pub fn finish(
        &self,
        work: &mut Workspace<D>,
        configuration: &StepConfiguration<D>,
        mut flow: CoupledFlow<D>,
        reached: Placement,
    ) -> Result<StepResult<D>, StepError> {
        let Self { stepper, state, history, .. } = self;
        let poses = &reached.poses;
        let bent = self.has_elastic_contact().then(|| stepper.path.gaps(&reached.shapes)).flatten();
        let gaps = bent.as_deref().or(self.gaps());
        let loads = self.loads(work, configuration, &mut flow);
        let mut error = local_error(stepper, state, &history.step, &flow.solution);
        if history.step.bdf.is_second_order() {
            let errors = pose_errors(state, &history.step, poses);
            error = error.max(stepper.gap_error(gaps, state, poses, &errors));
        }
        let errors = self.step_errors(&flow.solution, poses);
        let mut contact = stepper.with_minimum_gap(flow.contact, gaps, state, poses);
        let end = StepEnd { gaps, solution: &flow.solution, reached: &reached, loads: &contact };
        let energy = self.contact_energy(configuration, &end);
        contact.energy = energy.stored;
        contact.energy_made = state.contact.energy_made + energy.made;
        let report = StepReport {
            loads: loads.surfaces,
            iterations: flow.n_systems,
            error,
            contact_error: energy.error,
            errors,
        };
        let end = ConvergedStep { contact, solution: flow.solution, reached };
        let level = self.new_level(work, configuration, end, &loads.propulsion)?;
        Ok(StepResult { level, report })
    }

    /// The new level, with the mesh moved to where the bodies get to.
    ///
    /// # Errors
    /// When it degenerates there.
    fn new_level(
        &self,
        work: &mut Workspace<D>,
        configuration: &StepConfiguration<D>,
        end: ConvergedStep<D>,
        propulsion: &[PropulsionPower],
    ) -> Result<NewLevel<D>, StepError> {
        let Self { stepper, state, history, .. } = self;
        let ConvergedStep { reached, solution, contact } = end;
        let Placement { poses, coordinates, shapes } = reached;
        let bdf = &history.step.bdf;
        let nodes = stepper.path.move_mesh(work, stepper.problem, state, &poses, &shapes)?;
        let rates = solution.velocity.iter().zip(&history.derivative);
        let twists = solution.twists.iter().zip(&configuration.bodies.bodies);
        let older = state.now.twists.iter().zip(&state.previous.twists);
        let twist_rates = solution.twists.iter().zip(older).map(|(new, (now, before))| {
            let [new, now, before] = [new, now, before].map(Twist::to_vector);
            Twist::from_vector(&bdf.rate(new, now, before))
        });
        let legs = legs(stepper.problem, state, &[], &poses, &solution.twists);
        Ok(NewLevel {
            time: history.step.time,
            step: bdf.step,
            rates: Some(rates.map(|(new, older)| new * bdf.next + older).collect()),
            accelerations: twists.map(|(twist, body)| acceleration(bdf, twist, body)).collect(),
            twist_rates: twist_rates.collect(),
            coordinate_accelerations: history.accelerations_with(state, &solution.rates),
            coordinates,
            nodes,
            poses,
            contact,
            propulsion: propulsion_steps(state, propulsion, &legs, bdf.is_second_order()),
            solution,
        })
    }
}

/// What the groups do in a step that ends with these powers: their integral by the trapezoidal
/// rule.
fn propulsion_steps<const D: usize>(
    state: &State<D>,
    ends: &[PropulsionPower],
    legs: &[Option<Leg>],
    is_second_order: bool,
) -> Vec<PropulsionStep> {
    let step = |((end, before), leg): ((&PropulsionPower, PropulsionPower), &Option<Leg>)| {
        let share = |power: PropulsionPower, share: f64| PowerShare { power, share };
        // Of a first-order step, by its scheme or after a jump, what was before does not count
        let shares = if is_second_order {
            vec![share(before, 0.5), share(*end, 0.5)]
        } else {
            vec![share(*end, 1.0)]
        };
        PropulsionStep { shares, end: *end, leg: leg.clone() }
    };
    let before = state.propulsion.iter().map(|history| history.power());
    ends.iter().zip(before).zip(legs).map(step).collect()
}

/// Bodies at a stage of a step.
pub(super) struct StageMotion {
    /// When it is, as a part of the step.
    pub part: f64,
    /// Poses of the bodies.
    pub poses: Vec<Pose>,
    /// Their velocities.
    pub twists: Vec<Twist>,
}

/// The ways of the groups in a step to poses with these velocities, by way of stages, of which the
/// first one is its beginning; none where poses are not all that evolves, or without a cycle.
pub(super) fn legs<const D: usize>(
    problem: &Problem<D>,
    state: &State<D>,
    stages: &[StageMotion],
    poses: &[Pose],
    twists: &[Twist],
) -> Vec<Option<Leg>> {
    let at = |group: &Group, poses: &[Pose], twists: &[Twist]| {
        let MeanMotion { center, twist } = mean_motion(problem, group, poses, twists);
        let first = group.bodies[0];
        let pose = Pose { center, orientation: poses[first].orientation };
        Waypoint { pose, velocity: Twist { linear: twist.linear, angular: twists[first].angular } }
    };
    let leg = |group: &Group| {
        let at_stage = |stage: &StageMotion| at(group, &stage.poses, &stage.twists);
        let stage_point =
            |stage: &StageMotion| StagePoint { part: stage.part, at: at_stage(stage) };
        let start = || {
            let pose = at(group, &state.poses, &state.now.twists).pose;
            (pose, stages.first().map(|stage| at_stage(stage).velocity))
        };
        Leg {
            start: (state.last_step == 0.0).then(start),
            stages: stages.iter().skip(1).map(stage_point).collect(),
            end: at(group, poses, twists),
        }
    };
    let is_estimated = |group: &Group| group.period.is_some() && !problem.has_inertia;
    problem.groups.iter().map(|group| is_estimated(group).then(|| leg(group))).collect()
}
