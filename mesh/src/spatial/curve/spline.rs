//! `SpaceSpline`: a natural cubic spline through points in space.

use crate::Point;

/// Pieces of a full turn in which the curve is nearly straight.
const PIECES_OF_TURN: f64 = 32.0;
/// Pieces between two points at least.
const LEAST_PIECES: f64 = 4.0;
/// Most pieces.
const MOST_PIECES: f64 = 4096.0;

/// A point of a curve with derivatives by the parameter.
#[derive(Debug, Clone, Copy)]
pub(in crate::spatial) struct CurvePoint {
    pub at: Point<3>,
    pub rate: Point<3>,
    pub second: Point<3>,
}

/// A natural cubic spline, by a parameter that grows from 0 to 1 with the lengths of the chords.
#[derive(Debug, Clone, PartialEq)]
pub struct SpaceSpline {
    points: Vec<Point<3>>,
    /// Parameters of the points.
    knots: Vec<f64>,
    /// Second derivatives at the points.
    bends: Vec<Point<3>>,
    n_pieces: f64,
}

impl SpaceSpline {
    /// Through points (m); `None` unless there are two or more, finite and each apart from the next.
    #[must_use]
    pub fn new(points: Vec<Point<3>>) -> Option<Self> {
        let chords: Vec<f64> = points.windows(2).map(|pair| (pair[1] - pair[0]).norm()).collect();
        let length: f64 = chords.iter().sum();
        let is_curve = !chords.is_empty() && chords.iter().all(|chord| *chord > 1e-12 * length);
        if !(is_curve && length.is_finite()) {
            return None;
        }
        let mut knots = vec![0.0];
        for chord in &chords {
            knots.push(knots[knots.len() - 1] + chord / length);
        }
        let n = points.len();
        knots[n - 1] = 1.0;
        let mut bends = vec![Point::<3>::zeros(); n];
        let mut factors = vec![0.0; n];
        // Thomas algorithm for the second derivatives, zero at both ends
        for i in 1..n - 1 {
            let (before, after) = (knots[i] - knots[i - 1], knots[i + 1] - knots[i]);
            let slopes =
                [(points[i] - points[i - 1]) / before, (points[i + 1] - points[i]) / after];
            let pivot = 2.0 * (before + after) - before * factors[i - 1];
            factors[i] = after / pivot;
            bends[i] = ((slopes[1] - slopes[0]) * 6.0 - bends[i - 1] * before) / pivot;
        }
        for i in (1..n - 1).rev() {
            let next = bends[i + 1];
            bends[i] -= next * factors[i];
        }
        let mut spline = Self { points, knots, bends, n_pieces: MOST_PIECES };
        spline.n_pieces = spline.enough_pieces();
        Some(spline)
    }

    /// Pieces that are nearly straight, by how far its direction turns.
    fn enough_pieces(&self) -> f64 {
        let n = 16 * (self.points.len() - 1);
        let direction = |i: usize| self.evaluate(i as f64 / n as f64).rate.normalize();
        let turned: f64 = (0..n).map(|i| direction(i).angle(&direction(i + 1))).sum();
        let shortest = self.knots.windows(2).map(|pair| pair[1] - pair[0]).fold(1.0, f64::min);
        let turns = turned / std::f64::consts::TAU;
        (PIECES_OF_TURN * turns).max(LEAST_PIECES / shortest).min(MOST_PIECES)
    }

    /// The point at a parameter from 0 to 1.
    pub(in crate::spatial) fn evaluate(&self, parameter: f64) -> CurvePoint {
        let last = self.points.len() - 2;
        let i = self.knots.partition_point(|knot| *knot <= parameter).saturating_sub(1).min(last);
        let h = self.knots[i + 1] - self.knots[i];
        let b = (parameter - self.knots[i]) / h;
        let a = 1.0 - b;
        let (p, q) = (self.points[i], self.points[i + 1]);
        let (m, n) = (self.bends[i], self.bends[i + 1]);
        CurvePoint {
            at: p * a + q * b + (m * (a * a * a - a) + n * (b * b * b - b)) * (h * h / 6.0),
            rate: (q - p) / h + (n * (3.0 * b * b - 1.0) - m * (3.0 * a * a - 1.0)) * (h / 6.0),
            second: m * a + n * b,
        }
    }

