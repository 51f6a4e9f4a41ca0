//! Linear systems: constraints, cell matrices, and solvers that keep their factors.

mod cell_maps;
mod cell_pattern;
mod cholesky;
mod constraints;
mod direct;
mod fingerprint;
mod krylov;
mod reuse;
mod saddle_point;
mod solver;

pub use crate::multifrontal::Singular;
pub use crate::sparse::{Pattern, SparseMatrix, Unknowns};
pub use cell_maps::CellMaps;
pub use cholesky::{Cholesky, CholeskyError};
pub use constraints::{AffineConstraints, ConstraintBuilder, Term};
pub use direct::DirectSolver;
pub use saddle_point::{
    Interpolation, IterativeSettings, IterativeSolver, Part, SaddlePoint, Weights,
};
pub use solver::{Accuracy, LinearError, LinearSolver};
