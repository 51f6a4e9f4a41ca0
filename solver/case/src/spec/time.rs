//! `[time]`: a steady solution, or time steps.

#[cfg(test)]
use crate::spec::number::{Fraction, Positive};
use alewife_mesh::whole;
use serde::{Deserialize, Deserializer, Serialize};
#[cfg(test)]
use std::num::NonZeroUsize;

/// `[time.steady]` or `[time.unsteady]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum TimeSettings {
    /// Steady flow, or the instantaneous flow of the `stokes` model.
    Steady(Steady),
    /// An unsteady run, by time steps.
    Unsteady(#[serde(deserialize_with = "with_steps")] Unsteady),
}

/// `[time.steady]`: Newton's method, with continuation in the Reynolds number when it stalls.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Steady {
    /// Largest residual relative to the first one (1).
    #[serde(default = "default_tolerance")]
    #[cfg_attr(test, schemars(with = "Fraction"))]
    pub tolerance: f64,
    /// Most Newton iterations for one Reynolds number.
    #[serde(default = "default_iterations")]
    #[cfg_attr(test, schemars(with = "NonZeroUsize"))]
    pub max_iterations: usize,
}

/// `[time.unsteady]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Unsteady {
    /// Step (s); the first one where steps are adaptive, which they are where it is absent: it is a thousandth of the
    /// run then.
    #[serde(default = "no_step")]
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub step: f64,
    /// End (s).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub end: f64,
    /// Scheme.
    #[serde(default)]
    pub scheme: Scheme,
    /// Treatment of the convection, and of a viscosity that depends on the rate of shear.
    #[serde(default)]
    pub convection: Convection,
    /// Where the run starts.
    #[serde(default)]
    pub initial: Initial,
    /// Steps chosen by the error they make; fixed steps if absent beside `step`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub adaptive: Option<Adaptive>,
    /// What ends the run before `end`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub until: Option<Until>,
}

/// What ends a run before its end: bodies that come to a side through which fluid leaves freely
/// (`do-nothing`, `traction-free`).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Until {
    /// One of them is nearer to such a side than this (m).
    OneLeaves(#[cfg_attr(test, schemars(with = "Positive"))] f64),
    /// All of them are at once.
    AllLeave(#[cfg_attr(test, schemars(with = "Positive"))] f64),
}

impl Until {
    /// Distance from a side (m) at which a body leaves.
    #[must_use]
    pub fn distance(&self) -> f64 {
        let (Self::OneLeaves(distance) | Self::AllLeave(distance)) = self;
        *distance
    }

    /// Its key in `[time.unsteady]`.
    #[must_use]
    pub fn key(&self) -> &'static str {
        match self {
            Self::OneLeaves(_) => "until.one-leaves",
            Self::AllLeave(_) => "until.all-leave",
        }
    }
}

impl Unsteady {
    /// Number of whole fixed steps up to a time (s).
    #[must_use]
    pub fn n_steps_to(&self, time: f64) -> usize {
        whole(time / self.step + 1e-9)
    }

    /// Number of fixed steps to the end; rounding of their ratio makes no step more.
    #[must_use]
    pub fn n_steps(&self) -> usize {
        whole((self.end / self.step - 1e-9).ceil()).max(1)
    }
}

/// `[time.unsteady.adaptive]`: steps as long as the error of a step, the mesh and the gaps allow.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Adaptive {
    /// Largest error of one step, relative to the size of the velocities (1).
    #[serde(default = "default_step_tolerance")]
    #[cfg_attr(test, schemars(with = "Fraction"))]
    pub tolerance: f64,
    /// Largest step (s); a tenth of the run if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub largest: Option<f64>,
    /// Smallest step (s), below which the run fails; a millionth of `step` if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub smallest: Option<f64>,
    /// Cells the fluid may cross in a step (1).
    #[serde(default = "default_cfl")]
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub cfl: f64,
    /// Part of a gap that may close or open in a step (1).
    #[serde(default = "default_gap_part")]
    #[cfg_attr(test, schemars(with = "Fraction"))]
    pub gap: f64,
}

impl Default for Adaptive {
    fn default() -> Self {
        Self {
            tolerance: default_step_tolerance(),
            largest: None,
            smallest: None,
            cfl: default_cfl(),
            gap: default_gap_part(),
        }
    }
}

/// Time scheme.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Scheme {
    /// Backward Euler.
    Bdf1,
    /// Second-order backward differences.
    #[default]
    Bdf2,
    /// Explicit Runge-Kutta method of third order; `stokes` without springs and stiff hinges.
    Rk3,
}

/// Treatment of the convection within a step, and of a viscosity that depends on the rate of shear.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Convection {
    /// Extrapolated to the new time: one linear system a step.
    #[default]
    Extrapolated,
    /// Solved by Newton's method.
    Newton,
}

impl Convection {
    /// CFL number up to which extrapolated convection was found to agree with Newton's method
    /// (docs/method.md, section 6).
    pub const LARGEST_CFL: f64 = 5.0;
}

/// The state at time zero.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Initial {
    /// Fluid and bodies at rest.
    #[default]
    Rest,
    /// The Stokes flow of the boundary values at time zero.
    Stokes,
}

/// A run without a step takes steps by their error.
fn with_steps<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Unsteady, D::Error> {
    let mut unsteady = Unsteady::deserialize(deserializer)?;
    if unsteady.step.is_nan() {
        unsteady.step = FIRST_STEP * unsteady.end;
        unsteady.adaptive.get_or_insert_default();
    }
    Ok(unsteady)
}

/// The first step, over the time of the run.
const FIRST_STEP: f64 = 1e-3;

/// Stands for a step that is absent until the end is known.
fn no_step() -> f64 {
    f64::NAN
}

fn default_step_tolerance() -> f64 {
    1e-3
}

fn default_cfl() -> f64 {
    4.0
}

fn default_gap_part() -> f64 {
    0.3
}

fn default_tolerance() -> f64 {
    1e-11
}

fn default_iterations() -> usize {
    25
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Case;

    /// The settings of a case whose table has these keys.
    fn unsteady(keys: &str) -> Unsteady {
        let text = format!(
            "title = 't'
geometry = 'planar'
fluid = {{ model = 'stokes', viscosity = 1.0 }}
domain.channel = {{ length = 8.0, height = 4.0 }}
boundary = {{ left.parabolic.peak = 1.0, right = 'do-nothing', bottom = 'no-slip', top = 'no-slip' }}
mesh = {{ size = 0.3 }}
time.unsteady = {{ {keys} }}
body = [{{ name = 'b', shape.disc.radius = 0.5, center = [2.0, 2.0], motion = 'held' }}]
"
        );
        let file = Case::parse("t.toml", &text, &[]).unwrap();
        match &file.case().time {
            TimeSettings::Unsteady(unsteady) => unsteady.clone(),
            TimeSettings::Steady(_) => panic!("it is unsteady"),
        }
    }

    #[test]
    fn steps_are_adaptive_where_none_is_given() {
        let own = unsteady("end = 2.0");
        assert_eq!((own.step, own.adaptive), (2e-3, Some(Adaptive::default())));
        let own = unsteady("end = 2.0, adaptive.tolerance = 1e-4");
        assert_eq!(own.adaptive.map(|adaptive| adaptive.tolerance), Some(1e-4));
        let own = unsteady("end = 2.0, step = 0.1");
        assert_eq!((own.step, own.adaptive), (0.1, None));
    }
}
