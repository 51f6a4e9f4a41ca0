//! `NaturalSpline`: a natural cubic spline through points of a plane, for curvatures along a midline.

/// Natural cubic spline through points of a plane, constant slope outside.
pub struct NaturalSpline<'a> {
    points: &'a [[f64; 2]],
    bends: Vec<f64>,
}

impl<'a> NaturalSpline<'a> {
    /// Through two points or more, their abscissae ascending.
    pub fn new(points: &'a [[f64; 2]]) -> Self {
        let n = points.len();
        let mut bends = vec![0.0; n];
        let mut factors = vec![0.0; n];
        // Thomas algorithm for the second derivatives, zero at both ends
        for i in 1..n.saturating_sub(1) {
            let ([x0, y0], [x1, y1], [x2, y2]) = (points[i - 1], points[i], points[i + 1]);
            let (before, after) = (x1 - x0, x2 - x1);
            let right = 6.0 * ((y2 - y1) / after - (y1 - y0) / before);
            let pivot = 2.0 * (before + after) - before * factors[i - 1];
            factors[i] = after / pivot;
            bends[i] = (right - before * bends[i - 1]) / pivot;
        }
        for i in (1..n.saturating_sub(1)).rev() {
            bends[i] -= factors[i] * bends[i + 1];
        }
        Self { points, bends }
    }

    /// Its value at an abscissa.
    pub fn at(&self, x: f64) -> f64 {
        let i = self.points.partition_point(|p| p[0] <= x).clamp(1, self.points.len() - 1) - 1;
        let ([x0, y0], [x1, y1]) = (self.points[i], self.points[i + 1]);
        let h = x1 - x0;
        let (a, b) = ((x1 - x) / h, (x - x0) / h);
        let (m, n) = (self.bends[i], self.bends[i + 1]);
        y0 * a + y1 * b + (m * (a * a * a - a) + n * (b * b * b - b)) * (h * h / 6.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_natural_spline_passes_through_its_points_without_a_bend_at_its_ends() {
        let points = [[0.0, 1.0], [0.2, 2.0], [0.5, 0.5], [1.0, 3.0]];
        let spline = NaturalSpline::new(&points);
        for [x, y] in points {
            assert!((spline.at(x) - y).abs() < 1e-14);
        }
        let h = 1e-3;
        for i in 1..3 {
            let x = points[i][0];
            let bend = |x: f64| spline.at(x + h) - 2.0 * spline.at(x) + spline.at(x - h);
            assert!((bend(x - 2.0 * h) - bend(x + 2.0 * h)).abs() < 1e-3);
            let slope = |x: f64| spline.at(x + 1e-7) - spline.at(x - 1e-7);
            assert!((slope(x - 1e-7) - slope(x + 1e-7)).abs() < 1e-11);
        }
        assert_eq!((spline.bends[0], spline.bends[3]), (0.0, 0.0));
    }
}
