//! `Foot`: the point of a curve nearest to another point, in the frame of the body.

use crate::Point;

/// Foot of the perpendicular from a point to an outline.
#[derive(Debug, Clone, Copy)]
pub struct Foot {
    /// Where on the curve (m).
    pub point: Point<2>,
    /// Unit normal there, out of the body.
    pub normal: Point<2>,
    /// Curvature there (1/m).
    pub curvature: f64,
}
