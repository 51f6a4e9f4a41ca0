//! `Course`: where the bodies of a case without inertia get to, and the work of its swimmers on the way.

use nalgebra::Vector3;

use crate::body::{Pose, RigidVector, Twist, rate_of_displacement};
use crate::case::{BodyQuantity, Column, Component, Source, SwimmerQuantity};
use crate::coupling::{Group, Problem, PropulsionPower, mean_motion};
use crate::state::{CycleMeans, PowerShare, PropulsionHistory, PropulsionStep};
use crate::step::{STAGES, Stage};

/// Where bodies are, and what was done on the way there.
pub(super) struct Course<const D: usize> {
    problem: Problem<D>,
    time: f64,
    poses: Vec<Pose>,
    histories: Vec<PropulsionHistory>,
    step: StepMade,
}

/// What the stages of a step have given so far.
#[derive(Default)]
struct StepMade {
    /// Its size (s).
    size: f64,
    /// Rates of the displacements of the bodies since its beginning, by stage.
    rates: Vec<Vec<RigidVector>>,
    /// Powers of the groups, by stage (W).
    powers: Vec<Vec<f64>>,
}

/// What a flow says of a course: velocities of all bodies, of those that hang on others only what is free, and powers of
/// the groups (W).
#[derive(Debug, Clone)]
pub(super) struct Rates {
    /// Velocities of the bodies.
    pub twists: Vec<Twist>,
    /// Powers of the groups (W).
    pub powers: Vec<f64>,
}

impl<const D: usize> Course<D> {
    /// Begins where a case has its bodies.
    pub fn new(problem: Problem<D>) -> Self {
        let mut poses: Vec<Pose> = problem.bodies.iter().map(|body| body.pose).collect();
        problem.apply_joints(&mut poses, 0.0);
        let histories = vec![PropulsionHistory::default(); problem.groups.len()];
        let mut course = Self { problem, time: 0.0, poses, histories, step: StepMade::default() };
        course.record();
        course
    }

    /// What is given in the case.
    pub fn problem(&self) -> &Problem<D> {
        &self.problem
    }

    /// Time reached (s).
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Poses of the bodies at the time reached.
    pub fn poses(&self) -> &[Pose] {
        &self.poses
    }

    /// Begins a step of a size (s).
    pub fn begin(&mut self, size: f64) {
        self.step = StepMade { size, ..StepMade::default() };
    }

    /// Poses where stages so far lead to, by weights of them, at a part of the step.
    pub fn poses_at(&self, part: f64, weights: &[f64]) -> Vec<Pose> {
        let StepMade { size, rates, .. } = &self.step;
        let pose = |(body, from): (usize, &Pose)| {
            let weighted = rates.iter().zip(weights).map(|(rates, weight)| rates[body] * *weight);
            from.displaced(&(weighted.fold(RigidVector::zeros(), |sum, part| sum + part) * *size))
        };
        let mut poses: Vec<Pose> = self.poses.iter().enumerate().map(pose).collect();
        self.problem.apply_joints(&mut poses, self.time + part * size);
        poses
    }

    /// Adds what a flow says of a stage with bodies at poses.
    pub fn add_stage(&mut self, poses: &[Pose], found: Rates) {
        let rate = |(body, twist): (usize, &Twist)| {
            rate_of_displacement(&poses[body].displacement_from(&self.poses[body]), twist)
        };
        self.step.rates.push(found.twists.iter().enumerate().map(rate).collect());
        self.step.powers.push(found.powers);
    }

    /// Ends the step.
    pub fn end(&mut self) {
        let Stage { weights, .. } = STAGES[STAGES.len() - 1];
        self.poses = self.poses_at(1.0, weights);
        let StepMade { size, powers, .. } = std::mem::take(&mut self.step);
        for (group, history) in self.histories.iter_mut().enumerate() {
            let power =
                |stage: &Vec<f64>| PropulsionPower { power: stage[group], ..Default::default() };
            let stages = powers.iter().zip(weights);
            let shares: Vec<PowerShare> = stages
                .map(|(stage, share)| PowerShare { power: power(stage), share: *share })
                .collect();
            let end = powers.last().map(power).unwrap_or_default();
            history.add_step(size, &PropulsionStep { shares, end, leg: None });
        }
        self.time += size;
        self.record();
    }

    /// Takes the time of the case (s), so that rounding does not pile up.
    pub fn round_time(&mut self, time: f64) {
        self.time = time;
    }

    fn record(&mut self) {
        for (group, history) in self.problem.groups.iter().zip(&mut self.histories) {
            let Some(period) = group.period else { continue };
            let center = center_of(&self.problem, group, &self.poses);
            let orientation = self.poses[group.bodies[0]].orientation;
            history.cycles.push(history.record(self.time, center, orientation), period);
        }
    }

    /// The value of a quantity at the time reached; not a number of one that is of something else.
    pub fn value(&self, column: &Column) -> f64 {
        match column.source {
            Source::Body(body, BodyQuantity::Position) => {
                along(&self.poses[body].center, column.component)
            }
            Source::Body(body, BodyQuantity::Angle) => self.poses[body].angle(),
            Source::Swimmer(swimmer, quantity) => self.of_swimmer(swimmer, quantity, column),
            _ => f64::NAN,
        }
    }

    fn of_swimmer(&self, swimmer: usize, quantity: SwimmerQuantity, column: &Column) -> f64 {
        let group = &self.problem.groups[swimmer];
        let cycles = &self.histories[swimmer].cycles;
        let means = group.period.map(|period| cycles.means(period, group.resistance));
        let of_cycle = |value: &dyn Fn(&CycleMeans) -> f64| means.as_ref().map_or(f64::NAN, value);
        match quantity {
            SwimmerQuantity::Position => {
                along(&center_of(&self.problem, group, &self.poses), column.component)
            }
            SwimmerQuantity::Angle => self.poses[group.bodies[0]].angle(),
            SwimmerQuantity::CycleDisplacement => {
                of_cycle(&|means| along(&means.displacement, column.component))
            }
            SwimmerQuantity::CycleAngle => of_cycle(&|means| means.angle),
            SwimmerQuantity::CycleSpeed => of_cycle(&|means| means.speed),
            SwimmerQuantity::CyclePower => of_cycle(&|means| means.power),
            SwimmerQuantity::CycleCostOfTransport => of_cycle(&|means| means.cost_of_transport),
            SwimmerQuantity::CycleLighthillEfficiency => {
                of_cycle(&|means| means.lighthill_efficiency)
            }
            _ => f64::NAN,
        }
    }
}

/// Centre of mass of a group, or of volume.
fn center_of<const D: usize>(problem: &Problem<D>, group: &Group, poses: &[Pose]) -> Vector3<f64> {
    let at_rest = vec![Twist::default(); poses.len()];
    mean_motion(problem, group, poses, &at_rest).center
}

fn along(vector: &Vector3<f64>, component: Component) -> f64 {
    match component {
        Component::X => vector.x,
        Component::Y => vector.y,
        Component::Z => vector.z,
        Component::Whole | Component::W => f64::NAN,
    }
}
