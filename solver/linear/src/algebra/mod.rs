//! Linear systems: constraints, cell matrices, and solvers that keep their factors.

mod cell_maps;
mod cell_pattern;
mod cell_unknowns;
mod cholesky;
mod constraints;
mod direct;
mod elliptic;
mod fingerprint;
mod krylov;
mod memory;
mod reuse;
mod saddle_point;
mod solver;
mod vectors;

pub use crate::multifrontal::Singular;
pub use crate::sparse::{Pattern, SparseMatrix, Unknowns};
pub use cell_maps::CellMaps;
pub use cell_unknowns::{CellFolds, CellUnknowns};
pub use cholesky::CholeskyError;
pub use constraints::{AffineConstraints, ConstraintBuilder, Term};
pub use direct::DirectSolver;
pub use elliptic::{EllipticError, EllipticSolver, NodalComponent};
pub use memory::{ForeignMemory, SolverMemory};
pub use saddle_point::{
    Interpolation, IterativeSettings, IterativeSolver, Part, SaddleMatrix, SaddlePoint, Weights,
};
pub use solver::{Accuracy, LinearError, LinearSolver};
