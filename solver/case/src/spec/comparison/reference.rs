//! `[[reference]]`, `[[variant]]`, `[scales]`, `[numbers]`, `[statistics]`: what a run is compared with.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::uncertainty::Uncertainty;
#[cfg(test)]
use crate::spec::number::{NonZero, Positive};
use crate::{Statistic, StatisticKind};

/// `[scales]`: what makes coefficients and numbers dimensionless.
///
/// Force coefficient c = 2 F / (density velocity^2 area), with area = length in planar cases.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Scales {
    /// Length (m).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub length: f64,
    /// Velocity (m/s).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub velocity: f64,
    /// Area of force coefficients (m2); `length` per unit width in planar cases, and
    /// pi length^2 / 4 in axisymmetric ones, if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub area: Option<f64>,
}

/// `[numbers]`: dimensionless numbers the author expects.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Numbers {
    /// density * scales.velocity * scales.length / viscosity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reynolds: Option<f64>,
    /// Density of the first body over that of the fluid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density_ratio: Option<f64>,
}

/// `[statistics]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Statistics {
    /// Start and end of the window (s); the whole run if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub window: Option<[f64; 2]>,
    /// Whether `mean` and `rms` of a periodic series are over whole periods, else over all of the
    /// window.
    #[serde(default = "yes")]
    pub whole_periods: bool,
    /// The quantity whose largest value starts a period.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub phase_of: Option<String>,
}

impl Default for Statistics {
    fn default() -> Self {
        Self { window: None, whole_periods: true, phase_of: None }
    }
}

/// What kind of evidence a reference is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum ReferenceKind {
    /// Measured in an experiment, and published.
    Measured,
    /// Computed by others, and published.
    Literature,
    /// A formula or a series, evaluated.
    Exact,
    /// Computed by another method or code.
    Independent,
    /// An asymptote, a truncated series or a reduced theory such as that of slender bodies: off by what it
    /// leaves out.
    Approximate,
    /// Computed by this program in another geometry, frame or dimension: shows that two ways agree.
    Internal,
    /// What must hold whatever the numbers are: zero, symmetry, balance, an interval.
    Property,
    /// An earlier value of this program: shows that something has changed, not that it is right.
    Regression,
}

impl ReferenceKind {
    /// All of them, the strongest evidence first.
    pub const ALL: [Self; 8] = [
        Self::Measured,
        Self::Literature,
        Self::Exact,
        Self::Independent,
        Self::Approximate,
        Self::Internal,
        Self::Property,
        Self::Regression,
    ];

    /// Name in the case file.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Measured => "measured",
            Self::Literature => "literature",
            Self::Exact => "exact",
            Self::Independent => "independent",
            Self::Approximate => "approximate",
            Self::Internal => "internal",
            Self::Property => "property",
            Self::Regression => "regression",
        }
    }

    /// Whether such a value is evidence that a computed one is right, and not a condition it has to meet or
    /// what the program gave before.
    #[must_use]
    pub fn is_evidence(self) -> bool {
        !matches!(self, Self::Property | Self::Regression)
    }

    /// What values of this kind are, in a few words.
    #[must_use]
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Measured => "published, of an experiment",
            Self::Literature => "published, of a computation by others",
            Self::Exact => "a formula or series, evaluated",
            Self::Independent => "computed with another method or code",
            Self::Approximate => "an asymptote or a reduced theory, evaluated",
            Self::Internal => "this program in another geometry, frame or dimension",
            Self::Property => "what must hold: zero, symmetry, balance, an interval",
            Self::Regression => "an earlier value of this program",
        }
    }
}

/// `[[reference]]`: a value to compare with, where it comes from and how near we should be.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(from = "WrittenReference", into = "WrittenReference")]
pub struct Reference {
    /// What is compared.
    pub statistic: Statistic,
    /// What it is compared with.
    pub expected: Expected,
}

