//! `ClosedCurve`: a spline through moving points, with the exact rates of its integrals.

use alewife_mesh::{GaussRule, Spline};
use num_dual::{Dual64, DualNum};

use crate::gait::number::cross;

/// A spline with the spline of its velocities: the curve is linear in its points.
#[derive(Debug, Clone)]
pub struct ClosedCurve {
    pub points: Spline,
    pub rates: Spline,
}

/// Integrals over what a curve encloses.
#[derive(Debug, Clone, Copy)]
pub struct Enclosed {
    /// Area (m²).
    pub area: Dual64,
    /// Centre of area (m).
    pub center: [Dual64; 2],
    /// Second moment about the centre (m⁴).
    pub polar: Dual64,
}

impl ClosedCurve {
    /// Through points at given parameters; `None` if there is no such curve.
    pub fn through(points: &[[Dual64; 2]], knots: &[f64]) -> Option<Self> {
        let positions: Vec<[f64; 2]> = points.iter().map(|p| p.map(|part| part.re)).collect();
        let rates: Vec<[f64; 2]> = points.iter().map(|p| p.map(|part| part.eps)).collect();
        Some(Self {
            points: Spline::with_knots(&positions, knots)?,
            rates: Spline::with_knots(&rates, knots)?,
        })
    }

    /// Position, and derivative by the parameter.
    ///
    /// On one of its pieces, from its start, 0, to its end, 1.
    fn at(&self, piece: usize, part: f64) -> [[Dual64; 2]; 2] {
        let position = self.points.evaluate_on(piece, part);
        let rate = self.rates.evaluate_on(piece, part);
        [0, 1].map(|order| [0, 1].map(|axis| Dual64::new(position[order][axis], rate[order][axis])))
    }

    /// Unit normals at the knots, out of the body.
    pub fn normals(&self) -> Vec<[Dual64; 2]> {
        let normal = |piece: usize| {
            let [x, y] = self.at(piece, 0.0)[1];
            let length = (x * x + y * y).sqrt();
            [y / length, -x / length]
        };
        (0..self.points.knots().len() - 1).map(normal).collect()
    }

    /// Area enclosed by this curve plus a small number times another one: its value and both
    /// derivatives over their factorials.
    pub fn area_along(&self, rule: &GaussRule, other: &Self) -> [Dual64; 3] {
        let mut sums = [Dual64::from(0.0); 3];
        self.each_point(rule, |piece, part, weight| {
            let ([p, dp], [q, dq]) = (self.at(piece, part), other.at(piece, part));
            let half = 0.5 * weight;
            sums[0] += cross(p, dp) * half;
            sums[1] += (cross(p, dq) + cross(q, dp)) * half;
            sums[2] += cross(q, dq) * half;
        });
        sums
    }

    /// By Green's theorem: ∫ |x|^k dA = ∮ |x|^k (x dy - y dx) / (k + 2), exact for cubic pieces.
    pub fn enclosed(&self, rule: &GaussRule) -> Enclosed {
        let zero = Dual64::from(0.0);
        let (mut area, mut first, mut second) = (zero, [zero; 2], zero);
        self.each_point(rule, |piece, part, weight| {
            let [p, dp] = self.at(piece, part);
            let sector = cross(p, dp) * weight;
            area += sector * 0.5;
            first = [0, 1].map(|i| first[i] + p[i] * sector / 3.0);
            second += (p[0] * p[0] + p[1] * p[1]) * sector * 0.25;
        });
        let center = first.map(|moment| moment / area);
        let polar = second - area * (center[0] * center[0] + center[1] * center[1]);
        Enclosed { area, center, polar }
    }

    fn each_point(&self, rule: &GaussRule, mut visit: impl FnMut(usize, f64, f64)) {
        for (piece, ends) in self.points.knots().windows(2).enumerate() {
            let span = ends[1] - ends[0];
            for (x, weight) in rule.points.iter().zip(&rule.weights) {
                visit(piece, *x, span * weight);
            }
        }
    }

    /// Mean of |velocity along the normal| over the curve (m/s), by the trapezoidal rule.
    pub fn mean_normal_speed(&self) -> f64 {
        let (mut sum, mut length) = (0.0, 0.0);
        let knots = self.points.knots();
        for (i, ends) in knots.windows(2).enumerate() {
            let before = if i == 0 { knots.len() - 2 } else { i - 1 };
            let weight = 0.5 * (ends[1] - ends[0] + knots[before + 1] - knots[before]);
            let [_, along, _] = self.points.evaluate_on(i, 0.0);
            let [rate, ..] = self.rates.evaluate_on(i, 0.0);
            sum += weight * (rate.x * along.y - rate.y * along.x).abs();
            length += weight * along.norm();
        }
        sum / length
    }
}
