//! Three sliders and three hinges of a first body as a keel.

use alewife_reduced::tree::JointKind;
use nalgebra::Vector3;

use crate::case::KeelSpec;
use crate::reduced::exchange::robot::RobotBody;

/// How far apart places and axes that are the same may be by rounding (m, 1).
const ROUNDING: f64 = 1e-9;

/// The keel that the joints of a first body are: along and about x, y and z of the world in this order, without springs and
/// dampers but those that keep its height and keep it level; none if they are something else.
pub(super) fn keel_of(body: &RobotBody) -> Option<KeelSpec> {
    let [along_x, along_y, along_z, about_x, about_y, about_z] = &body.joints[..] else {
        return None;
    };
    for (nth, joint) in body.joints.iter().enumerate() {
        let kind = if nth < 3 { JointKind::Slider } else { JointKind::Hinge };
        let axis = body.pose.rotation * joint.axis;
        let is_there = nth < 3 || (joint.position - about_x.position).norm() < ROUNDING;
        let is_along = (axis - Vector3::ith(nth % 3, 1.0)).norm() < ROUNDING;
        let is_at_rest = joint.rest == 0.0 && joint.start == [0.0; 2];
        if joint.kind != kind || !is_along || !is_there || !is_at_rest {
            return None;
        }
    }
    let is_free = [along_x, along_y, about_z]
        .iter()
        .all(|joint| joint.stiffness == 0.0 && joint.damping == 0.0);
    let is_even = about_x.stiffness == about_y.stiffness && about_x.damping == about_y.damping;
    (is_free && is_even).then(|| KeelSpec {
        position: Some(about_x.position.into()),
        heave_stiffness: along_z.stiffness,
        heave_damping: along_z.damping,
        tilt_stiffness: about_x.stiffness,
        tilt_damping: about_x.damping,
    })
}
