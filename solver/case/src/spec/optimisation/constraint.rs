//! `[[optimisation.constraint]]`: what is held at a value, or within one, while an objective is made large.

use serde::{Deserialize, Serialize};

#[cfg(test)]
use crate::spec::number::Positive;

/// `constraint`: a quantity of the flow, or the volume of a body, that is held at a value or within one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct FlowConstraint {
    /// A load, power or velocity of a body or swimmer, by its column in `series.csv`; this or `volume`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quantity: Option<String>,
    /// The name of a body: its volume, in the plane its area.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub volume: Option<String>,
    /// What it is; one of `equals`, `at_most` and `at_least`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub equals: Option<f64>,
    /// What it is at most.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_most: Option<f64>,
    /// What it is at least.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_least: Option<f64>,
    /// How far it may be off, of its value; where that is 0 of 1.
    #[serde(default = "tolerance")]
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub tolerance: f64,
}

/// A ten-thousandth.
fn tolerance() -> f64 {
    1e-4
}

/// On which side of a value something is held.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bound {
    /// At it.
    Equals,
    /// At it or below.
    AtMost,
    /// At it or above.
    AtLeast,
}

impl Bound {
    /// Its key.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Equals => "equals",
            Self::AtMost => "at_most",
            Self::AtLeast => "at_least",
        }
    }
}

/// A value, and on which side of it something is held.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// On which side.
    pub bound: Bound,
    /// The value.
    pub value: f64,
}

impl FlowConstraint {
    /// All values that are written, of which there should be one.
    pub(crate) fn limits(&self) -> Vec<Limit> {
        let all = [
            (Bound::Equals, self.equals),
            (Bound::AtMost, self.at_most),
            (Bound::AtLeast, self.at_least),
        ];
        all.into_iter().filter_map(|(bound, value)| Some(Limit { bound, value: value? })).collect()
    }

    /// What is held at; `None` of one that `check` refuses.
    #[must_use]
    pub fn limit(&self) -> Option<Limit> {
        self.limits().first().copied()
    }

    /// What it is called in reports.
    #[must_use]
    pub fn name(&self) -> String {
        match (&self.quantity, &self.volume) {
            (Some(quantity), _) => quantity.clone(),
            (None, Some(body)) => format!("volume of {body}"),
            (None, None) => String::new(),
        }
    }
}
