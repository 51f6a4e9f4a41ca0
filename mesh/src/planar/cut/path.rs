//! `Path`: a line through points of the fluid, with its radius of curvature.

use super::clearance::Clearance;
use crate::Point;
use crate::planar::vector::cross;

/// A line through points, with the length along it as its parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    pub points: Vec<Point<2>>,
    /// Length up to each point (m).
    lengths: Vec<f64>,
    /// Radius of curvature at each point (m).
    radii: Vec<f64>,
}

/// A point of a path.
#[derive(Debug, Clone, Copy)]
pub struct PathPoint {
    /// Where (m).
    pub point: Point<2>,
    /// Unit tangent.
    pub direction: Point<2>,
    /// Radius of curvature (m).
    pub radius: f64,
}

impl Path {
    pub fn new(points: Vec<Point<2>>, clearance: &Clearance<'_>) -> Self {
        let n = points.len();
        let mut bends = vec![0.0; n];
        for i in 1..n - 1 {
            let (one, other) = (points[i] - points[i - 1], points[i + 1] - points[i]);
            let turn = cross(one, other).atan2(one.dot(&other));
            bends[i] = 2.0 * turn / (one.norm() + other.norm());
        }
        // What is a corner from point to point is a bend of the line they stand for
        for _ in 0..2 {
            let before = bends.clone();
            for i in 1..n - 1 {
                bends[i] = 0.25 * before[i - 1] + 0.5 * before[i] + 0.25 * before[i + 1];
            }
        }
        let radius =
            |(point, bend): (&Point<2>, &f64)| bend.abs().recip().max(clearance.at(*point));
        let radii = points.iter().zip(&bends).map(radius).collect();
        Self::with_radii(points, radii)
    }

    fn with_radii(points: Vec<Point<2>>, radii: Vec<f64>) -> Self {
        let mut lengths = vec![0.0];
        let mut length = 0.0;
        for pair in points.windows(2) {
            length += (pair[1] - pair[0]).norm();
            lengths.push(length);
        }
        Self { points, lengths, radii }
    }

    /// Its length (m).
    pub fn length(&self) -> f64 {
        self.lengths[self.lengths.len() - 1]
    }

    /// The point at a part of its length.
    pub fn at(&self, part: f64) -> PathPoint {
        let wanted = part * self.length();
        let next = self.lengths.partition_point(|length| *length <= wanted);
        let next = next.clamp(1, self.points.len() - 1);
        let (from, to) = (self.points[next - 1], self.points[next]);
        let step = self.lengths[next] - self.lengths[next - 1];
        let direction = (to - from) / step;
        let radius = self.radii[next - 1].min(self.radii[next]);
        let point = if part >= 1.0 {
            self.points[self.points.len() - 1]
        } else {
            from + (to - from) * ((wanted - self.lengths[next - 1]) / step)
        };
        PathPoint { point, direction, radius }
    }

    pub fn moved(&self, shift: Point<2>) -> Self {
        let points = self.points.iter().map(|x| x + shift).collect();
        Self { points, ..self.clone() }
    }

    pub fn reversed(&self) -> Self {
        let backwards = |values: &[f64]| values.iter().rev().copied().collect();
        let points = self.points.iter().rev().copied().collect();
        Self::with_radii(points, backwards(&self.radii))
    }
}
