//! `gait.squirmer`: a surface that slips along itself.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::TimeFunction;
#[cfg(test)]
use crate::spec::number::Direction;

/// `gait.squirmer`: u_theta = sum of B_n V_n(theta), theta from the swimming axis.
///
/// V_n = 2/(n(n+1)) sin(theta) P_n'(cos theta) on a sphere (V_1 = sin, V_2 = sin cos);
/// V_n = sin(n theta) on a disc.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SquirmerGait {
    /// B_1, B_2, ... (m/s).
    #[cfg_attr(test, schemars(length(min = 1)))]
    pub modes: Vec<f64>,
    /// Direction of the swimming axis in the body frame, from x, counter-clockwise (rad);
    /// 0 or pi for a body on the axis.
    #[serde(default, deserialize_with = "crate::text::angle::deserialize")]
    #[cfg_attr(test, schemars(with = "crate::text::angle::Angle"))]
    #[cfg_attr(test, schemars(extend("geometries" = ["planar", "axisymmetric"])))]
    pub heading: f64,
    /// Direction of the swimming axis in the body frame, of any length (spatial); x if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Direction>", extend("geometries" = ["spatial"])))]
    pub axis: Option<[f64; 3]>,
    /// Factors of modes in time, by the number of the mode: `2` is that of B_2.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub factors: BTreeMap<String, TimeFunction>,
    /// Angle in time by which the swimming axis is turned from `heading`, counter-clockwise (rad);
    /// planar only. The body itself does not turn by it.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "crate::text::angle::deserialize"
    )]
    #[cfg_attr(test, schemars(extend("geometries" = ["planar", "axisymmetric"])))]
    pub turn: Option<TimeFunction>,
}

impl SquirmerGait {
    /// Factor of each mode in time, as many as there are modes.
    #[must_use]
    pub fn factors_of_modes(&self) -> Vec<Option<TimeFunction>> {
        let number = |index: usize| (index + 1).to_string();
        (0..self.modes.len()).map(|index| self.factors.get(&number(index)).cloned()).collect()
    }

    /// The swimming axis as it is written, a unit vector in the frame of the body; where the flow is revolved
    /// about x, that or its opposite to the last bit.
    #[must_use]
    pub fn axis_in_body(&self, is_revolved: bool) -> Vector3<f64> {
        if is_revolved {
            Vector3::x() * if (self.heading.abs() - PI).abs() < 1e-3 { -1.0 } else { 1.0 }
        } else if let Some(axis) = self.axis {
            Vector3::from(axis).normalize()
        } else {
            Vector3::new(self.heading.cos(), self.heading.sin(), 0.0)
        }
    }
}
