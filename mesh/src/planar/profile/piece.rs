//! `Piece`: a smooth piece of a profile: straight, an arc of an ellipse, or a bridge between two widths.

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
    /// From one width to another, without slope and curvature at both ends.
    Bridge {
        from: Point<2>,
        to: Point<2>,
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
            Self::Bridge { from, to } => {
                let p = parameter;
                let step = p * p * p * (10.0 + p * (6.0 * p - 15.0));
                let rate = 30.0 * p * p * (1.0 - p) * (1.0 - p);
                let way = to - from;
                [
                    from + Point::<2>::new(way.x * p, way.y * step),
                    Point::<2>::new(way.x, way.y * rate),
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
            Self::Bridge { from, to } => {
                let (p, way) = (parameter, to - from);
                let bend = 60.0 * p * (1.0 - p) * (1.0 - 2.0 * p) * way.y;
                -bend * way.x / self.at(p)[1].norm().powi(3)
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
