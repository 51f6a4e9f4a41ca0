//! Multigrid for matrices of small blocks, in single precision: preconditioners, no solvers.
//!
//! A hierarchy starts with a transfer that is given, if there is one, and continues by smoothed aggregation
//! (@vanek1996). Rows come in blocks of B, the components at a node; the last rows may be *pairs*, two
//! rows whose 2 B unknowns are inverted together and are an aggregate of their own on every level: the
//! rigid velocities of a body. Every sum has a fixed order, so that results have the same bits on any
//! number of threads.

mod aggregation;
mod block_diagonal;
mod block_matrix;
mod chebyshev;
mod dense;
mod hierarchy;
mod product;
#[cfg(test)]
mod tests;
mod upwind;

pub(crate) use block_matrix::{Block, BlockMatrix, RowBuilder};
pub(crate) use chebyshev::{Chebyshev, Spectrum};
pub(crate) use hierarchy::{Hierarchy, HierarchySettings, Multigrid};
pub(crate) use upwind::upwinded;
