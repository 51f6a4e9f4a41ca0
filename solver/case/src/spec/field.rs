//! `[field]`: a magnetic field that turns and pulls bodies with a magnetic moment.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::body::stroke::Stroke;
#[cfg(test)]
use crate::spec::number::{Direction, NonNegative, PerDimension, Positive};

/// `[field]`: what acts on bodies from afar.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct FieldSpec {
    /// Magnetic field, which turns bodies with a `magnetic_moment`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub magnetic: Option<MagneticSpec>,
}

/// `magnetic`: the sum of what is given, at least one of these.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct MagneticSpec {
    /// The same everywhere, of constant strength, and turning steadily.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(extend("geometries" = ["planar", "spatial"])))]
    pub rotating: Option<RotatingField>,
    /// The same everywhere: its component along each coordinate in time (T), one per dimension.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub components: Vec<Stroke>,
    /// Growing linearly from a point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub linear: Option<LinearField>,
    /// Those of dipoles outside the bodies.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub dipoles: Vec<DipoleField>,
}

/// `rotating`: of constant strength, turning steadily in a plane.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct RotatingField {
    /// Its strength (T).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub strength: f64,
    /// Turns per time (1/s).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub frequency: f64,
    /// Whether it turns clockwise; counter-clockwise, from x to y, if absent.
    #[serde(default)]
    #[cfg_attr(test, schemars(extend("geometries" = ["planar", "axisymmetric"])))]
    pub clockwise: bool,
    /// In three dimensions, the axis about which it turns counter-clockwise, of any length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Direction>", extend("geometries" = ["spatial"])))]
    pub axis: Option<[f64; 3]>,
    /// Where it is at time zero (turns): from x, in space from the coordinate that follows the one the axis is nearest to,
    /// as y follows x and x follows z.
    #[serde(default)]
    pub phase: f64,
    /// Time over which the strength grows from 0, twice continuously differentiable (s); 0 for all of it from the start.
    #[serde(default)]
    #[cfg_attr(test, schemars(with = "NonNegative"))]
    pub ramp: f64,
}

impl RotatingField {
    /// Unit vectors along which it points at a phase of zero, and a quarter of a turn later.
    #[must_use]
    pub fn directions(&self) -> [[f64; 3]; 2] {
        let Some(axis) = self.axis else {
            return [[1.0, 0.0, 0.0], [0.0, if self.clockwise { -1.0 } else { 1.0 }, 0.0]];
        };
        let axis = Vector3::from(axis).normalize();
        let next = Vector3::ith((axis.iamax() + 1) % 3, 1.0);
        let start = (next - axis * axis.dot(&next)).normalize();
        [start, axis.cross(&start)].map(Into::into)
    }
}

/// `linear`: gradient (x - center), times the factor.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct LinearField {
    /// Rows of the matrix of derivatives dB_i/dx_j (T/m), one per dimension; symmetric, as it has no rotation, and the sum of its diagonal
    /// is zero, as it has no divergence. On an axis of symmetry the derivative across counts twice: [[g, 0], [0, -g/2]].
    pub gradient: Vec<Vec<f64>>,
    /// Where it is zero (m); the origin if absent.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(test, schemars(with = "PerDimension"))]
    pub center: Vec<f64>,
    /// Factor in time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub factor: Option<Stroke>,
}

/// An entry of `dipoles`: a point, or in the plane a line along z.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct DipoleField {
    /// Where it is (m).
    #[cfg_attr(test, schemars(with = "PerDimension"))]
    pub position: Vec<f64>,
    /// Its moment times the permeability (T m3; T m2 planar): the field is [3 (s . r) r / r^2 - s] / (4 pi r^3), planar
    /// [2 (s . r) r / r^2 - s] / (2 pi r^2).
    #[cfg_attr(test, schemars(with = "PerDimension"))]
    pub strength: Vec<f64>,
    /// Factor in time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub factor: Option<Stroke>,
}

impl MagneticSpec {
    /// Whether it differs from place to place, so that it pulls.
    #[must_use]
    pub fn has_gradient(&self) -> bool {
        self.linear.is_some() || !self.dipoles.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_turns_about_its_axis_from_the_next_coordinate() {
        let about = |axis: [f64; 3]| {
            RotatingField { axis: Some(axis), ..RotatingField::default() }.directions()
        };
        assert_eq!(about([0.0, 0.0, 2.0]), RotatingField::default().directions());
        assert_eq!(about([3.0, 0.0, 0.0]), [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        let [start, ahead] = about([0.3, -2.0, 0.6]).map(Vector3::from);
        let axis = Vector3::new(0.3, -2.0, 0.6);
        assert!(start.z > 0.9 && start.dot(&axis).abs() < 1e-15 && ahead.dot(&axis).abs() < 1e-15);
        assert!((start.cross(&ahead) - axis.normalize()).norm() < 1e-15);
        let back = RotatingField { clockwise: true, ..RotatingField::default() }.directions();
        assert_eq!(back[1], [0.0, -1.0, 0.0]);
    }
}
