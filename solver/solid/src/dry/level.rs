//! `Level`: a structure at an instant.

use nalgebra::DVector;

/// A structure at an instant.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// Coordinates (n).
    pub coordinates: DVector<f64>,
    /// Velocities (n).
    pub velocities: DVector<f64>,
    /// Time (s).
    pub time: f64,
}
