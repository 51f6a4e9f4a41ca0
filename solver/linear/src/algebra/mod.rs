//! Sparse linear algebra: constraints, patterns, and systems solved with factors new or old.

mod cholesky;
mod constraints;
mod direct;
mod krylov;
mod pattern;

pub use crate::multifrontal::Unknowns;
pub use cholesky::{Cholesky, NotPositiveDefinite};
pub use constraints::{AffineConstraints, ConstraintBuilder};
pub use direct::{Accuracy, DirectSolver, LinearError};
pub use pattern::{CellMaps, Pattern};
