//! `[[scalar]]`: a concentration or a temperature that the flow carries and that diffuses.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::spec::formula::Formula;
#[cfg(test)]
use crate::spec::number::{NonNegative, NonZero, Positive};

/// `[[scalar]]`: a concentration or a temperature that the flow carries and that diffuses; the flow does not know of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ScalarSpec {
    /// Name, used in outputs and references.
    pub name: String,
    /// Diffusivity (m2/s); or `peclet`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub diffusivity: Option<f64>,
    /// Péclet number: velocity times length of `[scales]` over the diffusivity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub peclet: Option<f64>,
    /// Its value at time zero, a number or an expression; a steady solution does not need it.
    #[serde(default = "zero", skip_serializing_if = "is_zero")]
    pub initial: Formula,
    /// What is made in the fluid in a unit of time and volume (1/s times its unit), a number or an expression.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<Formula>,
    /// What holds on sides, by their names; through others nothing diffuses.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub boundary: BTreeMap<String, ScalarCondition>,
    /// What holds on bodies, by their names; through others nothing diffuses.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub body: BTreeMap<String, ScalarCondition>,
    /// Its value on bodies less that far away, for Sherwood numbers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<NonZero>"))]
    pub difference: Option<f64>,
}

/// What holds for a scalar on a side or a body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum ScalarCondition {
    /// Its value, a number or an expression.
    Value(Formula),
    /// What diffuses into the fluid for each area (m/s times its unit), a number or an expression.
    Flux(Formula),
    /// What diffuses out of the fluid for each area is `rate` times what it is more than `outside`.
    Uptake {
        /// Rate (m/s).
        #[cfg_attr(test, schemars(with = "NonNegative"))]
        rate: f64,
        /// The value at which nothing is taken up, a number or an expression.
        #[serde(default = "zero", skip_serializing_if = "is_zero")]
        outside: Formula,
    },
}

impl ScalarCondition {
    /// Its expression.
    #[must_use]
    pub fn formula(&self) -> &Formula {
        match self {
            Self::Value(formula) | Self::Flux(formula) | Self::Uptake { outside: formula, .. } => {
                formula
            }
        }
    }

    /// The key of its expression, below that of the condition.
    #[must_use]
    pub fn key(&self) -> &'static str {
        match self {
            Self::Value(_) => "value",
            Self::Flux(_) => "flux",
            Self::Uptake { .. } => "uptake.outside",
        }
    }

    /// Whether it says what the scalar is there, rather than what its rate is.
    #[must_use]
    pub fn fixes_level(&self) -> bool {
        match self {
            Self::Value(_) => true,
            Self::Flux(_) => false,
            Self::Uptake { rate, .. } => *rate > 0.0,
        }
    }
}

fn zero() -> Formula {
    Formula::Number(0.0)
}

fn is_zero(formula: &Formula) -> bool {
    formula.number() == Some(0.0)
}
