//! Parts of a solid that move as rigid bodies: their unknowns, and what a state makes of them.

pub(super) mod pose;
pub(super) mod ties;
pub(super) mod unknowns;
