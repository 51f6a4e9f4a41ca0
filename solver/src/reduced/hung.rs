//! `Hung`: a joint of a case as one of a tree.

use alewife_reduced::tree::{Drive, Joint, JointKind as Kind};
use nalgebra::{Rotation3, UnitQuaternion, UnitVector3, Vector3};

use super::ReducedError;
use super::told::Told;
use crate::case::{JointKind, Stroke};

/// Angle of a rotation about an axis (rad), within half a turn.
pub(super) fn angle_about(axis: &UnitVector3<f64>, rotation: &UnitQuaternion<f64>) -> f64 {
    let angle = 2.0 * rotation.imag().dot(axis).atan2(rotation.w);
    angle - (angle / std::f64::consts::TAU).round() * std::f64::consts::TAU
}

/// A joint of a case as one of a tree.
pub(super) struct Hung {
    pub joint: Joint<f64>,
    pub told: Told,
    /// How the child is turned where the coordinate is zero.
    pub rest: UnitQuaternion<f64>,
}

impl Hung {
    pub fn of(
        kind: &JointKind,
        is_spatial: bool,
        relative: &UnitQuaternion<f64>,
    ) -> Result<Self, ReducedError> {
        let in_plane = |direction: f64| Vector3::new(direction.cos(), direction.sin(), 0.0);
        let unit = |axis: Option<[f64; 3]>, else_: Vector3<f64>| {
            axis.map_or(else_, |axis| Vector3::from(axis).normalize())
        };
        let motor = |stroke: &Option<Stroke>| stroke.clone().map_or(Told::Nothing, Told::Effort);
        // How the child is turned from its axes at a coordinate of zero
        let back = |axis: Vector3<f64>, angle: f64| {
            let turn = Rotation3::from_axis_angle(&UnitVector3::new_unchecked(axis), -angle);
            if is_spatial {
                UnitQuaternion::from(turn) * relative
            } else {
                UnitQuaternion::identity()
            }
        };
        let made = |kind, axis: Vector3<f64>| Joint::new(kind, axis.into());
        Ok(match kind {
            JointKind::Arm { length, direction, along } => Self {
                joint: made(Kind::Slider, unit(*along, in_plane(*direction))).driven(Drive::Given),
                told: Told::Given(length.clone()),
                rest: *relative,
            },
            JointKind::Slider(slider) => {
                let axis = unit(slider.along, in_plane(slider.direction));
                let (stiffness, damping, rest) = (slider.stiffness, slider.damping, slider.rest);
                let joint = Joint { stiffness, damping, rest, ..made(Kind::Slider, axis) };
                Self { joint, told: motor(&slider.force), rest: *relative }
            }
            JointKind::Bent { angle, axis } => {
                let axis = unit(*axis, Vector3::z());
                Self {
                    joint: made(Kind::Hinge, axis).driven(Drive::Given),
                    told: Told::Given(angle.clone()),
                    rest: back(axis, angle.at(0.0)[0]),
                }
            }
            JointKind::Hinge(hinge) => {
                let axis = unit(hinge.axis, Vector3::z());
                let (stiffness, damping, rest) = (hinge.stiffness, hinge.damping, hinge.rest);
                let joint = Joint { stiffness, damping, rest, ..made(Kind::Hinge, axis) };
                let turned = angle_about(&UnitVector3::new_unchecked(axis), relative);
                Self { joint, told: motor(&hinge.torque), rest: back(axis, turned) }
            }
            JointKind::Ball(_) => {
                return Err(ReducedError::Unknown("joints that turn about all axes".to_owned()));
            }
        })
    }
}
