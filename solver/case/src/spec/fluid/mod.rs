//! `[fluid]`: density, viscosity, gravity and which equations hold.

pub(crate) mod mean_flow;
pub(crate) mod scalar;
pub(crate) mod tracer;
pub(crate) mod viscosity;

use crate::spec::fluid::viscosity::ViscositySpec;
use crate::spec::formula::Formula;
#[cfg(test)]
use crate::spec::number::{FormulaPerDimension, NonNegative, PerDimension};
use serde::{Deserialize, Serialize};

/// Which equations the fluid obeys.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum FlowModel {
    /// Quasi-steady: no inertia of fluid or bodies.
    Stokes,
    /// Inertia without convection.
    UnsteadyStokes,
    /// The full equations.
    NavierStokes,
}

/// `[fluid]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Fluid {
    /// Which equations hold.
    pub model: FlowModel,
    /// Dynamic viscosity (Pa s), or the law by which it depends on the rate of shear.
    pub viscosity: ViscositySpec,
    /// Density (kg/m3); needed unless the model is `stokes`.
    #[serde(default)]
    #[cfg_attr(test, schemars(with = "NonNegative"))]
    pub density: f64,
    /// Acceleration of gravity (m/s2), one number per dimension; it acts on bodies through their
    /// weight less buoyancy, so that the pressure is the one without its hydrostatic part.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(test, schemars(with = "PerDimension"))]
    pub gravity: Vec<f64>,
    /// Force per volume on the fluid (N/m3), one number or expression per dimension.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(test, schemars(with = "FormulaPerDimension"))]
    pub force: Vec<Formula>,
}
