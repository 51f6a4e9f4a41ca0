//! `polygon` and `box`: planar shapes with straight sides and sharp corners.

use serde::{Deserialize, Serialize};

/// `polygon`: straight sides between corners, which stay sharp.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct PolygonShape {
    /// Corners in the body frame (m), one after the other either way round, the first not repeated.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(test, schemars(length(min = 3)))]
    pub points: Vec<[f64; 2]>,
    /// Path of a file with the corners in the place of `points`: two numbers a line, relative to the file in
    /// which it is written.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
}

impl PolygonShape {
    /// Its corners counter-clockwise (m).
    #[must_use]
    pub fn corners(&self) -> Vec<[f64; 2]> {
        let mut corners = self.points.clone();
        if signed_area(&corners) < 0.0 {
            corners.reverse();
        }
        corners
    }
}

/// Area of a polygon (m2), positive if its corners run counter-clockwise.
pub(crate) fn signed_area(points: &[[f64; 2]]) -> f64 {
    let n = points.len();
    let twice: f64 = (0..n)
        .map(|i| {
            let ([ax, ay], [bx, by]) = (points[i], points[(i + 1) % n]);
            ax * by - bx * ay
        })
        .sum();
    0.5 * twice
}

/// Corners of a rectangle about the origin, and the middles of its sides, where it is cut by its axes (m).
pub(crate) fn box_corners([width, height]: [f64; 2]) -> Vec<[f64; 2]> {
    let (a, b) = (0.5 * width, 0.5 * height);
    vec![[a, 0.0], [a, b], [0.0, b], [-a, b], [-a, 0.0], [-a, -b], [0.0, -b], [a, -b]]
}
