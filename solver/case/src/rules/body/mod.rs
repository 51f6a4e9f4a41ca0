//! Problems of bodies, of what they are joined by and of how they move.

pub(super) mod bodies;
mod gait;
pub(super) mod joints;
mod joints_in_space;
mod midline;
pub(super) mod motion;
mod polygon;
pub(crate) mod rod;
mod skin;
mod slip;
mod solid;
mod spring;
pub(super) mod strokes;
mod surface;
pub(super) mod swimmers;
