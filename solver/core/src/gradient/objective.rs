//! What quantities are made of: how they follow from the loads and velocities of bodies.

use super::error::GradientError;
use crate::body::{RigidVector, Twist, Wrench};
use crate::case::{Case, Column, Model, TimeSettings, differentiable_columns, nearest};
use crate::coupling::{BodyLoads, LoadWeights};
use crate::run::{BodiesInFlow, steady_value};

/// The columns of these names.
pub(super) fn objectives(model: &Model, names: &[String]) -> Result<Vec<Column>, GradientError> {
    let known = differentiable_columns(model);
    let column = |name: &String| {
        let found = known.iter().find(|column| column.name == *name).cloned();
        found.ok_or_else(|| {
            let names: Vec<&str> = known.iter().map(|column| column.name.as_str()).collect();
            let meant = nearest(name, &names).map(|name| format!("do you mean `{name}`? "));
            GradientError::unknown(
                format!("`{name}` is no quantity whose gradient is known"),
                format!(
                    "{}gradients are those of {}: {}",
                    meant.unwrap_or_default(),
                    match model.case.time {
                        TimeSettings::Steady(_) => "loads, powers and velocities of bodies",
                        TimeSettings::Unsteady(_) => "what a run ends with",
                    },
                    names.join(", ")
                ),
            )
        })
    };
    names.iter().map(column).collect()
}

/// What loads and velocities of all bodies count in a quantity.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Weights {
    /// Of the loads.
    pub loads: Vec<LoadWeights>,
    /// Of the rigid velocities.
    pub twists: Vec<RigidVector>,
    /// The size of what they weigh, all of one sign.
    pub size: f64,
}

/// Part of a load or a velocity by which it is changed: quantities are of second order in them, or nearly.
const STEP: f64 = 1e-5;

impl Weights {
    /// Of a quantity of bodies in a flow; not numbers of one that does not follow from them.
    pub fn of<const D: usize>(case: &Case, column: &Column, bodies: &BodiesInFlow<'_, D>) -> Self {
        let value = |loads: &[BodyLoads], twists: &[Twist]| {
            let changed = BodiesInFlow { loads, twists, ..*bodies };
            steady_value(case, column, &changed).unwrap_or(f64::NAN)
        };
        let sizes = Sizes::of(bodies);
        let n_bodies = bodies.loads.len();
        let mut weights = Self {
            loads: vec![LoadWeights::default(); n_bodies],
            twists: vec![RigidVector::zeros(); n_bodies],
            size: 0.0,
        };
        for body in 0..n_bodies {
            for index in 0..6 {
                let by_load = |change: f64| {
                    let mut loads = bodies.loads.to_vec();
                    let mut vector = loads[body].load.to_vector();
                    vector[index] += change;
                    loads[body].load = Wrench::from_vector(&vector);
                    value(&loads, bodies.twists)
                };
                weights.loads[body].load[index] = slope(by_load, sizes.load);
                let by_velocity = |change: f64| {
                    let mut twists = bodies.twists.to_vec();
                    let mut vector = twists[body].to_vector();
                    vector[index] += change;
                    twists[body] = Twist::from_vector(&vector);
                    value(bodies.loads, &twists)
                };
                weights.twists[body][index] = slope(by_velocity, sizes.velocity);
            }
            let by_power = |change: f64| {
                let mut loads = bodies.loads.to_vec();
                loads[body].power += change;
                value(&loads, bodies.twists)
            };
            weights.loads[body].power = slope(by_power, sizes.power);
            let LoadWeights { load, power } = &weights.loads[body];
            weights.size += load.abs().sum() * sizes.load
                + power.abs() * sizes.power
                + weights.twists[body].abs().sum() * sizes.velocity;
        }
        weights
    }
}

fn slope(value: impl Fn(f64) -> f64, size: f64) -> f64 {
    let step = STEP * size;
    (value(step) - value(-step)) / (2.0 * step)
}

/// How large loads and velocities are; 1 where there are none.
struct Sizes {
    load: f64,
    power: f64,
    velocity: f64,
}

impl Sizes {
    fn of<const D: usize>(bodies: &BodiesInFlow<'_, D>) -> Self {
        let size = |values: &mut dyn Iterator<Item = f64>| {
            let largest = values.fold(0.0, |most: f64, value| most.max(value.abs()));
            if largest > 0.0 { largest } else { 1.0 }
        };
        Self {
            load: size(&mut bodies.loads.iter().map(|body| body.load.to_vector().amax())),
            power: size(&mut bodies.loads.iter().map(|body| body.power)),
            velocity: size(&mut bodies.twists.iter().map(|twist| twist.to_vector().amax())),
        }
    }
}
