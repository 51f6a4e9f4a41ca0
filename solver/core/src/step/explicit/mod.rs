//! Explicit steps of the `stokes` model, where poses of bodies are all that evolves.
//!
//! dq/dt = V(q, t), one Stokes flow a stage, by the third-order method of @bogacki1989 with an error
//! estimate of second order. Its last stage is the flow at the new time, and the first one of the
//! next step. Rotations are added as rotation vectors from the beginning of the step, whose rates are
//! not angular velocities (@munthekaas1998).

use alewife_mesh::Point;

use super::accuracy::NEARLY_AT_REST;
use super::context::{Guess, StepContext};
use super::coupled_flow::FlowUnderLoads;
use super::error::StepError;
use super::finish::{StageMotion, legs};
use super::history::{INSIDE, StepHistory};
use super::stepper::{StepReport, StepResult, TimeStepper};
use super::workspace::Workspace;
use crate::body::{Pose, RigidVector, Twist, rate_of_displacement};
use crate::contact::{ContactLoads, StageContact};
use crate::coupling::{PropulsionPower, Solution, SurfaceLoads};
use crate::state::{NewLevel, PowerShare, PropulsionStep, State, StepErrors};

/// Displacement over the distance from the origin that is rounding.
const ROUNDING: f64 = 1e-12;

/// A stage after the first.
pub struct Stage {
    /// Its time as a part of the step.
    pub part: f64,
    /// Weights of the stages before in its poses.
    pub weights: &'static [f64],
}

impl Stage {
    /// When it is in a step of a size (s); at the end of the step rates are those before it.
    fn instant<const D: usize>(&self, state: &State<D>, size: f64) -> Instant {
        let time = state.time + self.part * size;
        let rates_at = if self.part < 1.0 { time } else { time - INSIDE * size };
        Instant { step: size, time, rates_at }
    }
}

/// The stages after the first; the last one is at the end.
pub const STAGES: [Stage; 3] = [
    Stage { part: 0.5, weights: &[0.5] },
    Stage { part: 0.75, weights: &[0.0, 0.75] },
    Stage { part: 1.0, weights: &[2.0 / 9.0, 1.0 / 3.0, 4.0 / 9.0] },
];
/// Weights of the stages in the error of the new poses.
const ERROR: [f64; 4] = [-5.0 / 72.0, 1.0 / 12.0, 1.0 / 9.0, -1.0 / 8.0];

/// When a flow is instantaneous, and in which step.
#[derive(Debug, Clone, Copy)]
struct Instant {
    /// Size of the step (s).
    step: f64,
    /// Time of the shapes (s).
    time: f64,
    /// Time at which rates of gaits and boundary values are taken (s).
    rates_at: f64,
}

/// A flow that belongs to bodies at their poses.
struct InstantaneousFlow<const D: usize> {
    solution: Solution<D>,
    loads: SurfaceLoads,
    powers: Vec<PropulsionPower>,
    contact: ContactLoads,
    nodes: Vec<Point<D>>,
    iterations: usize,
}

/// What the stages of a step have given so far.
struct Stages<const D: usize> {
    /// Rates of the displacements of the bodies since the beginning of the step, by stage.
    rates: Vec<Vec<RigidVector>>,
    /// Powers of the groups, by stage.
    powers: Vec<Vec<PropulsionPower>>,
    /// Bodies at the beginning and at each stage.
    motions: Vec<StageMotion>,
    /// Flow of the last stage, from which the next one starts.
    last: Solution<D>,
    iterations: usize,
}

impl<const D: usize> Stages<D> {
    /// Adds the flow of bodies at poses in a step from others.
    fn push(&mut self, flow: &InstantaneousFlow<D>, from: &[Pose], poses: &[Pose], part: f64) {
        let ways = from.iter().zip(poses).zip(&flow.solution.twists);
        let rate = |((from, pose), twist): ((&Pose, &Pose), &Twist)| {
            rate_of_displacement(&pose.displacement_from(from), twist)
        };
        self.rates.push(ways.map(rate).collect());
        self.powers.push(flow.powers.clone());
        let twists = flow.solution.twists.clone();
        self.motions.push(StageMotion { part, poses: poses.to_vec(), twists });
        self.last = flow.solution.clone();
        self.iterations += flow.iterations;
    }
}

