//! `[initial]`: the flow an unsteady run starts from.

use serde::{Deserialize, Serialize};

use super::formula::Formula;
#[cfg(test)]
use crate::spec::number::FormulaPerDimension;

/// `[initial]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct InitialFlow {
    /// Velocity at time zero (m/s), one number or expression per dimension; sides and bodies keep their own.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(test, schemars(with = "FormulaPerDimension"))]
    pub velocity: Vec<Formula>,
}
