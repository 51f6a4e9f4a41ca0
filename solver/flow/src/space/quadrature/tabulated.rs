//! `Rule`: points and weights, as they follow from a table.

use nalgebra::SVector;

/// Points and weights; the weights sum to the measure of the reference domain.
#[derive(Debug, Clone, PartialEq)]
pub struct Rule<const D: usize> {
    /// Points in reference coordinates.
    pub points: Vec<SVector<f64, D>>,
    /// Weights.
    pub weights: Vec<f64>,
}

/// A tabulated rule: coordinates and weight of each point, the weights summing to one.
pub(super) struct Tabulated<const N: usize> {
    /// Highest degree of polynomials it integrates exactly.
    pub degree: usize,
    /// Coordinates, then the weight.
    pub points: &'static [[f64; N]],
}

/// The first rule of at least a degree, its weights scaled to a measure.
pub(super) fn rule_of_degree<const D: usize, const N: usize>(
    rules: &[Tabulated<N>],
    degree: usize,
    measure: f64,
) -> Rule<D> {
    let rule = rules.iter().find(|rule| rule.degree >= degree);
    let rows = rule.expect("a rule of this degree is tabulated").points;
    Rule {
        points: rows.iter().map(|row| SVector::from_fn(|axis, _| row[axis])).collect(),
        weights: rows.iter().map(|row| row[D] * measure).collect(),
    }
}