    /// Pieces into which it is cut so that each is nearly straight.
    pub(in crate::spatial) fn pieces(&self) -> f64 {
        self.n_pieces
    }

    /// Length from end to end (m), to a few parts in a thousand.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.samples().windows(2).map(|pair| (pair[1].at - pair[0].at).norm()).sum()
    }

    /// Largest distance from the origin (m).
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.samples().iter().map(|on| on.at.norm()).fold(0.0, f64::max)
    }

    /// Largest radius of a tube around it that does not meet itself (m), to the pieces it is cut into: the
    /// least radius of curvature, and half the least distance of places between which the curve goes
    /// away and comes back.
    pub(in crate::spatial) fn widest_tube(&self) -> f64 {
        let samples = self.samples();
        let of_curvature = samples.iter().map(|on| {
            let speed = on.rate.norm();
            speed.powi(3) / on.rate.cross(&on.second).norm()
        });
        let mut widest = of_curvature.fold(f64::INFINITY, f64::min);
        for (i, on) in samples.iter().enumerate() {
            let apart = |j: usize| (samples[j].at - on.at).norm();
            let mut last = 0.0;
            let mut goes_away = true;
            for j in i + 1..samples.len() {
                let now = apart(j);
                goes_away &= now >= last;
                if !goes_away {
                    widest = widest.min(0.5 * now);
                }
                last = now;
            }
        }
        widest
    }

    fn samples(&self) -> Vec<CurvePoint> {
        let n = crate::whole(self.n_pieces.ceil());
        (0..=n).map(|i| self.evaluate(i as f64 / n as f64)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn its_derivatives_are_those_of_its_points() {
        let points = [[0.0, 0.0, 0.0], [1.0, 0.5, 0.1], [1.5, -0.4, 0.9], [3.0, 0.2, 0.3]];
        let spline = SpaceSpline::new(points.map(Point::<3>::from).to_vec()).unwrap();
        let h = 1e-5;
        for i in 1..40 {
            let t = f64::from(i) / 40.0;
            let [before, on, after] = [t - h, t, t + h].map(|t| spline.evaluate(t));
            assert!(((after.at - before.at) / (2.0 * h) - on.rate).norm() < 1e-6 * on.rate.norm());
            let second = (after.rate - before.rate) / (2.0 * h);
            assert!((second - on.second).norm() < 1e-3 * (1.0 + on.second.norm()), "{t}");
        }
        for (knot, point) in spline.knots.iter().zip(points) {
            assert!((spline.evaluate(*knot).at - Point::<3>::from(point)).norm() < 1e-14);
        }
        assert_eq!((spline.bends[0].norm(), spline.bends[3].norm()), (0.0, 0.0));
    }

    #[test]
    fn tubes_that_meet_themselves_are_too_wide() {
        let spline = |points: &[[f64; 3]]| {
            SpaceSpline::new(points.iter().map(|point| Point::<3>::from(*point)).collect())
        };
        let straight = spline(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]).unwrap();
        assert!(straight.widest_tube() > 1e6);
        // A hairpin, whose arms are 0.4 apart
        let arms =
            [[0.0, 0.2, 0.0], [2.0, 0.2, 0.0], [4.0, 0.2, 0.0], [4.5, 0.0, 0.0], [4.0, -0.2, 0.0]];
        let back = [[2.0, -0.2, 0.0], [0.0, -0.2, 0.0]];
        let hairpin = spline(&[arms.as_slice(), back.as_slice()].concat()).unwrap();
        assert!(hairpin.widest_tube() < 0.21, "{}", hairpin.widest_tube());
        assert!(spline(&[[0.0; 3]]).is_none() && spline(&[[0.0; 3], [0.0; 3]]).is_none());
        assert!(spline(&[[0.0; 3], [f64::NAN, 0.0, 0.0]]).is_none());
    }
}
