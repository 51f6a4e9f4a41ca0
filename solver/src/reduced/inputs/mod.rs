//! What a tree is told and pushed by in time.

mod lines;
pub(in crate::reduced) mod pushes;
pub(in crate::reduced) mod told;
