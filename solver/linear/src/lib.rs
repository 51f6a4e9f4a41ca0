//! Sparse linear algebra: constraints, sparsity patterns, direct and Krylov solvers.

pub mod algebra;
pub mod multifrontal;
pub mod sparse;
