//! What moves and holds a reduced model besides its joints: tendons, servos, a keel, and ellipsoids for the loads.

use serde::{Deserialize, Serialize};

use crate::spec::body::orientation::Orientation;
#[cfg(test)]
use crate::spec::number::{NonNegative, Positive};

/// `[[reduced.tendon]]`: an elastic line through points of bodies, straight between them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct TendonSpec {
    /// Its name.
    pub name: String,
    /// The points it goes through, in order, two or more.
    #[cfg_attr(test, schemars(length(min = 2)))]
    pub sites: Vec<SiteSpec>,
    /// Tension per length beyond that at rest (N/m; N/m2 planar).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub stiffness: f64,
    /// Tension per rate of its length (N s/m; N s/m2 planar).
    #[serde(default)]
    #[cfg_attr(test, schemars(with = "NonNegative"))]
    pub damping: f64,
    /// Length at rest (m); that at the start if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub rest: Option<f64>,
    /// Whether it pushes where it is shorter, as those of `MuJoCo` do; it is slack then if absent.
    #[serde(default)]
    pub pushes: bool,
}

/// A point of a body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SiteSpec {
    /// Name of the body.
    pub body: String,
    /// Where it is in the frame of the body (m), one number per dimension.
    pub position: Vec<f64>,
}

/// `[[reduced.servo]]`: a motor that brings a pivot or a slider to a rate, with the effort gain times what the rate lacks.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ServoSpec {
    /// Name of the body whose joint it drives: the child of that joint, a `hinge` or a `slider` without a motor.
    pub joint: String,
    /// Rate that it holds (rad/s, m/s).
    pub rate: f64,
    /// Effort per rate (N m s/rad, N s/m).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub gain: f64,
    /// Largest effort (N m, N); without bound if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub limit: Option<f64>,
}

/// `reduced.keel`: springs that keep the first body of a case in space at its height and level, and let it go along x and y
/// and turn about z.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct KeelSpec {
    /// The point that is kept, in the frame of the body (m), about which it rolls and pitches; its centre of mass if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub position: Option<[f64; 3]>,
    /// Force per height (N/m).
    #[cfg_attr(test, schemars(with = "NonNegative"))]
    pub heave_stiffness: f64,
    /// Force per rate of height (N s/m).
    #[serde(default)]
    #[cfg_attr(test, schemars(with = "NonNegative"))]
    pub heave_damping: f64,
    /// Torque per angle of roll and of pitch (N m/rad).
    #[cfg_attr(test, schemars(with = "NonNegative"))]
    pub tilt_stiffness: f64,
    /// Torque per rate of roll and of pitch (N m s/rad).
    #[serde(default)]
    #[cfg_attr(test, schemars(with = "NonNegative"))]
    pub tilt_damping: f64,
}

/// `[[reduced.ellipsoid]]`: an ellipsoid on a body for the law `ellipsoid`. Loads on a body that has any are those of its
/// ellipsoids, in place of that of its shape.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct EllipsoidSpec {
    /// Name of the body.
    pub body: String,
    /// Its centre in the frame of the body (m).
    pub position: [f64; 3],
    /// Half lengths along its axes (m), which are those of the body unless it is turned.
    #[cfg_attr(test, schemars(with = "[Positive; 3]"))]
    pub semi_axes: [f64; 3],
    /// How its axes are turned from those of the body; not at all if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub orientation: Option<Orientation>,
}
