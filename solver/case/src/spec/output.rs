//! `[output]` and `[[probe]]`: what is written, how often, and where the flow is measured.

use serde::{Deserialize, Serialize};

use crate::spec::fluid::tracer::SeedLine;
#[cfg(test)]
use crate::spec::number::{PerDimension, Positive};
use crate::text::wall_time::WallTime;
#[cfg(test)]
use std::num::NonZeroUsize;

/// How often something is written.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Cadence {
    /// Never.
    Never,
    /// Once, at the end of the run.
    End,
    /// Every so many steps (and at the end).
    Steps(#[cfg_attr(test, schemars(with = "NonZeroUsize"))] usize),
    /// At every multiple of this time (s) (and at the end).
    Time(#[cfg_attr(test, schemars(with = "Positive"))] f64),
}

/// Floating-point numbers in field files.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Precision {
    /// Four bytes.
    F32,
    /// Eight bytes.
    #[default]
    F64,
}

/// `[output]`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Velocity, pressure and vorticity as VTU files.
    #[serde(default = "at_end")]
    pub fields: Cadence,
    /// One row of `series.csv` and one message a body in `run.mcap`.
    #[serde(default = "every_step")]
    pub series: Cadence,
    /// Numbers in the field files.
    #[serde(default)]
    pub precision: Precision,
    /// Whether `series.csv` has the loads and fluxes of all sides; absent: in cases without bodies or with a given mesh,
    /// and in others those sides that a reference names.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sides: Option<bool>,
    /// States to resume from, written while a run is under way.
    #[serde(default)]
    pub checkpoint: Checkpoints,
}

/// `output.checkpoint`: how often a run writes its state, whichever comes first, and once at its end.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Checkpoints {
    /// Time on the clock on the wall between two of them.
    #[serde(default = "ten_minutes")]
    pub wall: WallTime,
    /// Time of the run between two of them (s).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub time: Option<f64>,
    /// How many are kept, the latest; 0 for none at all.
    #[serde(default = "two")]
    pub keep: usize,
}

impl Default for Checkpoints {
    fn default() -> Self {
        Self { wall: ten_minutes(), time: None, keep: two() }
    }
}

fn ten_minutes() -> WallTime {
    WallTime::from_seconds(600.0)
}

fn two() -> usize {
    2
}

impl Default for Output {
    fn default() -> Self {
        Self {
            fields: at_end(),
            series: every_step(),
            precision: Precision::default(),
            sides: None,
            checkpoint: Checkpoints::default(),
        }
    }
}

fn at_end() -> Cadence {
    Cadence::End
}

fn every_step() -> Cadence {
    Cadence::Steps(1)
}

/// `[[probe]]`: velocity and pressure at a point, or their difference between two points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Probe {
    /// Name, used in outputs and references.
    pub name: String,
    /// Where (m), one number per dimension; or `line`.
    #[cfg_attr(test, schemars(with = "Option<PerDimension>"))]
    pub point: Vec<f64>,
    /// Places of equal distance, one at each end: probes `NAME-1`, `NAME-2` and so on, which it becomes when the case is read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub line: Option<SeedLine>,
    /// The body it rides on, in whose frame its points are; those of the laboratory if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub body: Option<String>,
    /// A second point whose values are subtracted (m).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(test, schemars(with = "PerDimension"))]
    pub minus: Vec<f64>,
}
