//! `Centreline`: the curve in the middle of a tube.

use std::f64::consts::TAU;

use super::spline::SpaceSpline;
use crate::Point;

/// A curve in the frame of a body, by a parameter from 0 to 1.
#[derive(Debug, Clone, PartialEq)]
pub enum Centreline {
    /// A helix about the x axis from x = 0, its start in the half plane y > 0.
    Helix {
        /// Distance from the axis (m).
        radius: f64,
        /// Length along the axis of one turn (m).
        pitch: f64,
        /// Number of turns; right-handed if positive, left-handed if negative.
        turns: f64,
    },
    /// A smooth curve through points.
    Spline(SpaceSpline),
}

/// A point of a curve with derivatives by the parameter.
#[derive(Debug, Clone, Copy)]
pub(super) struct CurvePoint {
    pub at: Point<3>,
    pub rate: Point<3>,
    pub second: Point<3>,
}

impl Centreline {
    /// The point of the curve (m) at a parameter.
    #[must_use]
    pub fn at(&self, parameter: f64) -> Point<3> {
        self.evaluate(parameter).at
    }

    pub(super) fn evaluate(&self, parameter: f64) -> CurvePoint {
        match *self {
            Self::Spline(ref spline) => spline.evaluate(parameter),
            Self::Helix { radius, pitch, turns } => {
                let angle = TAU * turns;
                let (sin, cos) = (angle * parameter).sin_cos();
                let length = pitch * turns.abs();
                CurvePoint {
                    at: Point::<3>::new(length * parameter, radius * cos, radius * sin),
                    rate: Point::<3>::new(length, -radius * angle * sin, radius * angle * cos),
                    second: Point::<3>::new(0.0, -radius * cos, -radius * sin) * angle * angle,
                }
            }
        }
    }

    /// Pieces into which it is cut so that each is nearly straight.
    #[must_use]
    pub fn pieces(&self) -> f64 {
        match self {
            Self::Spline(spline) => spline.pieces(),
            Self::Helix { turns, .. } => 32.0 * turns.abs(),
        }
    }

    /// Largest radius of a tube around it that does not meet itself (m).
    #[must_use]
    pub fn widest_tube(&self) -> f64 {
        match *self {
            Self::Spline(ref spline) => spline.widest_tube(),
            Self::Helix { radius, pitch, turns } => {
                let advance = pitch / TAU;
                let of_curvature = (radius * radius + advance * advance) / radius;
                // Neighbouring turns are nearest across their direction
                let apart = pitch * radius / radius.hypot(advance);
                if turns.abs() > 0.5 { of_curvature.min(0.5 * apart) } else { of_curvature }
            }
        }
    }
}
