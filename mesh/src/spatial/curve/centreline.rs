//! `Centreline`: the curve in the middle of a tube.

use std::f64::consts::TAU;

use super::spline::{CurvePoint, SpaceSpline};
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

impl Centreline {
    /// The point of the curve (m) at a parameter.
    #[must_use]
    pub fn at(&self, parameter: f64) -> Point<3> {
        self.evaluate(parameter).at
    }

    pub(in crate::spatial) fn evaluate(&self, parameter: f64) -> CurvePoint {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn through(centreline: &Centreline, n: usize) -> SpaceSpline {
        let points = (0..=n).map(|i| centreline.at(i as f64 / n as f64)).collect();
        SpaceSpline::new(points).unwrap()
    }

    #[test]
    fn through_points_of_a_helix_it_is_the_helix() {
        let helix = Centreline::Helix { radius: 0.4, pitch: 0.9, turns: 1.3 };
        let mut errors = Vec::new();
        for n in [24, 48] {
            let spline = through(&helix, n);
            // Away from the ends, where the helix has a curvature and the spline none
            let at = |i: usize| 0.3 + 0.4 * i as f64 / 100.0;
            let error = |i: usize| (spline.evaluate(at(i)).at - helix.at(at(i))).norm();
            errors.push((0..=100).map(error).fold(0.0, f64::max));
        }
        assert!(errors[0] < 1e-3 && errors[0] / errors[1] > 12.0, "{errors:?}");
        let spline = through(&helix, 100);
        let length = 1.3 * 0.9f64.hypot(std::f64::consts::TAU * 0.4);
        assert!((spline.length() / length - 1.0).abs() < 5e-3, "{}", spline.length());
        // Next to the ends the spline bends more, as it does not at them
        let ratio = spline.widest_tube() / helix.widest_tube();
        assert!((0.7..1.01).contains(&ratio), "{ratio}");
    }
}
