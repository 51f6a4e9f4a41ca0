//! `[[joint]]`: how a body is attached to another, and the pose it has then.

use alewife_mesh::Point;
use nalgebra::{Isometry3, Point3, Rotation2, Vector3};
use serde::{Deserialize, Serialize};

use super::stroke::Stroke;
#[cfg(test)]
use crate::spec::number::{Direction, NonNegative, PerDimension};

/// What stands for the laboratory, to which bodies may be joined, as a parent.
pub(crate) const LABORATORY: &str = "laboratory";

/// `[[joint]]`: the child is joined to the parent; bodies and joints make trees.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Joint {
    /// Name of the body it is joined to, or "laboratory".
    pub parent: String,
    /// Name of the body that is joined to it.
    pub child: String,
    /// Where the joint is on the parent, in its frame (m), or in the laboratory; its origin if absent.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(test, schemars(with = "PerDimension"))]
    pub on_parent: Vec<f64>,
    /// Where the joint is on the child, in its frame (m); its origin if absent.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(test, schemars(with = "PerDimension"))]
    pub on_child: Vec<f64>,
    /// What it lets the child do.
    pub kind: JointKind,
}

/// What a joint lets its child do.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum JointKind {
    /// An arm of given length from the joint of the parent to that of the child; it turns with the
    /// parent, and the child turns with both.
    Arm {
        /// Length (m).
        length: Stroke,
        /// Direction in the parent's frame, from x, counter-clockwise (rad).
        #[serde(default, deserialize_with = "crate::text::angle::deserialize")]
        #[cfg_attr(test, schemars(with = "crate::text::angle::Angle"))]
        #[cfg_attr(test, schemars(extend("geometries" = ["planar", "axisymmetric"])))]
        direction: f64,
        /// In three dimensions, the direction in the parent's frame, of any length.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[cfg_attr(test, schemars(with = "Option<Direction>", extend("geometries" = ["spatial"])))]
        along: Option<[f64; 3]>,
    },
    /// A pivot bent by a given angle.
    Bent {
        /// Angle of the child less that of the parent (rad); in three dimensions about the axis, from
        /// where the child is turned to at the angle of time zero.
        #[serde(deserialize_with = "crate::text::angle::deserialize")]
        angle: Stroke,
        /// In three dimensions, the axis in the parent's frame, of any length.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[cfg_attr(test, schemars(with = "Option<Direction>", extend("geometries" = ["spatial"])))]
        axis: Option<[f64; 3]>,
    },
    /// A free pivot: torque on the child -stiffness (angle - rest) - damping rate + torque, with the
    /// angle of the child less that of the parent; the opposite on the parent.
    Hinge(Hinge),
    /// An arm of free length: force on the child along it -stiffness (length - rest) - damping rate +
    /// force; the opposite on the parent. It turns with the parent, and the child turns with both.
    Slider(Slider),
    /// In three dimensions, a free pivot about all axes: torque on the child -stiffness times the rotation
    /// vector from where it was turned to at time zero, seen from the parent, - damping times the
    /// relative angular velocity; the opposite on the parent.
    #[cfg_attr(test, schemars(extend("geometries" = ["spatial"])))]
    Ball(Ball),
}

impl JointKind {
    /// What is given in time of where the child is; nothing of a joint that is free.
    #[must_use]
    pub fn stroke(&self) -> Option<&Stroke> {
        match self {
            Self::Arm { length, .. } => Some(length),
            Self::Bent { angle, .. } => Some(angle),
            Self::Hinge(_) | Self::Slider(_) | Self::Ball(_) => None,
        }
    }

    /// Whether it is an arm, of given or free length, along which the child goes without turning.
    #[must_use]
    pub fn is_arm(&self) -> bool {
        matches!(self, Self::Arm { .. } | Self::Slider(_))
    }

    /// The spring of a joint that is free: load per angle or length.
    #[must_use]
    pub fn stiffness(&self) -> f64 {
        match self {
            Self::Hinge(Hinge { stiffness, .. })
            | Self::Slider(Slider { stiffness, .. })
            | Self::Ball(Ball { stiffness, .. }) => *stiffness,
            Self::Arm { .. } | Self::Bent { .. } => 0.0,
        }
    }

    /// Period of its stroke, or of the motor of a joint that is free (s).
    pub(crate) fn period(&self) -> Option<f64> {
        match self {
            Self::Hinge(hinge) => hinge.torque.as_ref(),
            Self::Slider(slider) => slider.force.as_ref(),
            Self::Arm { .. } | Self::Bent { .. } | Self::Ball(_) => self.stroke(),
        }
        .and_then(Stroke::period)
    }
}

/// Position and orientation of a body in the plane.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct PlanarPose {
    /// Origin of the body frame (m).
    pub center: Point<2>,
    /// Rotation of the body frame, counter-clockwise (rad).
    pub angle: f64,
}

