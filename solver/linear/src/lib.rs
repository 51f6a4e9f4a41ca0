//! Sparse linear algebra: constraints, sparsity patterns, direct and Krylov solvers.

pub mod algebra;
pub mod multifrontal;
mod multigrid;
pub mod sparse;