/// A value that a statistic should have, and where it comes from.
#[derive(Debug, Clone, PartialEq)]
pub struct Expected {
    /// The value.
    pub value: f64,
    /// What the computed quantity is divided by before it is compared.
    pub per: f64,
    /// Accepted difference relative to the value (1); this or `absolute`.
    pub relative: Option<f64>,
    /// Accepted difference; this or `relative`.
    pub absolute: Option<f64>,
    /// The value's own uncertainty.
    pub uncertainty: Option<Uncertainty>,
    /// What kind of evidence the value is.
    pub kind: ReferenceKind,
    /// Who published the value and where, or how it follows.
    pub source: String,
    /// Day on which a `regression` was computed: year-month-day.
    pub date: Option<String>,
    /// Why the computed value is known to be outside the tolerance.
    pub outside: Option<String>,
    /// Why the computed value differs by more than is uncertain in both.
    pub cause: Option<String>,
    /// What a reader should know: disagreements in words.
    pub note: Option<String>,
}

/// A reference as it is written: its keys in one table, or one row.
#[derive(Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename = "Reference", deny_unknown_fields)]
struct WrittenReference {
    /// What is compared: a column of `series.csv`, such as `cylinder.drag_coefficient`.
    quantity: String,
    /// A quantity subtracted from it first: `upper.y` minus `lower.y`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    minus: Option<String>,
    /// How its time series becomes a number.
    #[serde(default)]
    statistic: StatisticKind,
    /// Time of statistic `at` (s).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    at: Option<f64>,
    /// Value that statistic `crossing` waits for, in the quantity's unit; that of `of` for `when`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    level: Option<f64>,
    /// The quantity statistic `when` waits for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    of: Option<String>,
    /// The value.
    value: f64,
    /// What the computed quantity is divided by before it is compared (say, 6 pi mu a U).
    #[serde(default = "one")]
    #[cfg_attr(test, schemars(with = "NonZero"))]
    per: f64,
    /// Accepted difference relative to the value (1); this or `absolute`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    relative: Option<f64>,
    /// Accepted difference; this or `relative`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    absolute: Option<f64>,
    /// The value's own uncertainty: a text such as "0.5 %" of the value, or beside `absolute` a number in
    /// its unit; of a `regression`, what refinement of mesh and step changes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    uncertainty: Option<Uncertainty>,
    /// What kind of evidence the value is.
    kind: ReferenceKind,
    /// Who published the value and where, or how it follows.
    source: String,
    /// Day on which a `regression` was computed: year-month-day.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    date: Option<String>,
    /// Why the computed value is known to be outside the tolerance; an error once it is within.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    outside: Option<String>,
    /// Why the computed value, though within the tolerance, differs by more than is uncertain in both.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    cause: Option<String>,
    /// What a reader should know: disagreements in words.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    note: Option<String>,
}

impl From<WrittenReference> for Reference {
    fn from(written: WrittenReference) -> Self {
        Self {
            statistic: Statistic {
                quantity: written.quantity,
                minus: written.minus,
                kind: written.statistic,
                at: written.at,
                level: written.level,
                of: written.of,
            },
            expected: Expected {
                value: written.value,
                per: written.per,
                relative: written.relative,
                absolute: written.absolute,
                uncertainty: written.uncertainty,
                kind: written.kind,
                source: written.source,
                date: written.date,
                outside: written.outside,
                cause: written.cause,
                note: written.note,
            },
        }
    }
}

impl From<Reference> for WrittenReference {
    fn from(Reference { statistic, expected }: Reference) -> Self {
        Self {
            quantity: statistic.quantity,
            minus: statistic.minus,
            statistic: statistic.kind,
            at: statistic.at,
            level: statistic.level,
            of: statistic.of,
            value: expected.value,
            per: expected.per,
            relative: expected.relative,
            absolute: expected.absolute,
            uncertainty: expected.uncertainty,
            kind: expected.kind,
            source: expected.source,
            date: expected.date,
            outside: expected.outside,
            cause: expected.cause,
            note: expected.note,
        }
    }
}

/// `[[variant]]`: the same case with some keys set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Variant {
    /// Name; `alewife run CASE/NAME` runs it.
    pub name: String,
    /// Keys to set, written as on the command line: `"body.0.center" = [2.0, 0.0]`.
    #[serde(default)]
    #[cfg_attr(test, schemars(with = "BTreeMap<String, serde_json::Value>"))]
    pub set: BTreeMap<String, toml::Value>,
    /// Whether `alewife validate --quick` runs it.
    #[serde(default)]
    pub quick: bool,
    /// Its references, besides those of the case.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub reference: Vec<Reference>,
}

fn yes() -> bool {
    true
}

fn one() -> f64 {
    1.0
}
