//! `Joint`: how a body hangs on another one: a bent or free pivot, or an arm of given length.

use std::f64::consts::PI;

use nalgebra::{UnitQuaternion, UnitVector3, Vector3};

use super::in_time::{MovingValue, TimeValue};
use crate::body::Pose;

/// How a body, the child, hangs on another one, its parent.
pub struct Joint {
    /// The body it hangs on.
    pub parent: usize,
    /// The joint in the frame of the parent, from its centre of mass (m).
    pub on_parent: Vector3<f64>,
    /// What is between the joints of parent and child; nothing at a pivot.
    pub arm: Option<Arm>,
    /// The joint in the frame of the child, from its centre of mass (m).
    pub on_child: Vector3<f64>,
    /// The rotation of the child relative to the parent, from `rest`.
    pub turn: Turn,
    /// The rotation from the frame of the child to that of the parent at an angle of zero, or where the
    /// spring of a ball joint is at rest; none in the plane.
    pub rest: UnitQuaternion<f64>,
}

/// A bar of given length that turns with the parent.
pub struct Arm {
    /// Its direction in the frame of the parent.
    pub along: UnitVector3<f64>,
    /// Its length (m, m/s).
    pub length: MovingValue,
}

/// The rotation of a child relative to its parent.
pub enum Turn {
    /// By a given angle (rad, rad/s) about an axis of both frames.
    Given {
        /// The axis.
        axis: UnitVector3<f64>,
        /// The angle.
        angle: MovingValue,
    },
    /// Free, with a torque.
    Free(Pivot),
}

/// Torque on the child: -stiffness (rotation - rest) - damping rate + motor; the opposite on the
/// parent.
pub struct Pivot {
    /// The axis of the angle at rest and of the motor, in the frame of the parent; `None` of a ball joint,
    /// which turns about all.
    pub axis: Option<UnitVector3<f64>>,
    /// Torque per angle (N m).
    pub stiffness: f64,
    /// Torque per angular velocity (N m s).
    pub damping: f64,
    /// Angle at rest (rad).
    pub rest: f64,
    /// Torque of a motor (N m).
    pub motor: Option<TimeValue>,
}

impl Joint {
    /// Where the joint of the child is in the frame of the parent, from its centre of mass, and the rate
    /// of that (m, m/s).
    pub(in crate::coupling) fn lever_on_parent(&self, time: f64) -> [Vector3<f64>; 2] {
        let Some(arm) = &self.arm else { return [self.on_parent, Vector3::zeros()] };
        let [length, rate] = (arm.length)(time);
        [self.on_parent + arm.along.scale(length), arm.along.scale(rate)]
    }

    /// The rotation of the child from `rest` about an axis of the parent (rad), within (-pi, pi].
    pub(in crate::coupling) fn angle_about(
        &self,
        axis: &UnitVector3<f64>,
        [parent, child]: [&Pose; 2],
    ) -> f64 {
        angle_about(axis, &(parent.rotation().inverse() * child.rotation() * self.rest.inverse()))
    }
}

/// The angle of a rotation about an axis (rad), within (-pi, pi]: of a rotation about it and one across.
#[must_use]
pub fn angle_about(axis: &UnitVector3<f64>, rotation: &UnitQuaternion<f64>) -> f64 {
    let half = rotation.vector().dot(axis).atan2(rotation.w);
    (2.0 * half + PI).rem_euclid(2.0 * PI) - PI
}
