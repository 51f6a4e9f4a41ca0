//! `body.spring`: a spring and damper that tie a free body to a point and an orientation.

use serde::{Deserialize, Serialize};

use super::orientation::Orientation;
#[cfg(test)]
use crate::spec::number::{NonNegative, NonNegativePerDimension, PerDimension};

/// `spring`: force -stiffness (position - anchor) - damping velocity, and the same for the turn.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SpringSpec {
    /// Stiffness along x and y, in space z too (N/m; N/m2 planar).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(test, schemars(with = "NonNegativePerDimension"))]
    pub stiffness: Vec<f64>,
    /// Damping along x and y, in space z too (N s/m; N s/m2 planar).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(test, schemars(with = "NonNegativePerDimension"))]
    pub damping: Vec<f64>,
    /// Where the centre of mass rests (m); where it starts, if absent.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(test, schemars(with = "PerDimension"))]
    pub anchor: Vec<f64>,
    /// Torque per turn (N m/rad; N/rad planar); in space along the rotation vector from rest.
    #[serde(default)]
    #[cfg_attr(test, schemars(with = "NonNegative"))]
    pub torsion: f64,
    /// Torque per angular velocity (N m s/rad; N s/rad planar).
    #[serde(default)]
    #[cfg_attr(test, schemars(with = "NonNegative"))]
    pub torsion_damping: f64,
    /// Angle at rest (rad; planar); that at the start, if absent.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "crate::text::angle::deserialize"
    )]
    #[cfg_attr(test, schemars(with = "Option<crate::text::angle::Angle>"))]
    #[cfg_attr(test, schemars(extend("geometries" = ["planar", "axisymmetric"])))]
    pub rest_angle: Option<f64>,
    /// Rotation of the body frame at rest in space; that at the start, if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(extend("geometries" = ["spatial"])))]
    pub rest_orientation: Option<Orientation>,
}
