//! The quantities of swimmers: their mean motion, power, thrust, and averages over their cycles.

use super::value::Value;
use crate::body::Wrench;
use crate::case::SwimmerQuantity;
use crate::coupling::{
    BodyLoads, Group, MeanMotion, Problem, PropulsionPower, group_load, mean_motion,
};
use crate::state::CycleMeans;
use crate::state::PropulsionHistory;
use crate::state::State;

/// A swimmer at one time.
pub(super) struct SwimmerMeasurement {
    motion: MeanMotion,
    /// Angle of the first body over all turns (rad).
    angle: f64,
    load: Wrench,
    power: PropulsionPower,
    /// Averages over the last cycle; `None` of a swimmer without a period.
    means: Option<CycleMeans>,
    resistance: Option<f64>,
    /// Smallest gap between two of its bodies that are not on one pivot (m); `None` where the mesh
    /// rests or there are no such two.
    minimum_gap: Option<f64>,
}

impl SwimmerMeasurement {
    pub(super) fn new<const D: usize>(
        problem: &Problem<D>,
        state: &State<D>,
        group: &Group,
        history: &PropulsionHistory,
        loads: &[BodyLoads],
    ) -> Self {
        let motion = mean_motion(problem, group, &state.poses, &state.now.twists);
        Self {
            angle: state.poses[group.bodies[0]].angle(),
            load: group_load(group, &motion.center, &state.poses, loads),
            power: history.power(),
            means: group.period.map(|period| history.cycles.means(period, group.resistance)),
            resistance: group.resistance,
            minimum_gap: None,
            motion,
        }
    }

    /// The same with the smallest gap between its bodies.
    pub(super) fn with_minimum_gap(self, minimum_gap: Option<f64>) -> Self {
        Self { minimum_gap, ..self }
    }

    pub(super) fn value(&self, quantity: SwimmerQuantity) -> Value {
        let MeanMotion { center, twist } = &self.motion;
        let PropulsionPower { power, shape_power, expended_power, thrust, drag, .. } = self.power;
        let of_cycle = |value: fn(&CycleMeans) -> f64| {
            Value::Scalar(self.means.as_ref().map_or(f64::NAN, value))
        };
        match quantity {
            SwimmerQuantity::Position => (*center).into(),
            SwimmerQuantity::Angle => self.angle.into(),
            SwimmerQuantity::Velocity => twist.linear.into(),
            SwimmerQuantity::AngularVelocity => twist.angular.into(),
            SwimmerQuantity::Force => self.load.force.into(),
            SwimmerQuantity::Torque => self.load.torque.into(),
            SwimmerQuantity::Power => power.into(),
            SwimmerQuantity::ShapePower => shape_power.into(),
            SwimmerQuantity::ExpendedPower => expended_power.into(),
            SwimmerQuantity::Thrust => thrust.into(),
            SwimmerQuantity::Drag => drag.into(),
            SwimmerQuantity::CycleDisplacement => {
                Value::of(self.means.as_ref().map(|means| means.displacement))
            }
            SwimmerQuantity::CycleAngle => of_cycle(|means| means.angle),
            SwimmerQuantity::CycleSpeed => of_cycle(|means| means.speed),
            SwimmerQuantity::CyclePower => of_cycle(|means| means.power),
            SwimmerQuantity::CycleCostOfTransport => of_cycle(|means| means.cost_of_transport),
            SwimmerQuantity::CycleEfficiency => of_cycle(|means| means.efficiency),
            SwimmerQuantity::CycleDrift => of_cycle(|means| means.drift),
            SwimmerQuantity::CycleLighthillEfficiency => {
                of_cycle(|means| means.lighthill_efficiency)
            }
            SwimmerQuantity::MinimumGap => self.minimum_gap.unwrap_or(f64::NAN).into(),
            SwimmerQuantity::LighthillEfficiency => self
                .resistance
                .map_or(f64::NAN, |force| force * twist.linear.norm_squared() / power)
                .into(),
        }
    }
}
