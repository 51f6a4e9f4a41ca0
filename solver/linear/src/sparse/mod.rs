//! Sparse matrices: sparsity patterns, values on them, and what each unknown is.

pub(crate) mod index;
pub(crate) mod lists;
mod matrix;
mod pattern;
pub(crate) mod single;
mod unknowns;

pub use matrix::{Residual, Revision, SparseMatrix};
pub use pattern::Pattern;
pub use unknowns::Unknowns;
