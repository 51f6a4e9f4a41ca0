//! Sparse linear algebra: constraints, sparsity patterns, direct and Krylov solvers.

#![warn(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_possible_wrap)]

pub mod algebra;
pub mod multifrontal;
pub mod sparse;