/// Pose at a time (s) of a child whose parent has a given pose; a joint that is free is at rest.
///
/// `on_parent` and `on_child` are the ends of the joint in the frames of the bodies (m).
pub(crate) fn child_pose(
    parent: PlanarPose,
    on_parent: [f64; 2],
    on_child: [f64; 2],
    kind: &JointKind,
    time: f64,
) -> PlanarPose {
    let (arm, bend) = match kind {
        JointKind::Arm { length, direction, .. } => {
            (Rotation2::new(*direction) * Point::<2>::new(length.at(time)[0], 0.0), 0.0)
        }
        JointKind::Bent { angle, .. } => (Point::<2>::zeros(), angle.at(time)[0]),
        JointKind::Slider(slider) => {
            (Rotation2::new(slider.direction) * Point::<2>::new(slider.rest, 0.0), 0.0)
        }
        JointKind::Hinge(hinge) => (Point::<2>::zeros(), hinge.rest),
        JointKind::Ball(_) => (Point::<2>::zeros(), 0.0),
    };
    let angle = parent.angle + bend;
    let joint = Rotation2::new(parent.angle) * (Point::<2>::from(on_parent) + arm);
    let back = Rotation2::new(angle) * Point::<2>::from(on_child);
    // An arm on the axis stays on it to the last bit.
    let is_along_x = parent.angle == 0.0 && joint.y.abs() < 1e-15 * joint.x.abs();
    let across = if is_along_x { 0.0 } else { joint.y };
    let center =
        Point::<2>::new(parent.center.x + joint.x - back.x, parent.center.y + across - back.y);
    PlanarPose { center, angle }
}

impl Joint {
    /// Ends of the joint on parent and child in the plane, in their frames (m).
    pub(crate) fn ends_in_plane(&self) -> [[f64; 2]; 2] {
        [&self.on_parent, &self.on_child].map(|end| [0, 1].map(|axis| coordinate(end, axis)))
    }

    /// Ends of the joint on parent and child, in their frames (m).
    #[must_use]
    pub fn ends(&self) -> [Vector3<f64>; 2] {
        [&self.on_parent, &self.on_child]
            .map(|end| Vector3::from_fn(|axis, _| coordinate(end, axis)))
    }

    /// Where the origin of the child has to be at time zero in three dimensions, turned as it is (m).
    pub(crate) fn child_center(&self, parent: &Isometry3<f64>, child: &Isometry3<f64>) -> Point<3> {
        let [on_parent, on_child] = self.ends();
        let arm = match &self.kind {
            JointKind::Arm { length, along: Some(along), .. } => {
                Vector3::from(*along).normalize() * length.at(0.0)[0]
            }
            // It may start at any length: that of the bodies
            JointKind::Slider(Slider { along: Some(along), .. }) => {
                let along = Vector3::from(*along).normalize();
                let end = child.transform_point(&Point3::from(on_child));
                along * (parent.inverse_transform_point(&end).coords - on_parent).dot(&along)
            }
            _ => Vector3::zeros(),
        };
        let joint = parent.transform_point(&Point3::from(on_parent + arm));
        joint.coords - child.rotation * on_child
    }
}

/// A coordinate of an end of a joint, zero where none is written.
fn coordinate(end: &[f64], axis: usize) -> f64 {
    end.get(axis).copied().unwrap_or(0.0)
}

/// `ball`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Ball {
    /// Torque per angle (N m/rad).
    #[serde(default)]
    #[cfg_attr(test, schemars(with = "NonNegative"))]
    pub stiffness: f64,
    /// Torque per angular velocity (N m s/rad).
    #[serde(default)]
    #[cfg_attr(test, schemars(with = "NonNegative"))]
    pub damping: f64,
}

/// `slider`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Slider {
    /// Force per length (N/m; N/m2 planar).
    #[serde(default)]
    #[cfg_attr(test, schemars(with = "NonNegative"))]
    pub stiffness: f64,
    /// Force per rate of the length (N s/m; N s/m2 planar).
    #[serde(default)]
    #[cfg_attr(test, schemars(with = "NonNegative"))]
    pub damping: f64,
    /// Length at rest (m).
    #[serde(default)]
    pub rest: f64,
    /// Direction in the parent's frame, from x, counter-clockwise (rad).
    #[serde(default, deserialize_with = "crate::text::angle::deserialize")]
    #[cfg_attr(test, schemars(with = "crate::text::angle::Angle"))]
    #[cfg_attr(test, schemars(extend("geometries" = ["planar", "axisymmetric"])))]
    pub direction: f64,
    /// In three dimensions, the direction in the parent's frame, of any length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Direction>", extend("geometries" = ["spatial"])))]
    pub along: Option<[f64; 3]>,
    /// Force of a motor on the child along the arm (N; N/m planar).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force: Option<Stroke>,
}

impl Slider {
    /// Its length in the plane with bodies at their poses (m).
    pub(crate) fn length_in_plane(
        &self,
        [parent, child]: [PlanarPose; 2],
        [on_parent, on_child]: [[f64; 2]; 2],
    ) -> f64 {
        let end = child.center + Rotation2::new(child.angle) * Point::<2>::from(on_child);
        let from_parent = Rotation2::new(-parent.angle) * (end - parent.center);
        let along = Rotation2::new(self.direction) * Point::<2>::new(1.0, 0.0);
        (from_parent - Point::<2>::from(on_parent)).dot(&along)
    }
}

/// `hinge`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Hinge {
    /// Torque per angle (N m/rad; N/rad planar).
    #[serde(default)]
    #[cfg_attr(test, schemars(with = "NonNegative"))]
    pub stiffness: f64,
    /// Torque per angular velocity (N m s/rad; N s/rad planar).
    #[serde(default)]
    #[cfg_attr(test, schemars(with = "NonNegative"))]
    pub damping: f64,
    /// Angle at rest (rad).
    #[serde(default, deserialize_with = "crate::text::angle::deserialize")]
    #[cfg_attr(test, schemars(with = "crate::text::angle::Angle"))]
    pub rest: f64,
    /// In three dimensions, the axis in the parent's frame, of any length; the angle is that about it of
    /// the rotation from the frame of the parent to that of the child.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Direction>", extend("geometries" = ["spatial"])))]
    pub axis: Option<[f64; 3]>,
    /// Torque of a motor on the child (N m; N planar).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub torque: Option<Stroke>,
}
