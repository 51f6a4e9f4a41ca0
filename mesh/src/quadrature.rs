//! `GaussRule`: Gauss-Legendre points on [0, 1], and integrals from 0 to any number between.

use std::f64::consts::PI;

/// Gauss-Legendre rule on [0, 1].
#[derive(Debug, Clone)]
pub struct GaussRule {
    /// Abscissae, ascending.
    pub points: Vec<f64>,
    /// Weights; they add to one.
    pub weights: Vec<f64>,
}

impl GaussRule {
    /// The rule with n points, exact to degree 2n - 1: zeros of the Legendre polynomial by Newton's method.
    ///
    /// # Source
    /// @abramowitz1964, 25.4.29.
    #[must_use]
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
    #[must_use]
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

/// Abscissae of the rule with eight points, in (0, 1), to the last digit; Newton's method leaves 5e-15.
const ABSCISSAE: [f64; 8] = [
    0.019_855_071_751_231_856,
    0.101_666_761_293_186_64,
    0.237_233_795_041_835_5,
    0.408_282_678_752_175_1,
    0.591_717_321_247_825,
    0.762_766_204_958_164_5,
    0.898_333_238_706_813_4,
    0.980_144_928_248_768_1,
];

/// Its weights; they add to one.
const WEIGHTS: [f64; 8] = [
    0.050_614_268_145_188_13,
    0.111_190_517_226_687_24,
    0.156_853_322_938_943_64,
    0.181_341_891_689_181,
    0.181_341_891_689_181,
    0.156_853_322_938_943_64,
    0.111_190_517_226_687_24,
    0.050_614_268_145_188_13,
];

/// Integral of `f` over [a, b], for arc lengths and along boundaries; exact for polynomials of degree 15.
///
/// # Source
/// @abramowitz1964, table 25.4.
pub fn integrate(a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let sum: f64 =
        ABSCISSAE.iter().zip(WEIGHTS).map(|(x, weight)| weight * f(a + (b - a) * x)).sum();
    (b - a) * sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_integrated_exactly() {
        for n in [4, 6, 8] {
            let rule = GaussRule::new(n);
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

    #[test]
    fn the_rule_is_exact_to_degree_fifteen() {
        for degree in 0..16 {
            let value = integrate(0.0, 1.0, |x| x.powi(degree));
            assert!((value * f64::from(degree + 1) - 1.0).abs() < 4e-15, "degree {degree}");
        }
    }
}
