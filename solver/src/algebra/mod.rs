//! Sparse linear algebra; faer lives here only.

mod cholesky;
mod constraints;
mod direct;
mod pattern;

pub use cholesky::Cholesky;
pub use constraints::{AffineConstraints, ConstraintBuilder};
pub use direct::{DirectSolver, SingularMatrix};
pub use pattern::{CellMaps, Pattern};
