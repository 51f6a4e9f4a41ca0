//! Quadrature rules on the reference simplex and on the unit interval.

use nalgebra::SVector;
use quadraturerules::{Domain, QuadratureRule, single_integral_quadrature};

/// Points and weights; the weights sum to the measure of the reference domain.
#[derive(Debug, Clone, PartialEq)]
pub struct Rule<const D: usize> {
    /// Points in reference coordinates.
    pub points: Vec<SVector<f64, D>>,
    /// Weights.
    pub weights: Vec<f64>,
}

/// A rule on the reference triangle or tetrahedron, exact for polynomials up to `degree`
/// (1 to 15).
///
/// # Source
/// Xiao and Gimbutas 2010, as tabulated by the online encyclopaedia of quadrature rules.
///
/// # Panics
/// Where no rule of that degree is tabulated, which is a mistake of ours.
#[must_use]
pub fn simplex_rule<const D: usize>(degree: usize) -> Rule<D> {
    let (domain, measure) =
        if D == 2 { (Domain::Triangle, 0.5) } else { (Domain::Tetrahedron, 1.0 / 6.0) };
    let (coordinates, weights) =
        single_integral_quadrature(QuadratureRule::XiaoGimbutas, domain, degree)
            .expect("a Xiao-Gimbutas rule exists for every degree up to 30");
    // The table gives barycentric coordinates and weights that sum to one.
    let points =
        coordinates.chunks(D + 1).map(|l| SVector::from_fn(|axis, _| l[axis + 1])).collect();
    Rule { points, weights: weights.iter().map(|weight| weight * measure).collect() }
}

/// The Gauss rule with `n_points` points on \[0, 1\], exact up to degree 2 n - 1.
///
/// # Panics
/// Where no such rule is tabulated, which is a mistake of ours.
#[must_use]
pub fn interval_rule(n_points: usize) -> Rule<1> {
    let (coordinates, weights) =
        single_integral_quadrature(QuadratureRule::GaussLegendre, Domain::Interval, n_points)
            .expect("Gauss rules exist for small numbers of points");
    let points = coordinates.chunks(2).map(|l| SVector::<f64, 1>::new(l[1])).collect();
    Rule { points, weights }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn factorial(n: i32) -> f64 {
        (1..=n).map(f64::from).product()
    }

    #[test]
    fn triangle_rules_integrate_every_monomial_up_to_their_degree() {
        for degree in 1..=12 {
            let rule = simplex_rule::<2>(degree as usize);
            for i in 0..=degree {
                for j in 0..=(degree - i) {
                    let sum: f64 = rule
                        .points
                        .iter()
                        .zip(&rule.weights)
                        .map(|(x, w)| w * x[0].powi(i) * x[1].powi(j))
                        .sum();
                    let exact = factorial(i) * factorial(j) / factorial(i + j + 2);
                    assert!((sum - exact).abs() < 1e-14, "degree {degree}: x^{i} y^{j}");
                }
            }
        }
    }

    #[test]
    fn tetrahedron_rules_integrate_every_monomial_up_to_their_degree() {
        for degree in 1..=6 {
            let rule = simplex_rule::<3>(degree as usize);
            for i in 0..=degree {
                for j in 0..=(degree - i) {
                    for k in 0..=(degree - i - j) {
                        let sum: f64 = rule
                            .points
                            .iter()
                            .zip(&rule.weights)
                            .map(|(x, w)| w * x[0].powi(i) * x[1].powi(j) * x[2].powi(k))
                            .sum();
                        let exact =
                            factorial(i) * factorial(j) * factorial(k) / factorial(i + j + k + 3);
                        assert!((sum - exact).abs() < 1e-14);
                    }
                }
            }
        }
    }

    #[test]
    fn interval_rules_are_exact_to_their_degree() {
        for n in 1..=6 {
            let rule = interval_rule(n);
            for power in 0..(2 * n as i32) {
                let sum: f64 =
                    rule.points.iter().zip(&rule.weights).map(|(x, w)| w * x[0].powi(power)).sum();
                assert!((sum - 1.0 / f64::from(power + 1)).abs() < 1e-14);
            }
        }
    }
}
