//! `[time]`: a steady solution, or a march in time.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// `[time.steady]` or `[time.unsteady]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum TimeSettings {
    /// Steady flow, or the instantaneous flow of the `stokes` model.
    Steady(Steady),
    /// March in time.
    Unsteady(Unsteady),
}

/// `[time.steady]`: Newton's method, with continuation in the Reynolds number when it stalls.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Steady {
    /// Largest residual relative to the first one (1).
    #[serde(default = "default_tolerance")]
    pub tolerance: f64,
    /// Most Newton iterations for one Reynolds number.
    #[serde(default = "default_iterations")]
    pub max_iterations: usize,
}

/// `[time.unsteady]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Unsteady {
    /// Step (s).
    pub step: f64,
    /// End (s).
    pub end: f64,
    /// Scheme.
    #[serde(default)]
    pub scheme: Scheme,
    /// Treatment of the convection.
    #[serde(default)]
    pub convection: Convection,
    /// Where the run starts.
    #[serde(default)]
    pub initial: Initial,
}

/// Time scheme.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Scheme {
    /// Backward Euler.
    Bdf1,
    /// Second-order backward differences.
    #[default]
    Bdf2,
}

/// Treatment of the convection within a step.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Convection {
    /// Extrapolated to the new time: one linear system a step.
    #[default]
    Extrapolated,
    /// Solved by Newton's method.
    Newton,
}

/// The state at time zero.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Initial {
    /// Fluid and bodies at rest.
    #[default]
    Rest,
    /// The Stokes flow of the boundary values at time zero.
    Stokes,
}

fn default_tolerance() -> f64 {
    1e-11
}

fn default_iterations() -> usize {
    25
}
