//! `PartPose`: where a part of a swimmer is and how it is turned, in the plane or in three dimensions.

use nalgebra::{Isometry3, UnitQuaternion, Vector3};

use crate::spec::body::joint::{JointKind, PlanarPose, child_pose};
use crate::spec::body::orientation::Orientation;

/// Position and orientation of a part of a swimmer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum PartPose {
    /// In the plane, or on the axis.
    Planar(PlanarPose),
    /// In three dimensions.
    Spatial(Isometry3<f64>),
}

impl PartPose {
    /// Pose at time zero of a part that hangs on the part with this one, by a joint at points of
    /// both (m, in their frames).
    pub fn child(&self, [on_parent, on_child]: [[f64; 2]; 2], kind: &JointKind) -> Self {
        match self {
            Self::Planar(parent) => {
                Self::Planar(child_pose(*parent, on_parent, on_child, kind, 0.0))
            }
            // In the x-y plane of the body frame, or where the arm points to
            Self::Spatial(parent) => {
                let arm = match kind {
                    JointKind::Arm { along: Some(along), length, .. } => {
                        Some(Vector3::from(*along).normalize() * length.at(0.0)[0])
                    }
                    _ => None,
                };
                let at_root = PlanarPose::default();
                let planar = child_pose(at_root, on_parent, on_child, kind, 0.0);
                let in_plane = Vector3::new(planar.center.x, planar.center.y, 0.0);
                let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), planar.angle);
                Self::Spatial(parent * Isometry3::from_parts(arm.unwrap_or(in_plane).into(), turn))
            }
        }
    }

    /// Origin of the body frame (m), with two or three coordinates.
    pub fn center(&self) -> Vec<f64> {
        match self {
            Self::Planar(pose) => vec![pose.center.x, pose.center.y],
            Self::Spatial(pose) => pose.translation.vector.iter().copied().collect(),
        }
    }

    /// Rotation of the body frame in the plane, counter-clockwise (rad).
    pub fn angle(&self) -> f64 {
        match self {
            Self::Planar(pose) => pose.angle,
            Self::Spatial(_) => 0.0,
        }
    }

    /// Rotation of the body frame in three dimensions.
    pub fn orientation(&self) -> Option<Orientation> {
        let Self::Spatial(pose) = self else { return None };
        let [x, y, z, w] = pose.rotation.coords.into();
        (pose.rotation != UnitQuaternion::identity())
            .then_some(Orientation::Quaternion([w, x, y, z]))
    }
}
