//! `[calibration]`, `[optimisation]` and `[robot]`: which numbers are sought, and for what.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

#[cfg(test)]
use crate::spec::number::{NonNegative, Positive};
pub use crate::spec::optimisation::SearchSettings;

/// `[calibration]`: numbers that make the markers move as recorded.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Calibration {
    /// The numbers.
    pub parameter: Vec<Parameter>,
    /// How the search ends.
    #[serde(default)]
    pub search: SearchSettings,
}

/// `[optimisation]`: numbers that make an objective large.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Optimisation {
    /// What is made large.
    pub objective: ObjectiveSpec,
    /// The numbers.
    pub parameter: Vec<Parameter>,
    /// How the search ends.
    #[serde(default)]
    pub search: SearchSettings,
}

/// What an optimisation makes large.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum ObjectiveSpec {
    /// The way of the markers on average along a direction (m), less what its work costs.
    Travel {
        /// The direction.
        direction: Vec<f64>,
        /// The way that a unit of work costs (m/J).
        #[serde(default)]
        #[cfg_attr(test, schemars(with = "NonNegative"))]
        cost_of_work: f64,
        /// Time (s) from which on way and work count, as means that are tapered to both ends: the way from there on is
        /// the mean velocity times the time that is left. All of the motion counts alike if absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[cfg_attr(test, schemars(with = "Option<NonNegative>"))]
        after: Option<f64>,
    },
    /// That way over the work that the commands put into the fibres (m/J).
    WayPerWork {
        /// The direction.
        direction: Vec<f64>,
        /// Power (W) that is spent whatever the body does: its work is added to that of the commands.
        #[serde(default)]
        #[cfg_attr(test, schemars(with = "NonNegative"))]
        standing_power: f64,
        /// Time (s) from which on way and work count, as in `travel`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[cfg_attr(test, schemars(with = "Option<NonNegative>"))]
        after: Option<f64>,
    },
}

impl ObjectiveSpec {
    /// The direction of the way.
    #[must_use]
    pub fn direction(&self) -> &[f64] {
        match self {
            Self::Travel { direction, .. } | Self::WayPerWork { direction, .. } => direction,
        }
    }

    /// The time (s) from which on way and work count.
    #[must_use]
    pub fn after(&self) -> Option<f64> {
        match self {
            Self::Travel { after, .. } | Self::WayPerWork { after, .. } => *after,
        }
    }

    /// What each of so many frames (s) counts in way and work: 1, or from a time on its share in means that are tapered to
    /// both ends, by the square of a sine, times the number of frames from then on. Such means of a motion that repeats
    /// itself hardly depend on the phase at which they begin and end.
    #[must_use]
    pub fn shares(&self, n_frames: usize, frame: f64) -> Vec<f64> {
        let Some(after) = self.after() else { return vec![1.0; n_frames] };
        let left = n_frames as f64 * frame - after;
        let share = |number: usize| {
            let part = ((number as f64 + 0.5) * frame - after) / left;
            if part > 0.0 { (std::f64::consts::PI * part).sin().powi(2) } else { 0.0 }
        };
        let shares: Vec<f64> = (0..n_frames).map(share).collect();
        let factor = left / frame / shares.iter().sum::<f64>();
        shares.into_iter().map(|share| factor * share).collect()
    }
}

/// `parameter`: a number of the case, or several that are one, which a search finds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Parameter {
    /// Its name, in messages and reports.
    pub name: String,
    /// Keys of the case that have its value, such as `solid.0.material.young`. One key of a list, such as
    /// `solid.0.fibre.0.stretch.frames`, stands for one parameter an entry.
    #[cfg_attr(test, schemars(length(min = 1)))]
    pub keys: Vec<String>,
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

/// `[robot]`: the case with other numbers, which stands for the robot.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Robot {
    /// Numbers of the case that differ, by their keys.
    pub set: BTreeMap<String, f64>,
}
