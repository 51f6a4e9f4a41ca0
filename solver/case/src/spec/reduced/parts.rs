//! What a reduced model has besides coefficients: buoyancy apart from shapes, thrusters, a connection.

use serde::{Deserialize, Serialize};

use crate::Stroke;
#[cfg(test)]
use crate::spec::number::{NonNegative, Positive};

/// `reduced.buoyancy.NAME`: what a body displaces, in place of what its shape does.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct BuoyancySpec {
    /// Volume of the fluid that is displaced (m3; m2 planar); that of the shape if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<NonNegative>"))]
    pub volume: Option<f64>,
    /// Centre of buoyancy in the frame of the body (m), one number per dimension; the centroid of the shape if absent.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub center: Vec<f64>,
}

/// `[[reduced.thruster]]`: a propeller on a body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ThrusterSpec {
    /// Its name; what it waits for is `thruster.NAME`.
    pub name: String,
    /// Name of the body it is on.
    pub body: String,
    /// Where it is in the frame of the body (m), one number per dimension; at its origin if absent.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub position: Vec<f64>,
    /// Direction of a positive force in the frame of the body, of any length.
    pub direction: Vec<f64>,
    /// Force (N; N/m planar) by the first, third, fifth ... power of what it is told, from -1 to 1.
    #[cfg_attr(test, schemars(length(min = 1)))]
    pub curve: Vec<f64>,
    /// What it is told; cut to -1 and 1.
    pub drive: Stroke,
    /// How its force follows the one of the curve; at once if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lag: Option<LagSpec>,
}

/// `lag`: the force follows by (b1 s + b0) / (s3 + a2 s2 + a1 s + a0).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct LagSpec {
    /// b0 (1/s3) and b1 (1/s2).
    pub numerator: [f64; 2],
    /// a0 (1/s3), a1 (1/s2) and a2 (1/s).
    pub denominator: [f64; 3],
}

impl LagSpec {
    /// Whether all that it remembers dies out (Hurwitz's conditions).
    #[must_use]
    pub fn is_stable(&self) -> bool {
        let [a, b, c] = self.denominator;
        a > 0.0 && b > 0.0 && c > 0.0 && b * c > a && (a * b * c).is_finite()
    }
}

/// `[reduced.connection]`: velocities of the first body by rates of joints, at Chebyshev's nodes
/// c cos(pi (k + 1/2) / n) of the coordinate of each.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ConnectionSpec {
    /// Half width c of the range of each joint, about zero (rad, m), one to three.
    #[cfg_attr(test, schemars(with = "Vec<Positive>"))]
    pub range: Vec<f64>,
    /// Nodes n of each joint.
    pub nodes: Vec<usize>,
    /// A row of each node, the last joint fastest: of each joint the velocities of the first body, in its own frame, by its
    /// rate: along x, along y and about z, in space along and about x, y and z.
    pub values: Vec<Vec<f64>>,
}

/// `reduced.calibrated`: the file that `alewife calibrate` has written, whose coefficients are taken.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct CalibratedSpec {
    /// Its path, relative to the case.
    pub file: String,
    /// Bodies of the case it was found for; read from the file.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bodies: Vec<String>,
    /// Smallest and largest period of the gaits it was fitted to (s); read from the file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub periods: Option<[f64; 2]>,
    /// Smallest and largest bend or length of joints in them, half of their range (rad, m); read from the file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub amplitudes: Option<[f64; 2]>,
    /// Smallest and largest kinematic viscosity in them (m2/s); read from the file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub viscosities: Option<[f64; 2]>,
}
