//! Joints of a case as links of rigid bodies.

use nalgebra::{UnitVector3, Vector3};

use crate::body::Mode;
use crate::case::{Geometry, Hinge, Joint as JointSpec, JointKind, Model};
use crate::coupling::{Arm, Drive, Joint, Pivot, RigidBody, TimeValue, Turn};
use crate::simulation::RunError;

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
    let (parent, child) = (find(&joint.parent)?, find(&joint.child)?);
    let from_center = |body: usize, point: [f64; 2]| {
        let moments = model.bodies[body].shape.outline().moments();
        let centroid = moments.map(|moments| moments.centroid).unwrap_or_default();
        Vector3::new(point[0] - centroid.x, point[1] - centroid.y, 0.0)
    };
    let bend = model.bodies[child].angle - model.bodies[parent].angle;
    let axis = Vector3::z_axis();
    let mut arm = None;
    let turn = match joint.kind.clone() {
        JointKind::Arm { length, direction } => {
            // Along an axis to the last bit
            let snap = |part: f64| if part.abs() < 1e-15 { 0.0 } else { part };
            let along = Vector3::new(snap(direction.cos()), snap(direction.sin()), 0.0);
            let along = UnitVector3::new_unchecked(along);
            arm = Some(Arm { along, length: Box::new(move |time| length.at(time)) });
            Turn::Given { axis, angle: Box::new(move |_| [bend, 0.0]) }
        }
        JointKind::Bent { angle } => {
            Turn::Given { axis, angle: Box::new(move |time| angle.at(time)) }
        }
        JointKind::Hinge(hinge) => {
            let motor = hinge
                .torque
                .map(|torque| -> TimeValue { Box::new(move |time| torque.at(time)[0]) });
            let Hinge { stiffness, damping, rest, .. } = hinge;
            Turn::Free(Pivot { axis, stiffness, damping, rest, motor })
        }
    };
    let on_parent = from_center(parent, joint.on_parent);
    let on_child = from_center(child, joint.on_child);
    let body = &mut bodies[child];
    let is_free = matches!(turn, Turn::Free(_));
    body.drives[Mode::X] = Drive::Linked;
    if model.case.geometry == Geometry::Planar {
        body.drives[Mode::Y] = Drive::Linked;
        body.drives[Mode::AboutZ] = if is_free { Drive::Free } else { Drive::Linked };
    }
    body.joint = Some(Joint { parent, on_parent, arm, on_child, turn });
    Ok(())
}