fn rates_of<const D: usize>(solution: &Solution<D>) -> Vec<RigidVector> {
    solution.twists.iter().map(Twist::to_vector).collect()
}

impl<const D: usize> TimeStepper<'_, D> {
    /// What a step of a size (s) leads to from a state, which stays where it is. `rates_jump` says that rates jump at its
    /// beginning.
    ///
    /// # Errors
    /// When the system is singular, the solution not finite, a gait fails, or the mesh degenerates.
    pub fn advance_explicitly(
        &self,
        work: &mut Workspace<D>,
        state: &State<D>,
        size: f64,
        rates_jump: bool,
    ) -> Result<StepResult<D>, StepError> {
        let mut stages = self.first_stage(work, state, size, rates_jump)?;
        let [first, second, third] = STAGES;
        for stage in [first, second] {
            let poses = self.stage_poses(state, &stages.rates, &stage, size);
            let flow =
                self.flow_at(work, state, &poses, stage.instant(state, size), &stages.last)?;
            stages.push(&flow, &state.poses, &poses, stage.part);
        }
        let poses = self.stage_poses(state, &stages.rates, &third, size);
        let flow = self.flow_at(work, state, &poses, third.instant(state, size), &stages.last)?;
        stages.push(&flow, &state.poses, &poses, third.part);
        let errors = explicit_errors(&stages.rates);
        let ways: Vec<RigidVector> = errors.iter().map(|error| error * size).collect();
        let report = StepReport {
            loads: flow.loads.clone(),
            iterations: stages.iterations,
            error: self.explicit_error(state, &poses, &stages.rates, size)?,
            contact_error: 0.0,
            errors: StepErrors {
                ways: self.errors_of_ways(state, &poses, &ways),
                ..StepErrors::default()
            },
        };
        let level = self.explicit_level(state, size, flow, poses, &stages)?;
        Ok(StepResult { level, report })
    }

    /// The flow at the beginning, which is that of the state unless rates or loads jump.
    fn first_stage(
        &self,
        work: &mut Workspace<D>,
        state: &State<D>,
        size: f64,
        rates_jump: bool,
    ) -> Result<Stages<D>, StepError> {
        let mut stages = Stages {
            rates: Vec::new(),
            powers: Vec::new(),
            motions: Vec::new(),
            last: state.now.clone(),
            iterations: 0,
        };
        if rates_jump {
            let rates_at = state.time + INSIDE * size;
            let at = Instant { step: size, time: state.time, rates_at };
            let flow = self.flow_at(work, state, &state.poses, at, &state.now)?;
            stages.push(&flow, &state.poses, &state.poses, 0.0);
        } else {
            stages.rates.push(rates_of(&state.now));
            stages.powers.push(state.propulsion.iter().map(|history| history.power()).collect());
            let (poses, twists) = (state.poses.clone(), state.now.twists.clone());
            stages.motions.push(StageMotion { part: 0.0, poses, twists });
        }
        Ok(stages)
    }

    /// Poses of a stage; bodies that hang on others follow them exactly.
    fn stage_poses(
        &self,
        state: &State<D>,
        rates: &[Vec<RigidVector>],
        stage: &Stage,
        size: f64,
    ) -> Vec<Pose> {
        let pose = |(body, from): (usize, &Pose)| {
            let weighted =
                rates.iter().zip(stage.weights).map(|(rate, weight)| rate[body] * *weight);
            let displacement = weighted.fold(RigidVector::zeros(), |sum, part| sum + part) * size;
            from.displaced(&self.restricted(body, &displacement))
        };
        let mut poses: Vec<Pose> = state.poses.iter().enumerate().map(pose).collect();
        self.problem.apply_joints(&mut poses, state.time + stage.part * size);
        poses
    }

    /// The flow of bodies at poses at an instant, from a first guess.
    fn flow_at(
        &self,
        work: &mut Workspace<D>,
        state: &State<D>,
        poses: &[Pose],
        at: Instant,
        guess: &Solution<D>,
    ) -> Result<InstantaneousFlow<D>, StepError> {
        self.check_stop(state)?;
        let number = state.step + 1;
        let history =
            StepHistory::instantaneous(self.problem, number, poses, at.time, at.rates_at)?;
        let step = StepContext::with_history(*self, state, history);
        let seen = state.in_own_frame(self.problem, poses);
        let contact = self.contact.zip(step.gaps());
        let contact = contact.map(|(law, gaps)| StageContact::new(law, gaps, &seen)).transpose()?;
        let placement = step.placement(poses.to_vec(), Vec::new())?;
        let configuration = step.place(work, placement)?;
        let flow = step.solve_flow(work, &configuration, Guess::new(guess.clone()), false)?;
        let mut flow = FlowUnderLoads::new(&step, &configuration, work, flow);
        if let Some(contact) = &contact {
            contact.add_to(&mut flow, at.step)?;
        }
        let none = || ContactLoads::none(poses.len());
        let mut flow = flow.with_contact(contact.map_or_else(none, |contact| contact.loads));
        let loads = step.loads(work, &configuration, &mut flow);
        Ok(InstantaneousFlow {
            solution: flow.solution,
            loads: loads.surfaces,
            powers: loads.propulsion,
            contact: flow.contact,
            nodes: configuration.nodes,
            iterations: flow.n_systems,
        })
    }

    fn explicit_level(
        &self,
        state: &State<D>,
        size: f64,
        flow: InstantaneousFlow<D>,
        poses: Vec<Pose>,
        stages: &Stages<D>,
    ) -> Result<NewLevel<D>, StepError> {
        let time = state.time + size;
        let gaps = self.path.gaps_at_time(&self.problem.bodies, time)?;
        let contact = self.with_minimum_gap(flow.contact, gaps.as_deref(), state, &poses);
        let twists = flow.solution.twists.iter().zip(&state.now.twists);
        let accelerations: Vec<Twist> = twists
            .map(|(new, old)| Twist::from_vector(&((new.to_vector() - old.to_vector()) / size)))
            .collect();
        let Stages { powers, motions, .. } = stages;
        let within = &motions[..STAGES.len()];
        let legs = legs(self.problem, state, within, &poses, &flow.solution.twists);
        let propulsion = legs.into_iter().enumerate().map(|(group, leg)| {
            let stages = powers.iter().zip(STAGES[2].weights);
            let shares =
                stages.map(|(stage, share)| PowerShare { power: stage[group], share: *share });
            PropulsionStep { shares: shares.collect(), end: powers[STAGES.len()][group], leg }
        });
        Ok(NewLevel {
            time,
            step: size,
            twist_rates: accelerations.clone(),
            accelerations,
            propulsion: propulsion.collect(),
            solution: flow.solution,
            nodes: flow.nodes,
            rates: None,
            coordinates: Vec::new(),
            coordinate_accelerations: Vec::new(),
            poses,
            contact,
        })
    }

    /// Error of the new poses over the largest velocity of a step, at most, or that of the smallest gap.
    fn explicit_error(
        &self,
        state: &State<D>,
        poses: &[Pose],
        rates: &[Vec<RigidVector>],
        size: f64,
    ) -> Result<f64, StepError> {
        let errors = explicit_errors(rates);
        // Bodies that rest have velocities of rounding, whose errors are as large as they are
        let farthest = poses.iter().map(|pose| pose.center.amax()).fold(0.0, f64::max);
        let rest = (ROUNDING * farthest / size).max(NEARLY_AT_REST * state.top_speed);
        let (mut error, mut scale) = (0.0f64, rest);
        for (body, of_body) in errors.iter().enumerate() {
            for mode in self.problem.modes().iter() {
                let length = self.path.length_of(body, mode);
                error = error.max(length * of_body[mode].abs());
                scale =
                    rates.iter().map(|rate| length * rate[body][mode].abs()).fold(scale, f64::max);
            }
        }
        let of_velocities = if scale > 0.0 { error / scale } else { 0.0 };
        let gaps = self.path.gaps_at_time(&self.problem.bodies, state.time + size)?;
        let errors: Vec<RigidVector> = errors.into_iter().map(|error| error * size).collect();
        Ok(of_velocities.max(self.gap_error(gaps.as_deref(), state, poses, &errors)))
    }
}

/// Errors of the mean velocities of the bodies in a step, by an embedded formula.
fn explicit_errors(rates: &[Vec<RigidVector>]) -> Vec<RigidVector> {
    let n_bodies = rates.first().map_or(0, Vec::len);
    let of_body = |body: usize| -> RigidVector {
        rates.iter().zip(ERROR).map(|(rate, weight)| rate[body] * weight).sum()
    };
    (0..n_bodies).map(of_body).collect()
}
