//! What a fit has come to: whether it moved, and whether what is fitted depends on what is sought.

use alewife_reduced::tree::{Bounds, Fit};

use super::error::CalibrateError;

/// Part of what is left that a coefficient changes over all of its bounds below which it changes nothing.
const NOTHING: f64 = 1e-12;

/// Part of the cost that a further step may promise where a fit has converged.
const CONVERGED: f64 = 1e-4;

/// Rounding of a cost.
const ROUNDING: f64 = 1e-9;

/// Whether each coefficient changes anything of what is fitted.
pub fn has_effect(fit: &Fit, bounds: &[Bounds]) -> Vec<bool> {
    let left = (2.0 * fit.start_cost.max(fit.cost)).sqrt();
    let widths = bounds.iter().map(|one| one.upper - one.lower);
    fit.sensitivities.iter().zip(widths).map(|(one, width)| one * width > NOTHING * left).collect()
}

/// Refuses a fit that has fitted nothing; what else is to be said of one.
///
/// # Errors
/// `CalibrateError::Fit` where nothing depends on what is sought, no step made the fit better, or it is worse than the start.
pub fn judged(
    fit: &Fit,
    start: &[f64],
    bounds: &[Bounds],
    names: &[String],
) -> Result<Option<String>, CalibrateError> {
    let refused = |what: String| Err(CalibrateError::Fit(what));
    if !(fit.cost.is_finite() && fit.start_cost.is_finite()) {
        return refused(format!(
            "what is left of the fit is {}, {} at the start: the motion blows up, or a record is of another one",
            fit.cost, fit.start_cost
        ));
    }
    if !has_effect(fit, bounds).contains(&true) {
        return refused(format!(
            "nothing that is fitted depends on {}: other runs or records, or other coefficients",
            names.join(", ")
        ));
    }
    if fit.cost > fit.start_cost * (1.0 + ROUNDING) {
        return refused(format!(
            "the fit is worse than the start: {:.4e} is left of {:.4e}",
            fit.cost, fit.start_cost
        ));
    }
    let is_there = fit.promised.is_finite() && fit.promised <= CONVERGED;
    if fit.parameters != start {
        return Ok((!is_there).then(|| {
            "the fit has not converged: a longer one, or `differences` where motions forget how they began".to_owned()
        }));
    }
    if is_there {
        return Ok(Some("no coefficient moved: nothing near the start fits better".to_owned()));
    }
    refused(
        "no step from the start made the fit better: another start in [reduced], or `differences` in \
         [calibration] where motions forget how they began"
            .to_owned(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fit(parameters: [f64; 2], cost: f64, sensitivities: [f64; 2], promised: f64) -> Fit {
        Fit {
            parameters: parameters.to_vec(),
            cost,
            start_cost: 1.0,
            promised,
            sensitivities: sensitivities.to_vec(),
            uncertainties: vec![0.1; 2],
            steps: 3,
        }
    }

    fn told(fit: &Fit) -> Result<Option<String>, String> {
        let bounds = [Bounds { lower: 0.0, upper: 2.0 }; 2];
        let names = ["along".to_owned(), "across".to_owned()];
        judged(fit, &[1.0, 1.0], &bounds, &names).map_err(|error| error.to_string())
    }

    #[test]
    fn a_fit_that_fits_nothing_is_refused() {
        assert_eq!(told(&fit([0.5, 1.0], 0.2, [1.0, 0.0], 0.0)), Ok(None));
        let far = told(&fit([0.5, 1.0], 0.2, [1.0, 1.0], 0.5)).unwrap();
        assert!(far.is_some_and(|what| what.contains("not converged")));
        let there = told(&fit([1.0, 1.0], 1.0, [1.0, 1.0], 1e-9)).unwrap();
        assert!(there.is_some_and(|what| what.contains("no coefficient moved")));
        for (fit, words) in [
            (fit([1.0, 1.0], 1.0, [1.0, 1.0], 0.5), "no step from the start"),
            (fit([0.5, 1.0], 1.1, [1.0, 1.0], 0.0), "worse than the start"),
            (fit([1.0, 1.0], 1.0, [0.0, 0.0], 0.0), "depends on along, across"),
            (fit([0.5, 1.0], f64::NAN, [1.0, 1.0], 0.0), "blows up"),
        ] {
            let error = told(&fit).unwrap_err();
            assert!(error.contains(words), "{error}");
        }
        let effects = has_effect(
            &fit([0.5, 1.0], 0.2, [1.0, 0.0], 0.0),
            &[Bounds { lower: 0.0, upper: 2.0 }; 2],
        );
        assert_eq!(effects, [true, false]);
    }
}
