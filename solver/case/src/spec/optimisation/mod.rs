//! `[optimisation]` of a flow or a reduced model: which numbers a search changes, and what it makes large.

mod constraint;
mod search;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::ReferenceKind;
#[cfg(test)]
use crate::spec::number::{NonZero, Positive};

pub use self::constraint::{Bound, FlowConstraint, Limit};
pub use self::search::SearchSettings;

/// `[optimisation]`: numbers of the case that make an objective large, which `alewife optimise` finds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct FlowOptimisation {
    /// What is made large.
    pub objective: FlowObjective,
    /// The numbers.
    pub parameter: Vec<FlowParameter>,
    /// What is held meanwhile.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub constraint: Vec<FlowConstraint>,
    /// How the search ends.
    #[serde(default)]
    pub search: SearchSettings,
    /// What the optimum is compared with.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub reference: Vec<OptimumReference>,
}

/// `objective`: one of these.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum FlowObjective {
    /// A sum of quantities, each times its weight.
    Sum(#[cfg_attr(test, schemars(length(min = 1)))] Vec<WeightedQuantity>),
    /// An expression of quantities.
    Expression(ObjectiveExpression),
}

/// A quantity of a sum.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct WeightedQuantity {
    /// The quantity: a load, power or velocity of a body or swimmer, by its column in `series.csv`.
    pub quantity: String,
    /// What it counts, below 0 for one that is made small.
    #[serde(default = "one")]
    #[cfg_attr(test, schemars(with = "NonZero"))]
    pub weight: f64,
}

fn one() -> f64 {
    1.0
}

/// `expression`: an objective such as `u^2 / p`, and which quantities its names are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ObjectiveExpression {
    /// The expression, of these names and those of `[define]`.
    pub value: String,
    /// The quantity of each name, by its column in `series.csv`.
    #[cfg_attr(test, schemars(length(min = 1)))]
    pub quantities: BTreeMap<String, String>,
}

impl FlowObjective {
    /// The quantities it is made of, with the key of each in its table.
    #[must_use]
    pub fn quantities(&self) -> Vec<NamedQuantity<'_>> {
        let all: Vec<NamedQuantity<'_>> = match self {
            Self::Sum(terms) => terms
                .iter()
                .enumerate()
                .map(|(nth, term)| NamedQuantity {
                    key: format!("sum.{nth}.quantity"),
                    name: None,
                    quantity: &term.quantity,
                    weight: term.weight,
                })
                .collect(),
            Self::Expression(expression) => expression
                .quantities
                .iter()
                .map(|(name, quantity)| NamedQuantity {
                    key: format!("expression.quantities.{name}"),
                    name: Some(name),
                    quantity,
                    weight: 0.0,
                })
                .collect(),
        };
        all
    }
}

/// A quantity an objective is made of.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedQuantity<'a> {
    /// Where it is written, below `optimisation.objective`.
    pub key: String,
    /// Its name in an expression.
    pub name: Option<&'a str>,
    /// The quantity.
    pub quantity: &'a str,
    /// What it counts in a sum.
    pub weight: f64,
}

/// `parameter`: a number of the case, or several that follow from one, which a search finds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct FlowParameter {
    /// Its name, in messages, reports and `values`.
    pub name: String,
    /// Keys of the case that have its value, such as `body.0.shape.sphere.radius`. One key of a list, such as
    /// `body.0.gait.squirmer.modes`, stands for one parameter an entry.
    #[cfg_attr(test, schemars(length(min = 1)))]
    pub keys: Vec<String>,
    /// What each of the keys is, as an expression of names of parameters and of `[define]`, such as
    /// `aspect^(2/3)`; the parameter itself if absent.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub values: Vec<String>,
    /// Where the search starts; at the value of the first key if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start: Option<f64>,
    /// Lower and upper bound.
    pub bounds: [f64; 2],
    /// The size of a change that matters; the logarithm is searched if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub scale: Option<f64>,
}

/// `reference`: a value with which an optimum is compared.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct OptimumReference {
    /// What is compared: `objective`, the name of a parameter, or a quantity of the objective.
    pub quantity: String,
    /// Its value.
    pub value: f64,
    /// Largest accepted difference, of the value; this or `absolute`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub relative: Option<f64>,
    /// Largest accepted difference; this or `relative`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub absolute: Option<f64>,
    /// What kind of evidence it is.
    pub kind: ReferenceKind,
    /// Where it is from.
    pub source: String,
}

impl OptimumReference {
    /// The largest difference that is accepted.
    #[must_use]
    pub fn allowed(&self) -> f64 {
        self.absolute.unwrap_or_else(|| self.relative.unwrap_or(0.0) * self.value.abs())
    }
}
