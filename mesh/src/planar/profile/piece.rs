//! `Piece`: a smooth piece of a profile, straight or an arc of an ellipse.

use std::f64::consts::PI;

use crate::Point;

/// A smooth piece of a profile, with a parameter in [0, 1]; s grows along it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Piece {
    Line {
        from: Point<2>,
        to: Point<2>,
    },
    /// Arc of an ellipse with axes along s and w.
    Arc {
        center: Point<2>,
        semi_axes: [f64; 2],
        /// Eccentric angles of its ends (rad).
        angles: [f64; 2],
    },
}

impl Piece {
    /// Point (m) and its derivative at a parameter in [0, 1].
    pub fn at(&self, parameter: f64) -> [Point<2>; 2] {
        match *self {
            Self::Line { from, to } => [from + (to - from) * parameter, to - from],
            Self::Arc { center, semi_axes: [a, b], angles: [first, last] } => {
                let turn = last - first;
                let (sin, cos) = (first + turn * parameter).sin_cos();
                [
                    center + Point::<2>::new(a * cos, b * sin),
                    Point::<2>::new(-a * sin, b * cos) * turn,
                ]
            }
        }
    }

    /// Curvature, positive where the body is convex (1/m).
    pub fn curvature(&self, parameter: f64) -> f64 {
        match *self {
            Self::Line { .. } => 0.0,
            Self::Arc { semi_axes: [a, b], angles: [first, last], .. } => {
                let speed = self.at(parameter)[1].norm() / (last - first).abs();
                a * b / speed.powi(3) * (first - last).signum()
            }
        }
    }

    /// An arc of a circle from one place of it to another, the short way round.
    pub fn circle(center: Point<2>, radius: f64, from: Point<2>, to: Point<2>) -> Self {
        let angle = |place: Point<2>| (place.y - center.y).atan2(place.x - center.x);
        let first = angle(from);
        let turn = (angle(to) - first + PI).rem_euclid(2.0 * PI) - PI;
        Self::Arc { center, semi_axes: [radius; 2], angles: [first, first + turn] }
    }
}
