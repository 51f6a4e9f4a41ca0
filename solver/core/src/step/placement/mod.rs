//! Where bodies get to in a step, and the passes in which that is found.

mod anderson;
mod integrate;
mod placed_bodies;

pub(super) use self::anderson::Passes;
pub(super) use self::placed_bodies::Placement;
