//! `gait.slip`: a surface that slips along itself with a velocity by expressions.

use serde::{Deserialize, Serialize};

use crate::spec::formula::{Definitions, Formula, FormulaError, ParsedFormula};
#[cfg(test)]
use crate::spec::number::FormulaPerDimension;

/// `gait.slip`: the surface slips along itself, by expressions of the place in the frame of the body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SlipGait {
    /// Velocity in the frame of the body (m/s), of which the part along the surface is taken: numbers or expressions of t (s) and of
    /// x, y, z in that frame (m), whose origin is that of the shape.
    #[cfg_attr(test, schemars(with = "FormulaPerDimension"))]
    pub velocity: Vec<Formula>,
    /// The numbers of `[define]`.
    #[serde(skip)]
    pub definitions: Definitions,
}

impl SlipGait {
    /// Its components in a problem of so many dimensions.
    ///
    /// # Errors
    /// Where in an expression something is not understood.
    pub fn parsed(&self, dimensions: usize) -> Result<Vec<ParsedFormula>, FormulaError> {
        self.velocity.iter().map(|one| one.parsed(&self.definitions, dimensions)).collect()
    }
}
