//! Joints of a case as links of rigid bodies.

use nalgebra::{UnitQuaternion, UnitVector3, Vector3};

use crate::body::Mode;
use crate::case::{Ball, Geometry, Hinge, Joint as JointSpec, JointKind, Model, Slider, Stroke};
use crate::coupling::{
    Arm, Drive, Joint, JointLaw, Length, Pivot, RigidBody, TimeValue, Turn, angle_about,
};
use crate::run::RunError;

/// Hangs a child on its parent.
pub(super) fn add_joint(
    model: &Model,
    joint: &JointSpec,
    bodies: &mut [RigidBody],
) -> Result<(), RunError> {
    let find = |name: &str| {
        model.body_index(name).ok_or_else(|| {
            RunError::Unsupported(format!("a joint names \"{name}\", which is no body"))
        })
    };
    let parent = match model.hangs_on_laboratory(joint) {
        true => None,
        false => Some(find(&joint.parent)?),
    };
    let child = find(&joint.child)?;
    let is_spatial = model.case.geometry == Geometry::Spatial;
    let centroid = |body: usize| centroid(model, bodies, body);
    let [on_parent, on_child] = joint.ends();
    let of_parent = parent.map_or_else(Vector3::zeros, centroid);
    let (on_parent, on_child) = (on_parent - of_parent, on_child - centroid(child));
    // In space the orientations of the bodies say how the child is turned
    let bend = if is_spatial { 0.0 } else { model.bodies[child].angle - angle_of(model, parent) };
    let relative = || {
        let own = bodies[child].pose.rotation();
        parent.map_or(own, |parent| bodies[parent].pose.rotation().inverse() * own)
    };
    let mut rest = if is_spatial { relative() } else { UnitQuaternion::identity() };
    let z = Vector3::z_axis();
    let mut arm = None;
    let turn = match joint.kind.clone() {
        JointKind::Arm { length, direction, along } => {
            let along = along.map_or_else(|| in_plane(direction), direction_of);
            let length = Length::Given(Box::new(move |time| length.at(time)));
            arm = Some(Arm { along, length });
            Turn::Given { axis: z, angle: Box::new(move |_| [bend, 0.0]) }
        }
        JointKind::Slider(slider) => {
            let Slider { stiffness, damping, rest, force, direction, along } = slider;
            let along = along.map_or_else(|| in_plane(direction), direction_of);
            let law = JointLaw { stiffness, damping, rest, motor: force.map(value_of) };
            arm = Some(Arm { along, length: Length::Free(law) });
            Turn::Given { axis: z, angle: Box::new(move |_| [bend, 0.0]) }
        }
        JointKind::Bent { angle, axis } => {
            let axis = axis.map_or(z, direction_of);
            if is_spatial {
                rest = UnitQuaternion::from_axis_angle(&axis, -angle.at(0.0)[0]) * rest;
            }
            Turn::Given { axis, angle: Box::new(move |time| angle.at(time)) }
        }
        JointKind::Ball(Ball { stiffness, damping }) => {
            let law = JointLaw { stiffness, damping, rest: 0.0, motor: None };
            Turn::Free(Pivot { axis: None, law })
        }
        JointKind::Hinge(hinge) => {
            let Hinge { stiffness, damping, rest: angle, torque, .. } = hinge;
            let axis = hinge.axis.map_or(z, direction_of);
            if is_spatial {
                rest = UnitQuaternion::from_axis_angle(&axis, -angle_about(&axis, &rest)) * rest;
            }
            let motor = torque.map(value_of);
            let law = JointLaw { stiffness, damping, rest: angle, motor };
            Turn::Free(Pivot { axis: Some(axis), law })
        }
    };
    let body = &mut bodies[child];
    link(body, &turn, model.case.geometry);
    body.joint = Some(Joint { parent, on_parent, arm, on_child, turn, rest });
    Ok(())
}

/// The angle in the plane of what a joint hangs on (rad).
fn angle_of(model: &Model, parent: Option<usize>) -> f64 {
    parent.map_or(0.0, |parent| model.bodies[parent].angle)
}

/// Has the velocities of a child follow from its parent, but for those a free pivot leaves to it.
fn link(body: &mut RigidBody, turn: &Turn, geometry: Geometry) {
    // What of a rotation about one axis in space is independent changes with its direction
    let is_free = match turn {
        Turn::Free(pivot) => pivot.axis.is_none() || geometry != Geometry::Spatial,
        Turn::Given { .. } => false,
    };
    let turned = || if is_free { Drive::Free } else { Drive::Linked };
    let linked: &[Mode] = match geometry {
        Geometry::Axisymmetric => &[Mode::X],
        Geometry::Planar => &[Mode::X, Mode::Y, Mode::AboutZ],
        Geometry::Spatial => &Mode::ALL,
    };
    for &mode in linked {
        body.drives[mode] = if mode.is_rotation() { turned() } else { Drive::Linked };
    }
}

/// Centre of mass of a body in its frame (m).
fn centroid(model: &Model, bodies: &[RigidBody], body: usize) -> Vector3<f64> {
    if model.case.geometry == Geometry::Spatial {
        let frame = model.bodies[body].pose_in_space();
        return frame.inverse_transform_point(&bodies[body].pose.center.into()).coords;
    }
    if !model.bodies[body].center_of_mass.is_empty() {
        let at = |axis: usize| model.bodies[body].center_of_mass.get(axis).copied();
        return Vector3::from_fn(|axis, _| at(axis).unwrap_or(0.0));
    }
    let moments = model.bodies[body].shape.outline().moments();
    let centroid = moments.map(|moments| moments.centroid).unwrap_or_default();
    Vector3::new(centroid.x, centroid.y, 0.0)
}

/// The values of a stroke.
pub(super) fn value_of(stroke: Stroke) -> TimeValue {
    Box::new(move |time| stroke.at(time)[0])
}

/// The direction at an angle in the plane (rad), along an axis to the last bit.
fn in_plane(direction: f64) -> UnitVector3<f64> {
    let snap = |part: f64| if part.abs() < 1e-15 { 0.0 } else { part };
    UnitVector3::new_unchecked(Vector3::new(snap(direction.cos()), snap(direction.sin()), 0.0))
}

fn direction_of(vector: [f64; 3]) -> UnitVector3<f64> {
    UnitVector3::new_normalize(vector.into())
}
