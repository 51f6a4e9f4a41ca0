//! `Rule`: Gauss-Legendre points on [0, 1], and integrals from 0 to any number between.

use std::f64::consts::PI;

/// Gauss-Legendre rule on [0, 1].
#[derive(Debug, Clone)]
pub struct Rule {
    /// Abscissae, ascending.
    pub points: Vec<f64>,
    /// Weights; they add to one.
    pub weights: Vec<f64>,
}

impl Rule {
    /// The rule with n points: zeros of the Legendre polynomial by Newton's method.
    pub fn new(n: usize) -> Self {
        let (mut points, mut weights) = (Vec::new(), Vec::new());
        for i in 0..n {
            let mut x = -(PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..100 {
                let at = legendre(n, x);
                slope = at.derivative;
                let step = at.value / at.derivative;
                x -= step;
                if step.abs() < 1e-16 {
                    break;
                }
            }
            points.push(0.5 * (1.0 + x));
            weights.push(1.0 / ((1.0 - x * x) * slope * slope));
        }
        Self { points, weights }
    }

    /// Weights that integrate from 0 to `x` the polynomial through values at the points.
    pub fn up_to(&self, x: f64) -> Vec<f64> {
        let n = self.points.len();
        let basis = |k: usize, at: f64| -> f64 {
            let others = (0..n).filter(|m| *m != k);
            others.map(|m| (at - self.points[m]) / (self.points[k] - self.points[m])).product()
        };
        (0..n)
            .map(|k| {
                let sum: f64 = (0..n).map(|m| self.weights[m] * basis(k, x * self.points[m])).sum();
                x * sum
            })
            .collect()
    }
}

/// A function at a point.
struct WithDerivative {
    value: f64,
    derivative: f64,
}

/// The Legendre polynomial P_n inside (-1, 1).
fn legendre(n: usize, x: f64) -> WithDerivative {
    let (mut before, mut value) = (1.0, x);
    for k in 1..n {
        let k = k as f64;
        (before, value) = (value, ((2.0 * k + 1.0) * x * value - k * before) / (k + 1.0));
    }
    WithDerivative { value, derivative: n as f64 * (before - x * value) / (1.0 - x * x) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_integrated_exactly() {
        for n in [4, 6, 8] {
            let rule = Rule::new(n);
            for (degree, power) in (0..2 * n).zip(0..) {
                let sum: f64 =
                    rule.points.iter().zip(&rule.weights).map(|(x, w)| w * x.powi(power)).sum();
                assert!((sum * (degree as f64 + 1.0) - 1.0).abs() < 1e-14);
            }
            for (degree, power) in (0..n).zip(0..) {
                let row = rule.up_to(0.37);
                let sum: f64 = rule.points.iter().zip(&row).map(|(x, w)| w * x.powi(power)).sum();
                let exact = 0.37_f64.powi(power + 1) / (degree as f64 + 1.0);
                assert!((sum - exact).abs() < 1e-14);
            }
        }
    }
}
