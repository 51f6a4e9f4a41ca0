//! `Joint`: how a body hangs on another one: a bent or free pivot, or an arm of given or free length.

use std::f64::consts::PI;

use nalgebra::{UnitQuaternion, UnitVector3, Vector3};

use super::in_time::{MovingValue, TimeValue};
use crate::body::Pose;

/// How a body, the child, hangs on another one, its parent.
pub struct Joint {
    /// The body it hangs on; `None` of the laboratory, which does not move.
    pub parent: Option<usize>,
    /// The joint in the frame of the parent, from its centre of mass (m), or in the laboratory.
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

/// A bar that turns with the parent.
pub struct Arm {
    /// Its direction in the frame of the parent.
    pub along: UnitVector3<f64>,
    /// Its length.
    pub length: Length,
}

/// The length of an arm.
pub enum Length {
    /// Given in time (m, m/s).
    Given(MovingValue),
    /// Free, with a force on the child along the arm; the opposite on the parent.
    Free(JointLaw),
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

/// A pivot with a torque on the child; the opposite on the parent.
pub struct Pivot {
    /// The axis of the angle at rest and of the motor, in the frame of the parent; `None` of a ball joint,
    /// which turns about all.
    pub axis: Option<UnitVector3<f64>>,
    /// The torque.
    pub law: JointLaw,
}

/// Load in a joint that is free: -stiffness (coordinate - rest) - damping rate + motor, a torque by an
/// angle or a force by a length.
pub struct JointLaw {
    /// Load per coordinate (N m/rad, N/m).
    pub stiffness: f64,
    /// Load per rate (N m s/rad, N s/m).
    pub damping: f64,
    /// Coordinate at rest (rad, m).
    pub rest: f64,
    /// Load of a motor (N m, N).
    pub motor: Option<TimeValue>,
}

/// An arm of free length.
pub(in crate::coupling) struct FreeArm<'a> {
    pub arm: &'a Arm,
    /// The force along it.
    pub law: &'a JointLaw,
}

impl JointLaw {
    /// Load of the motor at a time (s).
    pub(in crate::coupling) fn motor_load(&self, time: f64) -> f64 {
        self.motor.as_ref().map_or(0.0, |motor| motor(time))
    }
}

impl Joint {
    /// The pose of what the child hangs on, with bodies at poses in the laboratory.
    pub(in crate::coupling) fn parent_pose(&self, poses: &[Pose], child: usize) -> Pose {
        self.parent.map_or_else(|| poses[child].laboratory(), |parent| poses[parent])
    }

    /// The arm of free length, and its law.
    pub(in crate::coupling) fn free_arm(&self) -> Option<FreeArm<'_>> {
        let arm = self.arm.as_ref()?;
        match &arm.length {
            Length::Free(law) => Some(FreeArm { arm, law }),
            Length::Given(_) => None,
        }
    }

    /// Whether the child has a motion of its own: in a free pivot, or along an arm of free length.
    #[must_use]
    pub fn is_free(&self) -> bool {
        matches!(self.turn, Turn::Free(_)) || self.free_arm().is_some()
    }

    /// How far the joint of the child is from that of the parent along the arm (m).
    pub(in crate::coupling) fn length_along(&self, arm: &Arm, [parent, child]: [&Pose; 2]) -> f64 {
        let end = child.center + child.to_world(&self.on_child) - parent.center;
        (parent.to_body(&end) - self.on_parent).dot(&arm.along)
    }

    /// Where the joint of the child is in the frame of the parent, from its centre of mass, and the rate
    /// of that by what is given (m, m/s); along an arm of free length it is where the child is.
    pub(in crate::coupling) fn lever_on_parent(
        &self,
        poses: [&Pose; 2],
        time: f64,
    ) -> [Vector3<f64>; 2] {
        let Some(arm) = &self.arm else { return [self.on_parent, Vector3::zeros()] };
        let [length, rate] = match &arm.length {
            Length::Given(length) => length(time),
            Length::Free(_) => [self.length_along(arm, poses), 0.0],
        };
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
