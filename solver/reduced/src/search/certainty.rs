//! `Certainty`: how well the optimum of a search determines each of its parameters.

use nalgebra::DMatrix;

use super::{Bounded, Evaluated, Sought};

/// Step of the searched numbers by which slopes are compared.
const STEP: f64 = 1e-3;

/// What is known of a parameter at an optimum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Certainty {
    /// How far the searched number, the parameter over its scale or its logarithm, may go while the objective
    /// rises by no more than the rise that is asked about, where all other parameters that are free follow;
    /// infinite along a valley. None at a bound.
    pub reach: Option<f64>,
    /// Whether the parameter is determined: at a bound that holds it, or in reach of less than half of what
    /// lies between its bounds.
    pub is_determined: bool,
}

/// How well parameters are determined at an optimum: from the second derivatives there, by differences of
/// gradients, with an evaluation for each parameter that is at no bound. `rise` is the change of the objective
/// that counts as one.
///
/// # Errors
/// Those of the evaluations.
pub fn certainties(
    parameters: &[Bounded],
    best: &Evaluated,
    rise: f64,
    sought: &mut dyn Sought,
) -> Result<Vec<Certainty>, String> {
    let slope = |at: &Evaluated, k: usize| at.slopes[k] * parameters[k].slope(at.values[k]);
    let is_free = |k: &usize| {
        let Bounded { lower, upper, .. } = parameters[*k];
        best.values[*k] > lower && best.values[*k] < upper
    };
    let free: Vec<usize> = (0..parameters.len()).filter(is_free).collect();
    let mut second = DMatrix::<f64>::zeros(free.len(), free.len());
    for (column, k) in free.iter().enumerate() {
        let mut values = best.values.clone();
        let from = parameters[*k].searched(values[*k]);
        let to = from + STEP;
        let forward = to < parameters[*k].searched(parameters[*k].upper);
        values[*k] = parameters[*k].value(if forward { to } else { from - STEP });
        let step = parameters[*k].searched(values[*k]) - from;
        let beside = sought.evaluate(&values)?;
        for (row, other) in free.iter().enumerate() {
            second[(row, column)] = (slope(&beside, *other) - slope(best, *other)) / step;
        }
    }
    let second = (&second + second.transpose()) * 0.5;
    let inverse = second.cholesky().map(|factors| factors.inverse());
    Ok((0..parameters.len())
        .map(|k| {
            let at = free.iter().position(|free| *free == k);
            // Without a positive second derivative there is a direction in which nothing rises
            let reach = at.map(|at| {
                inverse
                    .as_ref()
                    .map_or(f64::INFINITY, |inverse| (2.0 * rise * inverse[(at, at)]).sqrt())
            });
            let Bounded { lower, upper, .. } = parameters[k];
            let width = parameters[k].searched(upper) - parameters[k].searched(lower);
            let is_determined = reach.is_none_or(|reach| reach < 0.5 * width);
            Certainty { reach, is_determined }
        })
        .collect())
}
