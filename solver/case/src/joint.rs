//! `[[joint]]`: how a body is attached to another, and the pose it has then.

use alewife_mesh::Point;
use nalgebra::Rotation2;
use serde::{Deserialize, Serialize};

use super::stroke::Stroke;

/// `[[joint]]`: the child hangs on the parent; bodies and joints make trees.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Joint {
    /// Name of the body it hangs on.
    pub parent: String,
    /// Name of the body that hangs.
    pub child: String,
    /// Where the joint is on the parent, in its frame (m); its origin if absent.
    #[serde(default)]
    pub on_parent: [f64; 2],
    /// Where the joint is on the child, in its frame (m); its origin if absent.
    #[serde(default)]
    pub on_child: [f64; 2],
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
        #[serde(default, deserialize_with = "super::angle::deserialize")]
        #[cfg_attr(test, schemars(with = "super::angle::Angle"))]
        direction: f64,
    },
    /// A pivot bent by a given angle.
    Bent {
        /// Angle of the child less that of the parent (rad).
        #[serde(deserialize_with = "super::angle::deserialize")]
        angle: Stroke,
    },
    /// A free pivot: torque on the child -stiffness (angle - rest) - damping rate + torque, with the
    /// angle of the child less that of the parent; the opposite on the parent.
    Hinge(Hinge),
}

impl JointKind {
    /// What is given in time of where the child is; nothing of a free pivot.
    #[must_use]
    pub fn stroke(&self) -> Option<&Stroke> {
        match self {
            Self::Arm { length, .. } => Some(length),
            Self::Bent { angle } => Some(angle),
            Self::Hinge(_) => None,
        }
    }

    /// Period of its stroke, or of the motor of a free pivot (s).
    pub(crate) fn period(&self) -> Option<f64> {
        match self {
            Self::Hinge(hinge) => hinge.torque.as_ref(),
            Self::Arm { .. } | Self::Bent { .. } => self.stroke(),
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

/// Pose at a time (s) of a child whose parent has a given pose; a free pivot is at rest.
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
        JointKind::Arm { length, direction } => {
            (Rotation2::new(*direction) * Point::<2>::new(length.at(time)[0], 0.0), 0.0)
        }
        JointKind::Bent { angle } => (Point::<2>::zeros(), angle.at(time)[0]),
        JointKind::Hinge(hinge) => (Point::<2>::zeros(), hinge.rest),
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

/// `hinge`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Hinge {
    /// Torque per angle (N m/rad; N/rad planar).
    #[serde(default)]
    pub stiffness: f64,
    /// Torque per angular velocity (N m s/rad; N s/rad planar).
    #[serde(default)]
    pub damping: f64,
    /// Angle at rest (rad).
    #[serde(default, deserialize_with = "super::angle::deserialize")]
    #[cfg_attr(test, schemars(with = "super::angle::Angle"))]
    pub rest: f64,
    /// Torque of a motor on the child (N m; N planar).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub torque: Option<Stroke>,
}
