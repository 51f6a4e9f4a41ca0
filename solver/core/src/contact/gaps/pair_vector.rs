//! Vectors and matrices over the rigid motions of two bodies.

use nalgebra::{SMatrix, SVector};

/// The six components of a body's rigid motion, then those of its partner.
pub type PairVector = SVector<f64, 12>;

/// A matrix over the components of a [`PairVector`].
pub type PairMatrix = SMatrix<f64, 12, 12>;
