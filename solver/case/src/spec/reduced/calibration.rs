//! `[calibration]`: which coefficients of a reduced model are found, and from which runs or records.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::FlowParameter;
#[cfg(test)]
use crate::spec::number::Positive;

/// `[calibration]`: coefficients of `[reduced]` that make it do as runs of the full solver, or as what was recorded.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct CalibrationSpec {
    /// Names of the coefficients that are found, the same for all bodies, or for one body, which is `NAME.slender` then;
    /// others stay as they are.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub fit: Vec<String>,
    /// Other numbers of the case that are found, in a fit to tracks of CSV files.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub parameter: Vec<FlowParameter>,
    /// Smallest and largest value of each by its name; 0 and 1000 if absent. The value in `[reduced]`, where a fit to
    /// tracks starts, is between them.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub bounds: BTreeMap<String, [f64; 2]>,
    /// What is fitted; loads if absent, and tracks where anything is from a CSV file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub by: Option<FitBy>,
    /// Tracks of runs that are fitted: `NAME.x`, `.y`, `.z` or `.angle` of bodies; those of the first body if absent.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tracks: Vec<String>,
    /// Part of each value that central differences go to either side in a fit to tracks, in place of exact derivatives:
    /// for long motions that forget how they began, along which exact derivatives grow without end, and for numbers of
    /// the case.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub differences: Option<f64>,
    /// Runs and records.
    #[cfg_attr(test, schemars(length(min = 1)))]
    pub from: Vec<RecordSpec>,
    /// A search by proposals, in place of steps by derivatives.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub search: Option<ProposalSpec>,
}

/// `calibration.search`: points are proposed, and on the way to each a better one is looked for.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ProposalSpec {
    /// What proposes.
    pub proposer: Proposer,
    /// Motions at most, those on the way to proposals included.
    #[serde(default = "evaluations")]
    #[cfg_attr(test, schemars(range(min = 1)))]
    pub evaluations: usize,
    /// How often the way to a proposal is halved before it is given up; 4 if absent, and 0 for proposals alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(range(max = 20)))]
    pub halvings: Option<u8>,
    /// Seed of `random` and `cma-es`; 0 if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
    /// The program of `external` and its arguments, run in the directory of the case.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub command: Vec<String>,
}

fn evaluations() -> usize {
    500
}

/// `proposer`: one of these.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Proposer {
    /// Any direction from the best point, as far as half of what lies between the bounds.
    Random,
    /// The simplex of Nelder and Mead, within the bounds.
    NelderMead,
    /// Covariance matrix adaptation (Hansen and Ostermeier), within the bounds.
    CmaEs,
    /// A program, which reads JSON and writes JSON, once for each point.
    External,
}

impl Proposer {
    /// Its name in a case.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Random => "random",
            Self::NelderMead => "nelder-mead",
            Self::CmaEs => "cma-es",
            Self::External => "external",
        }
    }
}

/// `by`: one of these.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum FitBy {
    /// Loads on bodies that move as in the runs, by bounded least squares.
    Loads,
    /// Ways and angles of bodies, by the method of Gauss and Newton with exact derivatives, or by `differences`.
    Tracks,
    /// Both, of runs: mean squares of loads over their size and of tracks over theirs, each as much as the other.
    Both,
}

/// `[[calibration.from]]`: a run, runs in a directory, or a record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct RecordSpec {
    /// Directory of a run of the full solver, or one with such directories in it, as a sweep makes it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub run: Option<String>,
    /// CSV file with a header.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub csv: Option<String>,
    /// Whether it is not fitted, and only compared with.
    #[serde(default)]
    pub holdout: bool,
    /// Column of the times (s) of a CSV file, rising.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time: Option<String>,
    /// Rows a second of a CSV file without times, the first at time 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub rate: Option<f64>,
    /// Time of the model (s) at which a CSV file begins, such as when it swims steadily; ways and angles count from the first
    /// row then, of the model and of the record.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub start: Option<f64>,
    /// Columns of a CSV file by the quantities they have: `NAME.x`, `.y`, `.z` or `.angle` of bodies.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub columns: BTreeMap<String, String>,
    /// What columns are multiplied by, by their quantities, to be in the units of the case.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub units: BTreeMap<String, f64>,
    /// Where the frame of a planar record is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frame: Option<RecordFrame>,
    /// Keys of the case that are other for a record, as `--set` has them: "KEY=VALUE".
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub set: Vec<String>,
}

/// `frame`: the frame in which a record was made, in that of the case, after units.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct RecordFrame {
    /// Its origin (m).
    #[serde(default)]
    pub origin: [f64; 2],
    /// How its axes are turned, counter-clockwise (rad).
    #[serde(default, deserialize_with = "crate::text::angle::deserialize")]
    #[cfg_attr(test, schemars(with = "crate::text::angle::Angle"))]
    pub angle: f64,
}

/// What an entry of `fit` names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FitName<'a> {
    /// The body whose own it is; that of all bodies if absent.
    pub body: Option<&'a str>,
    /// The coefficient.
    pub coefficient: &'a str,
}

impl<'a> FitName<'a> {
    /// Of `NAME.coefficient` or a coefficient.
    #[must_use]
    pub fn new(name: &'a str) -> Self {
        match name.rsplit_once('.') {
            Some((body, coefficient)) => Self { body: Some(body), coefficient },
            None => Self { body: None, coefficient: name },
        }
    }
}

impl CalibrationSpec {
    /// What is fitted.
    #[must_use]
    pub fn fits(&self) -> FitBy {
        let has_record = self.from.iter().any(|one| one.csv.is_some() && !one.holdout);
        self.by.unwrap_or(if has_record { FitBy::Tracks } else { FitBy::Loads })
    }

    /// Bounds of a coefficient.
    #[must_use]
    pub fn bounds_of(&self, name: &str) -> [f64; 2] {
        self.bounds.get(name).copied().unwrap_or([0.0, 1000.0])
    }
}
