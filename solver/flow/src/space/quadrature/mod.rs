//! Quadrature rules on the reference simplex and on the unit interval.

mod tabulated;
mod tetrahedron;
mod triangle;

use alewife_mesh::GaussRule;
use nalgebra::SVector;

pub use self::tabulated::Rule;
use self::tabulated::rule_of_degree;

/// A rule on the reference triangle or tetrahedron, exact for polynomials up to `degree` (at most 12
/// and 8).
///
/// # Source
/// @xiao2010.
///
/// # Panics
/// Where no rule of that degree is tabulated, which is a mistake of ours.
#[must_use]
pub fn simplex_rule<const D: usize>(degree: usize) -> Rule<D> {
    match D {
        2 => rule_of_degree(&triangle::RULES, degree, 0.5),
        _ => rule_of_degree(&tetrahedron::RULES, degree, 1.0 / 6.0),
    }
}

/// The Gauss rule with 4 points on \[0, 1\], exact up to degree 7.
#[must_use]
pub fn interval_rule() -> Rule<1> {
    let GaussRule { points, weights } = GaussRule::new(4);
    Rule { points: points.into_iter().map(SVector::<f64, 1>::new).collect(), weights }
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
            let rule = simplex_rule::<2>(usize::try_from(degree).unwrap());
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
        for degree in 1..=8 {
            let rule = simplex_rule::<3>(usize::try_from(degree).unwrap());
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
    fn the_interval_rule_is_exact_to_degree_seven() {
        let rule = interval_rule();
        for power in 0..8 {
            let sum: f64 =
                rule.points.iter().zip(&rule.weights).map(|(x, w)| w * x[0].powi(power)).sum();
            assert!((sum - 1.0 / f64::from(power + 1)).abs() < 1e-14);
        }
    }
}
