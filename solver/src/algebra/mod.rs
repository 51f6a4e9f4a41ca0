//! Sparse linear algebra; faer lives here only.

mod constraints;
mod direct;
mod pattern;

pub use constraints::{AffineConstraints, ConstraintBuilder};
pub use direct::{DirectSolver, SingularMatrix};
pub use pattern::{CellMaps, Pattern};
