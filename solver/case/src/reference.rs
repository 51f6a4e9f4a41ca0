//! `[[reference]]`, `[[variant]]`, `[scales]`, `[numbers]`, `[statistics]`: what a run is compared with.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// `[scales]`: what makes coefficients and numbers dimensionless.
///
/// Force coefficient c = 2 F / (density velocity^2 area), with area = length in planar cases.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Scales {
    /// Length (m).
    pub length: f64,
    /// Velocity (m/s).
    pub velocity: f64,
    /// Area of force coefficients (m2); `length` per unit width in planar cases, and
    /// pi length^2 / 4 in axisymmetric ones, if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
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

/// How a time series becomes one number.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Statistic {
    /// The last value.
    #[default]
    Final,
    /// The value at `at`, interpolated.
    At,
    /// Largest value in the window, refined by a parabola.
    Max,
    /// Smallest value in the window, refined by a parabola.
    Min,
    /// Time average over the window (over whole periods where the series is periodic).
    Mean,
    /// Root mean square over the window.
    Rms,
    /// Frequency times scales.length / scales.velocity, from mean crossings in the window.
    Strouhal,
    /// The value half a period after the largest value of `statistics.phase_of`.
    HalfPeriodAfterMax,
    /// The time in the window at which it first reaches `level`, from either side.
    Crossing,
    /// The value at the time in the window at which the quantity `of` first reaches `level`.
    When,
    /// Largest less smallest value in the window, both refined by a parabola.
    Range,
    /// Drag coefficient c_D of Morison's equation, fitted to a force over the window:
    /// F = -1/2 rho D c_D |v| v - rho (pi D^2/4) c_I dv/dt, with D = scales.length.
    MorisonDrag,
    /// Inertia coefficient c_I of the same fit.
    MorisonInertia,
}

impl Statistic {
    /// Name in the case file.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Final => "final",
            Self::At => "at",
            Self::Max => "max",
            Self::Min => "min",
            Self::Mean => "mean",
            Self::Rms => "rms",
            Self::Strouhal => "strouhal",
            Self::HalfPeriodAfterMax => "half-period-after-max",
            Self::Crossing => "crossing",
            Self::When => "when",
            Self::Range => "range",
            Self::MorisonDrag => "morison-drag",
            Self::MorisonInertia => "morison-inertia",
        }
    }
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
    /// What must hold whatever the numbers are: zero, symmetry, balance, an interval.
    Property,
    /// An earlier value of this program: shows that something has changed, not that it is right.
    Regression,
}

impl ReferenceKind {
    /// All of them, the strongest evidence first.
    pub const ALL: [Self; 6] = [
        Self::Measured,
        Self::Literature,
        Self::Exact,
        Self::Independent,
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
            Self::Property => "property",
            Self::Regression => "regression",
        }
    }

    /// What values of this kind are, in a few words.
    #[must_use]
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Measured => "published, of an experiment",
            Self::Literature => "published, of a computation by others",
            Self::Exact => "a formula or series, evaluated",
            Self::Independent => "computed with another method or code",
            Self::Property => "what must hold: zero, symmetry, balance, an interval",
            Self::Regression => "an earlier value of this program",
        }
    }
}

/// `[[reference]]`: a value to compare with, where it comes from and how near we should be.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Reference {
    /// What is compared: a column of `series.csv`, such as `cylinder.drag_coefficient`.
    pub quantity: String,
    /// A quantity subtracted from it first: `upper.y` minus `lower.y`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub minus: Option<String>,
    /// How its time series becomes a number.
    #[serde(default)]
    pub statistic: Statistic,
    /// Time of statistic `at` (s).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<f64>,
    /// Value that statistic `crossing` waits for, in the quantity's unit; that of `of` for `when`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub level: Option<f64>,
    /// The quantity statistic `when` waits for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub of: Option<String>,
    /// The value.
    pub value: f64,
    /// What the computed quantity is divided by before it is compared (say, 6 pi mu a U).
    #[serde(default = "one")]
    pub per: f64,
    /// Accepted difference relative to the value (1); this or `absolute`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub relative: Option<f64>,
    /// Accepted difference; this or `relative`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub absolute: Option<f64>,
    /// The value's own uncertainty, relative to it if the tolerance is `relative`; of a
    /// `regression`, what refinement of mesh and step changes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uncertainty: Option<f64>,
    /// What kind of evidence the value is.
    pub kind: ReferenceKind,
    /// Who published the value and where, or how it follows.
    pub source: String,
    /// Day on which a `regression` was computed: year-month-day.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub date: Option<String>,
    /// Why the computed value is known to be outside the tolerance; an error once it is within.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outside: Option<String>,
    /// What a reader should know: disagreements in words.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
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

impl Reference {
    /// What is compared, as a formula: `upper.y - lower.y`.
    #[must_use]
    pub fn formula(&self) -> String {
        match &self.minus {
            None => self.quantity.clone(),
            Some(minus) => format!("{} - {minus}", self.quantity),
        }
    }

    /// What is compared, with its statistic unless that is the final value.
    #[must_use]
    pub fn label(&self) -> String {
        let number = |value: Option<f64>| value.map_or(String::new(), |value| format!(" {value}"));
        let statistic = match self.statistic {
            Statistic::Final => return self.formula(),
            Statistic::At => format!("at{}", number(self.at)),
            Statistic::Crossing => format!("crossing{}", number(self.level)),
            Statistic::When => {
                let of = self.of.as_deref().unwrap_or_default();
                format!("when {of} ={}", number(self.level))
            }
            other => other.name().to_owned(),
        };
        format!("{} ({statistic})", self.formula())
    }

    /// The force that is compared: body `cylinder` and axis `x` for `cylinder.force.x`.
    #[must_use]
    pub fn force_of(&self) -> Option<ForceComponent<'_>> {
        let (owner, axis) = self.quantity.rsplit_once('.')?;
        let body = owner.strip_suffix(".force").or(owner.strip_suffix(".surface_force"))?;
        ["x", "y"].contains(&axis).then_some(ForceComponent { body, axis })
    }
}

/// A component of the force on a body, by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ForceComponent<'a> {
    /// The body.
    pub body: &'a str,
    /// `x` or `y`.
    pub axis: &'a str,
}

fn yes() -> bool {
    true
}

fn one() -> f64 {
    1.0
}
