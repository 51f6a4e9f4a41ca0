//! Which columns gradients are known of: those of loads, powers and velocities of bodies.

use super::{Column, columns};
use crate::Model;

/// Names, after that of their owner, of the quantities that follow from loads and velocities of bodies.
const NAMES: [&str; 11] = [
    "velocity",
    "angular_velocity",
    "force",
    "torque",
    "power",
    "shape_power",
    "lighthill_efficiency",
    "drag_coefficient",
    "lift_coefficient",
    "side_coefficient",
    "moment_coefficient",
];

/// The columns of a case whose gradients are known.
#[must_use]
pub fn differentiable_columns(model: &Model) -> Vec<Column> {
    let bodies_and_swimmers = model.bodies.iter().map(|body| &body.name);
    let owners: Vec<&String> =
        bodies_and_swimmers.chain(model.swimmers.iter().map(|swimmer| &swimmer.name)).collect();
    let is_differentiable = |column: &Column| {
        let of = |owner: &&&String| column.name.strip_prefix(owner.as_str())?.strip_prefix('.');
        owners.iter().filter_map(|owner| of(&owner)).any(|name| {
            let whole = name.strip_suffix(['x', 'y', 'z']);
            let whole = whole.and_then(|name| name.strip_suffix('.')).unwrap_or(name);
            NAMES.contains(&whole)
        })
    };
    columns(model).into_iter().filter(is_differentiable).collect()
}
