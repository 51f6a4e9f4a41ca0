//! Joints of a case, and what their angles are taken to be, as lines for the terminal.

use crate::case::{Geometry, Joint, JointKind, Model, Stroke, SwimmerModel, significant};

/// An angle in radians and degrees.
pub(super) fn angle_in_words(angle: f64) -> String {
    format!("{} rad ({:.1} degrees)", significant(angle), angle.to_degrees())
}

pub(super) fn joint_line(joint: &Joint) -> String {
    let range = |stroke: &Stroke, number: fn(f64) -> String| match stroke {
        Stroke::Constant(value) => number(*value),
        // It has no bounds
        Stroke::Steady { start, rate } => {
            format!("{}, turning by {} in a time of 1", number(*start), number(*rate))
        }
        Stroke::Command(_) => format!("{} on command", stroke.range().map(number).join(" to ")),
        _ => stroke.range().map(number).join(" to "),
    };
    let stroke = |stroke: &Stroke| range(stroke, significant);
    let what = match &joint.kind {
        JointKind::Arm { length, along: Some(along), .. } => {
            format!("arm of length {}, along {along:?}", stroke(length))
        }
        JointKind::Arm { length, direction, along: None } => {
            format!("arm of length {}, direction {}", stroke(length), angle_in_words(*direction))
        }
        JointKind::Slider(slider) => {
            let force = slider.force.as_ref().map(|force| format!(", force {}", stroke(force)));
            let direction = match slider.along {
                Some(along) => format!("along {along:?}"),
                None => format!("direction {}", angle_in_words(slider.direction)),
            };
            format!(
                "arm of free length, {direction}, stiffness {}, damping {}, at rest {}{}",
                significant(slider.stiffness),
                significant(slider.damping),
                significant(slider.rest),
                force.unwrap_or_default()
            )
        }
        JointKind::Bent { angle, axis } => {
            let about = axis.map(|axis| format!(" about {axis:?}"));
            format!("bent by {}{}", range(angle, angle_in_words), about.unwrap_or_default())
        }
        JointKind::Ball(ball) => format!(
            "ball joint, stiffness {}, damping {}",
            significant(ball.stiffness),
            significant(ball.damping)
        ),
        JointKind::Hinge(hinge) => {
            let motor = hinge.torque.as_ref().map(|torque| format!(", torque {}", stroke(torque)));
            format!(
                "hinge, stiffness {}, damping {}{}",
                significant(hinge.stiffness),
                significant(hinge.damping),
                motor.unwrap_or_default()
            )
        }
    };
    format!("{} is attached to {}: {what}", joint.child, joint.parent)
}

/// What angles from files are taken to be, of a swimmer in the plane whose root is between its joints.
pub(super) fn senses_of_angles(model: &Model, swimmer: &SwimmerModel) -> Option<String> {
    let root = *swimmer.bodies.first()?;
    let made = |joint: &&usize| model.swimmer_of_joint(**joint).is_some();
    let joints: Vec<usize> =
        swimmer.bodies.iter().filter_map(|body| model.joint_above(*body)).collect();
    let is_read = |joint: &usize| {
        let kind = &model.joints[*joint].kind;
        matches!(kind, JointKind::Bent { angle: Stroke::Cubic(_) | Stroke::Cycle(_), .. })
    };
    if model.case.geometry != Geometry::Planar || !joints.iter().filter(made).any(is_read) {
        return None;
    }
    let name = &model.bodies[root].name;
    let (before, behind): (Vec<usize>, Vec<usize>) = joints
        .iter()
        .partition(|joint| model.body_index(&model.joints[**joint].child) < Some(root));
    let names = |joints: &[usize]| {
        let names = joints.iter().map(|joint| model.joints[*joint].child.as_str());
        names.collect::<Vec<_>>().join(", ")
    };
    if before.is_empty() || behind.is_empty() {
        return None;
    }
    Some(format!(
        "{}: where positive, what is away from {name} is turned counter-clockwise: {} to the left of the \
         heading, {} to its right; where all are angles of the front link less those of the link behind it, the latter \
         need sign = -1 in `file`",
        swimmer.name,
        names(&before),
        names(&behind)
    ))
}
