//! Linear systems: constraints, cell matrices, and solvers that keep their factors.

mod cell_maps;
mod cholesky;
mod constraints;
mod direct;
mod krylov;
mod reuse;
mod solver;

pub use crate::multifrontal::Singular;
pub use crate::sparse::{Pattern, SparseMatrix, Unknowns};
pub use cell_maps::CellMaps;
pub use cholesky::{Cholesky, CholeskyError};
pub use constraints::{AffineConstraints, ConstraintBuilder, Term};
pub use direct::DirectSolver;
pub use solver::{Accuracy, LinearError, LinearSolver};
