//! `[flow]`: what drives the fluid along periodic directions.

use serde::{Deserialize, Serialize};

use crate::TimeFunction;
#[cfg(test)]
use crate::spec::number::PerDimension;

/// `[flow]`: a mean pressure gradient or a mean velocity along periodic directions, one number per
/// dimension and zero along the others.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct MeanFlowSpec {
    /// Mean gradient of the pressure (Pa/m): negative along x drives towards +x. It acts on bodies,
    /// too: minus itself times their volume.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<PerDimension>"))]
    pub pressure_gradient: Option<Vec<f64>>,
    /// Mean velocity of fluid and bodies together (m/s), the flux through the cell over its cross
    /// section; the pressure gradient is then a result.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<PerDimension>"))]
    pub mean_velocity: Option<Vec<f64>>,
    /// Force per volume of fluid (N/m3), which does not act on bodies.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<PerDimension>"))]
    pub body_force: Option<Vec<f64>>,
    /// Factor of all of them in time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub factor: Option<TimeFunction>,
}
