//! `shape` and `gait` of swimmers that deform: fish, flagellates, and bodies that pulsate.

use alewife_mesh::{Profile, TubeForm};
use serde::{Deserialize, Serialize};

use super::stroke::Stroke;
#[cfg(test)]
use crate::spec::number::{BelowOne, NonNegative, Positive};

/// `shape.fish`: straight along the body's x, head towards +x, origin in the centre of area.
///
/// All lengths but the first are over the length.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct FishShape {
    /// Length (m), up to the point in which the sides of the tail would meet.
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub length: f64,
    /// Radius of the round head.
    #[serde(default = "head_width")]
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub head_width: f64,
    /// Half width where the sides begin to close.
    #[serde(default = "tail_width")]
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub tail_width: f64,
    /// Where the round head ends; at most `head_width`.
    #[serde(default = "head_end")]
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub head_end: f64,
    /// Where the sides begin to close.
    #[serde(default = "tail_start")]
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub tail_start: f64,
    /// Radius of the round end inscribed in the tail.
    #[serde(default = "tip_radius")]
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub tip_radius: f64,
    /// Radius with which the corner at `tail_start` is rounded.
    #[serde(default = "corner_radius")]
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub corner_radius: f64,
    /// Half height in the middle, of half an ellipse from head to tail (spatial); circles if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>", extend("geometries" = ["spatial"])))]
    pub height: Option<f64>,
}

/// `shape.flagellate`: straight along the body's x, head towards +x, origin in the centre of area.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct FlagellateShape {
    /// Semi-axes of the elliptic head, along the body and across it (m).
    #[cfg_attr(test, schemars(with = "[Positive; 2]"))]
    pub head: [f64; 2],
    /// Length of the tail from the end of the head on (m).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub tail_length: f64,
    /// Width of the tail, which has a round end (m).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub thickness: f64,
    /// Radius with which the corner of head and tail is filled (m); the thickness if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub fillet: Option<f64>,
}

/// `gait.carangiform`: a wave of curvature K(s) (beat sin(2 pi (t/T + phase - s/L)) + bending + bend).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct CarangiformGait {
    /// Period T (s).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub period: f64,
    /// [s/L, K L], from s/L = 0 to 1, joined by a natural cubic spline.
    #[serde(default = "curvature")]
    pub curvature: Vec<[f64; 2]>,
    /// Constant part of the bracket: steers.
    #[serde(default)]
    pub bending: f64,
    /// Factor of the wave in time; 1 if absent. Its rate must not jump.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub beat: Option<Stroke>,
    /// What is added to the bracket in time, without the ramp: steers. Its rate must not jump; 0 if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bend: Option<Stroke>,
    /// Duration of the ramp at the start (s); a period if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<NonNegative>"))]
    pub ramp: Option<f64>,
    /// Phase at the start (periods).
    #[serde(default)]
    pub phase: f64,
}

/// `gait.anguilliform`: a wave amplitude (s + offset L) sin(2 pi (s/L - t/T - phase)).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct AnguilliformGait {
    /// Period T (s).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub period: f64,
    /// Slope of the envelope.
    #[serde(default = "anguilliform_amplitude")]
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub amplitude: f64,
    /// Where the envelope is zero, before the head, over the length.
    #[serde(default = "anguilliform_offset")]
    #[cfg_attr(test, schemars(with = "NonNegative"))]
    pub offset: f64,
    /// Duration of the ramp at the start (s); a period if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<NonNegative>"))]
    pub ramp: Option<f64>,
    /// Phase at the start (periods).
    #[serde(default)]
    pub phase: f64,
}

/// `gait.flagellum`: a wave along the tail, with an amplitude that grows with the distance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct FlagellumGait {
    /// Period (s).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub period: f64,
    /// Wavelength (m).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub wavelength: f64,
    /// Amplitude at the end of the tail (m).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub amplitude: f64,
    /// Time constant of the ramp 1 - exp(-t / ramp) (s); a period if absent, 0 for none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<NonNegative>"))]
    pub ramp: Option<f64>,
    /// Phase at the start (periods).
    #[serde(default)]
    pub phase: f64,
    /// Length over which the tail begins to bend (m); a twentieth of the tail if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub joint: Option<f64>,
    /// Whether the midline keeps its length; otherwise its velocities are prescribed.
    #[serde(default = "yes")]
    pub inextensible: bool,
}

