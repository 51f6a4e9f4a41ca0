//! `Spline`: closed cubic curve through points, twice continuously differentiable.
//!
//! Between knots s_i (chord length, or given) the curve is the cubic with end values p_i, p_(i+1) and second
//! derivatives m_i, m_(i+1); continuity of the first derivative makes the m_i the solution of a
//! cyclic tridiagonal system.

use crate::Point;

/// A periodic cubic spline; its parameter is the chord length of its points (m), or given.
#[derive(Debug, Clone, PartialEq)]
pub struct Spline {
    knots: Vec<f64>,
    points: Vec<Point<2>>,
    bends: Vec<Point<2>>,
}

impl Spline {
    /// Closed spline through `points` (at least three, no two consecutive ones equal), which are
    /// not repeated at the end; `None` otherwise.
    #[must_use]
    pub fn through(points: &[[f64; 2]]) -> Option<Self> {
        let n = points.len();
        let mut knots = vec![0.0];
        for i in 0..n {
            let ahead = Point::from(points[(i + 1) % n]) - Point::from(points[i]);
            knots.push(knots[i] + ahead.norm());
        }
        Self::with_knots(points, &knots)
    }

    /// Closed spline through `points` at given parameters: those of the points, the first one 0,
    /// and the period; `None` unless they rise and all numbers are finite.
    ///
    /// The points of a body that deforms keep their parameters, so a parameter is a material point.
    /// The curve is linear in its points, so the spline of their velocities is its velocity.
    #[must_use]
    pub fn with_knots(points: &[[f64; 2]], knots: &[f64]) -> Option<Self> {
        let n = points.len();
        let mut points: Vec<Point<2>> = points.iter().map(|p| Point::from(*p)).collect();
        let is_finite = points.iter().all(|p| p.iter().all(|x| x.is_finite()));
        let spacing: Vec<f64> = knots.windows(2).map(|k| k[1] - k[0]).collect();
        let do_rise = spacing.iter().all(|h| *h > 0.0 && h.is_finite());
        if n < 3 || knots.len() != n + 1 || knots[0] != 0.0 || !is_finite || !do_rise {
            return None;
        }
        let mut bends = solve_bends(&points, &spacing);
        points.push(points[0]);
        bends.push(bends[0]);
        Some(Self { knots: knots.to_vec(), points, bends })
    }

    /// Length of the parameter interval (m).
    #[must_use]
    pub fn period(&self) -> f64 {
        self.knots[self.knots.len() - 1]
    }

    /// Parameters of the points, the last one the period.
    #[must_use]
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// Point, first and second derivative at a parameter, which is taken modulo the period.
    #[must_use]
    pub fn evaluate(&self, parameter: f64) -> [Point<2>; 3] {
        let s = parameter.rem_euclid(self.period());
        let i = self.knots.partition_point(|k| *k <= s).clamp(1, self.knots.len() - 1) - 1;
        let h = self.knots[i + 1] - self.knots[i];
        self.evaluate_on(i, (s - self.knots[i]) / h)
    }

    /// The same on one of its pieces, from its start, 0, to its end, 1.
    #[must_use]
    pub fn evaluate_on(&self, i: usize, b: f64) -> [Point<2>; 3] {
        let (h, a) = (self.knots[i + 1] - self.knots[i], 1.0 - b);
        let (p, q, m, n) = (self.points[i], self.points[i + 1], self.bends[i], self.bends[i + 1]);
        [
            p * a + q * b + (m * (a * a * a - a) + n * (b * b * b - b)) * (h * h / 6.0),
            (q - p) / h + (n * (3.0 * b * b - 1.0) - m * (3.0 * a * a - 1.0)) * (h / 6.0),
            m * a + n * b,
        ]
    }
}

/// Second derivatives at the points: h_(i-1) m_(i-1) + 2 (h_(i-1) + h_i) m_i + h_i m_(i+1) = r_i.
///
/// The cyclic corners are a rank-one change of a tridiagonal matrix (Sherman-Morrison).
fn solve_bends(points: &[Point<2>], spacing: &[f64]) -> Vec<Point<2>> {
    let n = points.len();
    let before = |i: usize| (i + n - 1) % n;
    let after = |i: usize| (i + 1) % n;
    let mut diagonal: Vec<f64> = (0..n).map(|i| 2.0 * (spacing[before(i)] + spacing[i])).collect();
    let right: Vec<Point<2>> = (0..n)
        .map(|i| {
            let ahead = (points[after(i)] - points[i]) / spacing[i];
            let behind = (points[i] - points[before(i)]) / spacing[before(i)];
            (ahead - behind) * 6.0
        })
        .collect();
    let corner = spacing[n - 1];
    let shift = -diagonal[0];
    diagonal[0] -= shift;
    diagonal[n - 1] -= corner * corner / shift;
    let mut change = vec![Point::<2>::zeros(); n];
    change[0] = Point::<2>::repeat(shift);
    change[n - 1] += Point::<2>::repeat(corner);
    let mut x = solve_tridiagonal(&diagonal, &spacing[..n - 1], right);
    let z = solve_tridiagonal(&diagonal, &spacing[..n - 1], change);
    let ratio = corner / shift;
    let top = x[0] + x[n - 1] * ratio;
    let bottom = 1.0 + z[0].x + ratio * z[n - 1].x;
    for (m, z) in x.iter_mut().zip(z) {
        *m -= top * (z.x / bottom);
    }
    x
}

