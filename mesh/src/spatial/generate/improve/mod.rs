//! `Improver`: a mesh made better by local changes, with all it takes: collapses, splits, swaps, moves.

mod collapse;
mod edge_removal;
mod face_swap;
mod given_nodes;
mod improver;
mod passes;
mod peel;
mod projections;
mod replace;
mod schedule;
mod smooth;
mod split;
mod verdict;
mod worst_cells;

pub use given_nodes::GivenPart;
pub use improver::Improver;
pub use split::Split;
pub use verdict::{LEAST_COEFFICIENT, Verdict};
