//! `Placement`: where bodies are, poses and coordinates, with the shapes they have there.

use crate::body::Pose;
use crate::coupling::BodyShapes;

/// Where bodies are at the new time.
#[derive(Debug, Clone)]
pub struct Placement {
    /// Poses, in the laboratory.
    pub poses: Vec<Pose>,
    /// Coordinates of all bodies that have some.
    pub coordinates: Vec<f64>,
    /// The shapes of the bodies.
    pub shapes: BodyShapes,
}