/// `gait.pulsating`: a round body whose area (planar) or volume is a function of time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct PulsatingGait {
    /// Area or volume over that at rest is 1 + amplitude sin(2 pi (t / period + phase)).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<BelowOne>"))]
    pub amplitude: Option<f64>,
    /// Period (s); a table without it is not repeated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub period: Option<f64>,
    /// Phase at the start (periods), with `amplitude`.
    #[serde(default)]
    pub phase: f64,
    /// [time (s), area or volume over that at rest], joined by straight lines.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub table: Vec<[f64; 2]>,
}

/// The outline of a chain with a skin, straight along the body's x.
#[derive(Debug, Clone, PartialEq)]
pub struct TubeShape {
    /// [distance from the head, half width] in the middle of each link (m).
    pub sections: Vec<[f64; 2]>,
    /// Length (m).
    pub length: f64,
    /// Longest distance between material points (m).
    pub spacing: f64,
}

/// How a chain with a skin bends.
#[derive(Debug, Clone, PartialEq)]
pub struct JointsGait {
    /// From the head on.
    pub joints: Vec<BentJoint>,
    /// Length of midline over which each of them bends (m).
    pub rounding: f64,
}

/// A pivot inside a skin.
#[derive(Debug, Clone, PartialEq)]
pub struct BentJoint {
    /// Distance from the head (m).
    pub along: f64,
    /// Angle of the link farther from the root less that of the nearer one (rad).
    pub angle: Stroke,
    /// Whether it is behind the root.
    pub is_behind_root: bool,
}

impl CarangiformGait {
    /// Duration of the ramp at the start (s).
    #[must_use]
    pub fn ramp(&self) -> f64 {
        self.ramp.unwrap_or(self.period)
    }
}

impl AnguilliformGait {
    /// Duration of the ramp at the start (s).
    #[must_use]
    pub fn ramp(&self) -> f64 {
        self.ramp.unwrap_or(self.period)
    }
}

impl FlagellumGait {
    /// Time constant of the ramp (s); 0 for none.
    #[must_use]
    pub fn ramp(&self) -> f64 {
        self.ramp.unwrap_or(self.period)
    }

    /// Length over which a tail of some length begins to bend (m).
    #[must_use]
    pub fn joint(&self, tail: f64) -> f64 {
        self.joint.unwrap_or(tail / 20.0)
    }
}

impl TubeShape {
    /// Half width along the midline; `None` for lengths that make no body.
    #[must_use]
    pub fn profile(&self) -> Option<Profile> {
        Profile::tube(&TubeForm {
            sections: self.sections.clone(),
            length: self.length,
            spacing: self.spacing,
        })
    }
}

impl JointsGait {
    /// The time after which it begins again (s), if it does.
    #[must_use]
    pub fn period(&self) -> Option<f64> {
        self.joints.iter().find_map(|joint| joint.angle.period())
    }
}

fn yes() -> bool {
    true
}

fn head_width() -> f64 {
    0.04
}

fn tail_width() -> f64 {
    0.01
}

fn head_end() -> f64 {
    0.04
}

fn tail_start() -> f64 {
    0.95
}

fn tip_radius() -> f64 {
    1e-3
}

fn corner_radius() -> f64 {
    0.01
}

fn anguilliform_amplitude() -> f64 {
    4.0 / 33.0
}

fn anguilliform_offset() -> f64 {
    1.0 / 32.0
}

/// The curvatures of @novati2017.
fn curvature() -> Vec<[f64; 2]> {
    vec![
        [0.0, 0.82014],
        [0.15, 1.46515],
        [0.4, 2.57136],
        [0.65, 3.75425],
        [0.9, 5.09147],
        [1.0, 5.70449],
    ]
}
