//! `MotionsByAxis`: a body some of whose motions are given in time while others are free or held.

use serde::{Deserialize, Serialize};

use super::lock::Lock;
use crate::spec::body::stroke::Stroke;
#[cfg(test)]
use crate::spec::number::Direction;
use crate::spec::time_function::TimeFunction;

/// Each motion in its own way; what is left out is held.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct MotionsByAxis {
    /// Along x.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub x: Option<AxisMotion>,
    /// Along y.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(extend("geometries" = ["planar", "spatial"])))]
    pub y: Option<AxisMotion>,
    /// Along z.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(extend("geometries" = ["spatial"])))]
    pub z: Option<AxisMotion>,
    /// Turning: counter-clockwise in planar cases, in space about `axis` where it is given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(extend("geometries" = ["planar", "spatial"])))]
    pub rotation: Option<TurningMotion>,
    /// In three dimensions, the axis in the laboratory of a rotation that is given, of any length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Direction>", extend("geometries" = ["spatial"])))]
    pub axis: Option<[f64; 3]>,
}

/// How a body moves along an axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum AxisMotion {
    /// It obeys Newton's law.
    Free,
    /// It does not move.
    Held,
    /// It goes as this length does (m), from where it starts.
    Imposed(Stroke),
    /// Its velocity is given.
    Velocity(GivenRate),
}

/// How a body turns.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum TurningMotion {
    /// It obeys Euler's law.
    Free,
    /// It does not turn.
    Held,
    /// It turns as this angle does (rad), from how it starts.
    Imposed(#[serde(deserialize_with = "crate::text::angle::deserialize")] Stroke),
    /// Its angular velocity is given.
    Velocity(GivenRate),
}

/// A velocity that is given in time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct GivenRate {
    /// Velocity (m/s), or angular velocity (rad/s).
    pub value: f64,
    /// Factor in time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub factor: Option<TimeFunction>,
}

/// A motion of a body whose rate is given.
#[derive(Debug, Clone, PartialEq)]
pub struct Driven {
    /// Which it is.
    pub motion: Lock,
    /// The axis in the laboratory of a rotation in space, of any length.
    pub axis: [f64; 3],
    /// Its rate.
    pub law: DrivenLaw,
}

/// The rate of a motion that is given.
#[derive(Debug, Clone, PartialEq)]
pub enum DrivenLaw {
    /// That of a length (m) or angle (rad).
    Way(Stroke),
    /// Given itself.
    Rate(GivenRate),
}

impl DrivenLaw {
    /// Rate at a time (s): m/s or rad/s.
    #[must_use]
    pub fn rate(&self, time: f64) -> f64 {
        match self {
            Self::Way(stroke) => stroke.at(time)[1],
            Self::Rate(GivenRate { value, factor }) => {
                value * factor.as_ref().map_or(1.0, |factor| factor.at(time))
            }
        }
    }
}

impl MotionsByAxis {
    /// What is said of each motion.
    pub(crate) fn all(&self) -> Vec<SaidOf<'_>> {
        let turning = match &self.rotation {
            Some(TurningMotion::Free) => Said::Free,
            None | Some(TurningMotion::Held) => Said::Held,
            Some(TurningMotion::Imposed(stroke)) => Said::Way(stroke),
            Some(TurningMotion::Velocity(rate)) => Said::Rate(rate),
        };
        let along = |motion: Lock, said| SaidOf { motion, said };
        vec![
            along(Lock::X, Said::of_axis(&self.x)),
            along(Lock::Y, Said::of_axis(&self.y)),
            along(Lock::Z, Said::of_axis(&self.z)),
            along(Lock::Rotation, turning),
        ]
    }
}

/// A motion with what is said of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SaidOf<'a> {
    pub motion: Lock,
    pub said: Said<'a>,
}

/// What is said of a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Said<'a> {
    Free,
    Held,
    Way(&'a Stroke),
    Rate(&'a GivenRate),
}

impl<'a> Said<'a> {
    fn of_axis(motion: &'a Option<AxisMotion>) -> Self {
        match motion {
            Some(AxisMotion::Free) => Self::Free,
            None | Some(AxisMotion::Held) => Self::Held,
            Some(AxisMotion::Imposed(stroke)) => Self::Way(stroke),
            Some(AxisMotion::Velocity(rate)) => Self::Rate(rate),
        }
    }
}

/// What motions by axis amount to: a body that is free but for motions that are locked, or locked and driven.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Settled {
    /// Whether any motion is free or driven.
    pub moves: bool,
    /// All motions that are not free.
    pub locked: Vec<Lock>,
    /// Those of them whose rate is given.
    pub driven: Vec<Driven>,
}

impl MotionsByAxis {
    /// What they amount to.
    pub(crate) fn settled(&self) -> Settled {
        let axis = self.axis.unwrap_or([0.0, 0.0, 1.0]);
        let mut settled = Settled { moves: false, locked: Vec::new(), driven: Vec::new() };
        for SaidOf { motion, said } in self.all() {
            let law = match said {
                Said::Free => {
                    settled.moves = true;
                    continue;
                }
                Said::Held => None,
                Said::Way(stroke) => Some(DrivenLaw::Way(stroke.clone())),
                Said::Rate(rate) => Some(DrivenLaw::Rate(rate.clone())),
            };
            settled.moves |= law.is_some();
            settled.locked.push(motion);
            settled.driven.extend(law.map(|law| Driven { motion, axis, law }));
        }
        settled
    }
}
