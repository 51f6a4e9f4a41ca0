//! `[environment]`: a case as a task for a controller that learns: what it sees, does and is paid for.

use std::collections::BTreeMap;
use std::fmt;

use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, Error, MapAccess, Visitor};
use serde::{Deserialize, Serialize};

#[cfg(test)]
use crate::spec::number::{NonZero, Positive};

/// `[environment]`: decisions at equal intervals, by what is observed, for a reward.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct EnvironmentSpec {
    /// Time between two decisions (s): a multiple of the step.
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub interval: f64,
    /// What is observed: quantities by their names in `series.csv`, or expressions.
    pub observations: Vec<Observation>,
    /// What is decided: commands by their names.
    pub actions: Vec<Action>,
    /// What is paid at the end of each interval: the sum of these.
    pub reward: Vec<RewardTerm>,
    /// What ends an episode for good.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub terminate: Vec<Ending>,
    /// What breaks an episode off, besides the end of the case.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub truncate: Vec<Ending>,
    /// Numbers with names, drawn at the start of each episode: `target.x`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub target: BTreeMap<String, Law>,
    /// Expressions with names, for use in others.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub value: BTreeMap<String, String>,
    /// Numbers of the case that differ from sample to sample.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub randomise: Vec<Randomised>,
    /// Samples of the case with other numbers, of which each episode takes one.
    #[serde(default = "default_samples")]
    pub samples: usize,
    /// Seed of the samples, and of episodes that are given none.
    #[serde(default)]
    pub seed: u64,
}

fn default_samples() -> usize {
    16
}

/// An observation: a name or an expression, or one with a scale and bounds.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum Observation {
    /// A quantity by its name, or an expression.
    Plain(String),
    /// The same, scaled and bounded.
    Scaled(ScaledObservation),
}

/// An observation with a scale and bounds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ScaledObservation {
    /// A quantity by its name, or an expression.
    pub of: String,
    /// What it is divided by.
    #[serde(default = "one")]
    #[cfg_attr(test, schemars(with = "NonZero"))]
    pub scale: f64,
    /// Lowest and highest value after that, to which it is clipped.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bounds: Option<[f64; 2]>,
}

/// An action: a command, or one with a range.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum Action {
    /// A command by its name; an action from -1 to 1 goes from limit to limit.
    Plain(String),
    /// The same with a range of its own.
    Ranged(RangedAction),
}

/// An action with a range.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct RangedAction {
    /// A command by its name.
    pub command: String,
    /// Targets of the actions -1 and 1; the limits of the command if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub range: Option<[f64; 2]>,
}

/// A term of the reward.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct RewardTerm {
    /// A quantity by its name, or an expression.
    pub of: String,
    /// What it is multiplied by.
    #[serde(default = "one")]
    pub weight: f64,
    /// Its name; what it is of if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}

/// A condition that ends an episode.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Ending {
    /// An expression that is not 0 where the episode ends, such as `[distance] < 0.05`.
    pub when: String,
    /// What is paid then, besides the other terms.
    #[serde(default)]
    pub reward: f64,
    /// Its name; the condition if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}

/// A number of the case that differs from sample to sample.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Randomised {
    /// Its key, as for `--set`: `fluid.viscosity`.
    pub key: String,
    /// How it is distributed.
    pub law: Law,
}

/// A law of probability.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Law {
    /// From the first number to the second, all equally likely.
    Uniform([f64; 2]),
    /// The same of the logarithm.
    LogUniform([f64; 2]),
    /// Gaussian.
    Normal {
        /// Mean.
        mean: f64,
        /// Standard deviation.
        #[cfg_attr(test, schemars(with = "Positive"))]
        deviation: f64,
    },
}

fn one() -> f64 {
    1.0
}

impl Observation {
    /// It with scale and bounds.
    #[must_use]
    pub fn scaled(&self) -> ScaledObservation {
        match self {
            Self::Plain(of) => ScaledObservation { of: of.clone(), scale: 1.0, bounds: None },
            Self::Scaled(scaled) => scaled.clone(),
        }
    }
}

impl Action {
    /// The command.
    #[must_use]
    pub fn command(&self) -> &str {
        match self {
            Self::Plain(command) | Self::Ranged(RangedAction { command, .. }) => command,
        }
    }

    /// Its own range.
    #[must_use]
    pub fn range(&self) -> Option<[f64; 2]> {
        match self {
            Self::Plain(_) => None,
            Self::Ranged(ranged) => ranged.range,
        }
    }
}

impl RewardTerm {
    /// What it is called.
    #[must_use]
    pub fn shown(&self) -> &str {
        self.name.as_deref().unwrap_or(&self.of)
    }
}

impl Ending {
    /// What it is called.
    #[must_use]
    pub fn shown(&self) -> &str {
        self.name.as_deref().unwrap_or(&self.when)
    }
}

impl Law {
    /// A number of it, by two that are uniform in [0, 1).
    #[must_use]
    pub fn draw(&self, [first, second]: [f64; 2]) -> f64 {
        match *self {
            Self::Uniform([low, high]) => low + (high - low) * first,
            Self::LogUniform([low, high]) => low * (high / low).powf(first),
            // Of Box and Muller; 1 less a number in [0, 1) is never 0
            Self::Normal { mean, deviation } => {
                let radius = (-2.0 * (1.0 - first).ln()).sqrt();
                mean + deviation * radius * (std::f64::consts::TAU * second).cos()
            }
        }
    }
}

impl<'de> Deserialize<'de> for Observation {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Seen;

        impl<'de> Visitor<'de> for Seen {
            type Value = Observation;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a name or an expression, or { of = \"...\", scale = ... }")
            }

            fn visit_str<E: Error>(self, of: &str) -> Result<Observation, E> {
                Ok(Observation::Plain(of.to_owned()))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Observation, A::Error> {
                let table = ScaledObservation::deserialize(MapAccessDeserializer::new(map))?;
                Ok(Observation::Scaled(table))
            }
        }

        deserializer.deserialize_any(Seen)
    }
}

impl<'de> Deserialize<'de> for Action {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Done;

        impl<'de> Visitor<'de> for Done {
            type Value = Action;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("the name of a command, or { command = \"...\", range = [...] }")
            }

            fn visit_str<E: Error>(self, command: &str) -> Result<Action, E> {
                Ok(Action::Plain(command.to_owned()))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Action, A::Error> {
                Ok(Action::Ranged(RangedAction::deserialize(MapAccessDeserializer::new(map))?))
            }
        }

        deserializer.deserialize_any(Done)
    }
}
