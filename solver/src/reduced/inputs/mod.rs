//! What a tree is told and pushed by in time.

pub(in crate::reduced) mod pushes;
pub(in crate::reduced) mod told;
