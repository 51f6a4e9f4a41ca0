//! `Bounded`: a parameter of a search with its start, bounds and scale.

use super::SearchError;

/// A parameter of a search.
#[derive(Debug, Clone, PartialEq)]
pub struct Bounded {
    /// Its name, for messages and reports.
    pub name: String,
    /// Where the search starts.
    pub start: f64,
    /// Lower bound.
    pub lower: f64,
    /// Upper bound.
    pub upper: f64,
    /// The size of a change that matters; where there is none the logarithm is searched, of positive numbers.
    pub scale: Option<f64>,
}

impl Bounded {
    pub(super) fn check(&self) -> Result<(), SearchError> {
        let Self { start, lower, upper, .. } = *self;
        let wrong = |what: String| Err(SearchError::Bounds { name: self.name.clone(), what });
        if ![start, lower, upper].iter().all(|value| value.is_finite()) || lower > upper {
            return wrong(format!(
                "the bounds {lower} and {upper} and the start {start} are not \
                three numbers with the first not above the second"
            ));
        }
        if !(lower <= start && start <= upper) {
            return wrong(format!(
                "the start {start} is not between the bounds {lower} and {upper}: widen them or move it"
            ));
        }
        match self.scale {
            Some(scale) if !(scale > 0.0 && scale.is_finite()) => {
                wrong(format!("the scale {scale} is not positive"))
            }
            None if lower <= 0.0 => wrong(format!(
                "without a scale the logarithm is searched, and the lower bound {lower} has none"
            )),
            _ => Ok(()),
        }
    }

    /// The number that is searched.
    pub(super) fn searched(&self, value: f64) -> f64 {
        self.scale.map_or_else(|| value.ln(), |scale| value / scale)
    }

    /// The parameter of a searched number, exactly a bound where it is one.
    pub(super) fn value(&self, searched: f64) -> f64 {
        if searched <= self.searched(self.lower) {
            return self.lower;
        }
        if searched >= self.searched(self.upper) {
            return self.upper;
        }
        self.scale.map_or_else(|| searched.exp(), |scale| searched * scale)
    }

    /// Derivative of the parameter by the searched number.
    pub(super) fn slope(&self, value: f64) -> f64 {
        self.scale.unwrap_or(value)
    }
}
