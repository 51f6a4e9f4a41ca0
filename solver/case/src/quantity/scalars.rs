//! On which surfaces scalars are measured.

use crate::{BoundaryCondition, Model};

/// A surface through which a scalar comes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ScalarSurface {
    /// Of a body, by its number in [`Model::bodies`].
    Body(usize),
    /// A side, by its number in [`Case::sides`](crate::Case::sides).
    Side(usize),
}

/// Whether something may come through a side, which is neither the axis, nor periodic, nor of a body.
pub fn is_crossed(model: &Model, side: &str) -> bool {
    let conditions = &model.case.boundary;
    let is_joined = conditions.iter().any(|(name, condition)| match condition {
        BoundaryCondition::Periodic(partner) => name == side || partner == side,
        BoundaryCondition::Axis => name == side,
        _ => false,
    });
    !is_joined && side != "axis" && model.body_index(side).is_none()
}
