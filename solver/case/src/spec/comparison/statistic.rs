//! `Statistic`: how a time series of a run becomes one number.

use serde::{Deserialize, Serialize};

/// How a time series becomes one number.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(rename = "Statistic"))]
#[serde(rename_all = "kebab-case")]
pub enum StatisticKind {
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

impl StatisticKind {
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

/// A number that is taken of a run.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Statistic {
    /// A column of `series.csv`, such as `cylinder.drag_coefficient`.
    pub quantity: String,
    /// A quantity subtracted from it first: `upper.y` minus `lower.y`.
    pub minus: Option<String>,
    /// How its time series becomes a number.
    pub kind: StatisticKind,
    /// Time of the kind `at` (s).
    pub at: Option<f64>,
    /// Value that the kind `crossing` waits for, in the quantity's unit; that of `of` for `when`.
    pub level: Option<f64>,
    /// The quantity the kind `when` waits for.
    pub of: Option<String>,
}

impl Statistic {
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
        let kind = match self.kind {
            StatisticKind::Final => return self.formula(),
            StatisticKind::At => format!("at{}", number(self.at)),
            StatisticKind::Crossing => format!("crossing{}", number(self.level)),
            StatisticKind::When => {
                let of = self.of.as_deref().unwrap_or_default();
                format!("when {of} ={}", number(self.level))
            }
            other => other.name().to_owned(),
        };
        format!("{} ({kind})", self.formula())
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
