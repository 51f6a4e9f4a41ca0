//! Expressions of a case as functions of place and time.

use alewife_mesh::Point;

use crate::case::{Case, Formula, ParsedFormula};
use crate::coupling::{PressureProfile, VelocityProfile};
use crate::run::RunError;

/// An expression whose names are known.
///
/// # Errors
/// When it is not understood, which the rules of a case have excluded.
fn parsed(case: &Case, formula: &Formula) -> Result<ParsedFormula, RunError> {
    let parsed = formula.parsed(&case.define, case.geometry.dimensions());
    parsed.map_err(|error| RunError::Unsupported(format!("{formula}: {error}")))
}

/// Where and when an expression is taken.
fn at<const D: usize>(place: &Point<D>, time: f64) -> [f64; 4] {
    let mut at = [0.0; 4];
    at[..D].copy_from_slice(place.as_slice());
    at[3] = time;
    at
}

/// A number as a function of place and time.
///
/// # Errors
/// When its expression is not understood.
pub fn number<const D: usize>(
    case: &Case,
    formula: &Formula,
) -> Result<PressureProfile<D>, RunError> {
    let parsed = parsed(case, formula)?;
    Ok(Box::new(move |place, time| parsed.at(&at(place, time))))
}

/// A vector as a function of place and time; components that are not written are 0.
///
/// # Errors
/// When an expression is not understood.
pub fn vector<const D: usize>(
    case: &Case,
    formulas: &[Formula],
) -> Result<VelocityProfile<D>, RunError> {
    let components: Result<Vec<ParsedFormula>, RunError> =
        formulas.iter().map(|formula| parsed(case, formula)).collect();
    let components = components?;
    if components.iter().all(ParsedFormula::is_constant) {
        let value = Point::<D>::from_fn(|axis, _| {
            components.get(axis).map_or(0.0, |component| component.at(&[0.0; 4]))
        });
        return Ok(Box::new(move |_, _| value));
    }
    Ok(Box::new(move |place, time| {
        let at = at(place, time);
        Point::<D>::from_fn(|axis, _| components.get(axis).map_or(0.0, |one| one.at(&at)))
    }))
}
