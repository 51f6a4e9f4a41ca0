//! `search`: how a search ends, of soft cases and of steady flows.

use serde::{Deserialize, Serialize};

#[cfg(test)]
use crate::spec::number::Positive;

/// `search`: how a search ends.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct SearchSettings {
    /// Evaluations at most.
    pub evaluations: usize,
    /// Relative decrease in an iteration that ends it.
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub decrease: f64,
    /// Slope, of the objective at the start, below which no parameter would change it.
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub slope: f64,
}

impl Default for SearchSettings {
    fn default() -> Self {
        Self { evaluations: 100, decrease: 1e-6, slope: 1e-6 }
    }
}