/// Thomas algorithm for a symmetric tridiagonal matrix that is diagonally dominant.
fn solve_tridiagonal(diagonal: &[f64], off: &[f64], mut right: Vec<Point<2>>) -> Vec<Point<2>> {
    let n = diagonal.len();
    let mut pivots = diagonal.to_vec();
    for i in 1..n {
        let factor = off[i - 1] / pivots[i - 1];
        pivots[i] -= factor * off[i - 1];
        let above = right[i - 1];
        right[i] -= above * factor;
    }
    right[n - 1] /= pivots[n - 1];
    for i in (0..n - 1).rev() {
        let below = right[i + 1];
        right[i] = (right[i] - below * off[i]) / pivots[i];
    }
    right
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circle(n: usize) -> Vec<[f64; 2]> {
        (0..n)
            .map(|i| std::f64::consts::TAU * i as f64 / n as f64)
            .map(|a| [a.cos(), a.sin()])
            .collect()
    }

    #[test]
    fn the_curve_passes_through_its_points_and_is_smooth_there() {
        let points = [[2.0, 0.0], [0.5, 1.0], [-1.5, 0.3], [-0.2, -0.8], [1.0, -1.1]];
        let spline = Spline::through(&points).unwrap();
        for (i, p) in points.iter().enumerate() {
            let s = spline.knots()[i];
            let [at, ..] = spline.evaluate(s);
            assert!((at - Point::from(*p)).norm() < 1e-14);
            let [_, d0, b0] = spline.evaluate(s - 1e-9);
            let [_, d1, b1] = spline.evaluate(s + 1e-9);
            assert!((d0 - d1).norm() < 1e-7 && (b0 - b1).norm() < 1e-6, "point {i}");
        }
    }

    #[test]
    fn a_circle_is_met_to_fourth_order() {
        let error = |n: usize| {
            let spline = Spline::through(&circle(n)).unwrap();
            (0..1000)
                .map(|i| spline.evaluate(spline.period() * f64::from(i) / 1000.0)[0].norm() - 1.0)
                .fold(0.0, |worst: f64, e| worst.max(e.abs()))
        };
        let order = (error(16) / error(32)).log2();
        assert!((order - 4.0).abs() < 0.1, "order {order}");
    }

    /// The same points at the same parameters move rigidly with the curve; velocities add.
    #[test]
    fn a_spline_with_knots_is_linear_in_its_points() {
        let (points, rates) = (circle(9), [[0.3, -0.1]; 9]);
        let spline = Spline::through(&points).unwrap();
        let again = Spline::with_knots(&points, spline.knots()).unwrap();
        assert_eq!(spline, again);
        let moved: Vec<[f64; 2]> = points.iter().map(|[x, y]| [x + 0.3, y - 0.1]).collect();
        let moved = Spline::with_knots(&moved, spline.knots()).unwrap();
        let rate = Spline::with_knots(&rates, spline.knots()).unwrap();
        for i in 0..50 {
            let s = spline.period() * f64::from(i) / 50.0;
            let off = moved.evaluate(s)[0] - spline.evaluate(s)[0] - rate.evaluate(s)[0];
            assert!(off.norm() < 1e-14);
        }
        assert!(Spline::with_knots(&points, &spline.knots()[1..]).is_none());
        let mut falling = spline.knots().to_vec();
        falling.swap(3, 4);
        assert!(Spline::with_knots(&points, &falling).is_none());
    }

    #[test]
    fn two_points_or_a_repeated_point_make_no_spline() {
        assert!(Spline::through(&[[0.0, 0.0], [1.0, 0.0]]).is_none());
        assert!(Spline::through(&[[0.0, 0.0], [0.0, 0.0], [1.0, 0.0]]).is_none());
    }
}
