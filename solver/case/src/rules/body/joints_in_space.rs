//! Problems of `[[joint]]` in space: directions, and where children are.

use crate::rules::Findings;
use crate::{Joint, JointKind};

/// Distance between a child and where its joint puts it, over the size of the joint, that is taken
/// for rounding.
const ROUNDING: f64 = 1e-6;

/// In space a joint has a direction to move along or to turn about.
pub(crate) fn direction(findings: &mut Findings<'_>, key: &str, kind: &JointKind) {
    let (name, along, what) = match kind {
        JointKind::Arm { along, .. } => ("arm.along", along, "an arm"),
        JointKind::Slider(slider) => ("slider.along", &slider.along, "an arm"),
        JointKind::Bent { axis, .. } => ("bent.axis", axis, "a pivot"),
        JointKind::Hinge(hinge) => ("hinge.axis", &hinge.axis, "a hinge"),
        JointKind::Ball(_) => return,
    };
    if along.is_none() {
        let (_, own) = name.split_once('.').unwrap_or_default();
        findings.error(
            &format!("{key}.kind.{name}"),
            format!("{what} in three dimensions needs a direction"),
            &format!("write {own} = [x, y, z], in the frame of the parent"),
        );
    }
}

/// The child starts where the joint puts it; how it is turned then is what the joint keeps.
pub(crate) fn place_of_child(
    findings: &mut Findings<'_>,
    key: &str,
    joint: &Joint,
    parent: Option<usize>,
    child: usize,
) {
    let body = &findings.model().bodies[child];
    let (child, reach) = (body.pose_in_space(), body.shape.reach());
    let of_parent = parent.map(|parent| findings.model().bodies[parent].pose_in_space());
    let parent = of_parent.unwrap_or_else(nalgebra::Isometry3::identity);
    let wanted = joint.child_center(&parent, &child);
    let found = child.translation.vector;
    let size = (wanted - parent.translation.vector).norm();
    let size = if of_parent.is_none() { size.max(reach) } else { size };
    // Written so that what is no number is left to the checks of numbers
    if (wanted - found).norm() > ROUNDING * size {
        let list =
            |point: nalgebra::Vector3<f64>| format!("[{}, {}, {}]", point.x, point.y, point.z);
        findings.error(
            &format!("{key}.child"),
            format!(
                "the joint puts \"{}\" at {} at time 0, not at {}",
                joint.child,
                list(wanted),
                list(found)
            ),
            &format!("write center = {} for it", list(wanted)),
        );
    }
}

#[cfg(test)]
mod tests {
    use crate::{Case, check};

    /// Keys of the errors in a case of two spheres with this joint.
    fn wrong(joint: &str) -> Vec<String> {
        let text = format!(
            "title = 't'
geometry = 'spatial'
fluid = {{ model = 'stokes', viscosity = 1.0 }}
domain.sphere.radius = 9.0
boundary = {{ wall = 'no-slip' }}
mesh = {{ size = 1.0, surface = 0.08 }}
time.unsteady = {{ step = 0.1, end = 1.0 }}
body = [
    {{ name = 'a', shape.sphere.radius = 0.5, center = [0.0, 0.0, 0.0], motion = 'free' }},
    {{ name = 'b', shape.sphere.radius = 0.5, center = [0.0, 1.2, 1.6], motion = 'free' }},
]
[[joint]]
parent = 'a'
child = 'b'
{joint}
"
        );
        let file = Case::parse("t.toml", &text, &[]).unwrap();
        check(&file).into_iter().map(|found| found.key).collect()
    }

    #[test]
    fn joints_in_space_have_directions_in_space() {
        for joint in [
            "kind.arm = { length.constant = 2.0, along = [0.0, 3.0, 4.0] }",
            "kind.ball.stiffness = 1.0\non_parent = [0.0, 0.6, 0.8]\non_child = [0.0, -0.6, -0.8]",
            "kind.hinge = { axis = [0.0, 0.0, 1.0], torque.constant = 0.1 }\non_parent = [0.0, 1.2, 1.6]",
            "kind.bent = { angle.constant = 0.1, axis = [1.0, 0.0, 0.0] }\non_parent = [0.0, 1.2, 1.6]",
            "kind.slider = { along = [0, 3, 4], stiffness = 1.0, rest = 3.0, force.constant = 0.1 }",
            "kind.slider.along = [0.0, 0.0, -1.0]\non_parent = [0.0, 1.2, 0.3]",
        ] {
            assert_eq!(wrong(joint), [""; 0], "{joint}");
        }
        for (joint, key) in [
            ("kind.arm = { length.constant = 2.0 }", "joint.0.kind.arm.along"),
            (
                "kind.arm = { length.constant = 2.0, along = [0, 3, 4], direction = 0.3 }",
                "joint.0.kind.arm.direction",
            ),
            ("kind.arm = { length.constant = 2.0, along = [0, 0, 1] }", "joint.0.child"),
            (
                "kind.bent = { angle.constant = 0.1 }\non_parent = [0.0, 1.2, 1.6]",
                "joint.0.kind.bent.axis",
            ),
            ("kind.slider = {}", "joint.0.kind.slider.along"),
            ("kind.slider = { along = [0, 3, 4], direction = 1 }", "joint.0.kind.slider.direction"),
            ("kind.slider.along = [0.0, 0.0, 1.0]", "joint.0.child"),
            ("kind.slider = { along = [0, 3, 4], damping = -1 }", "joint.0.kind.slider.damping"),
            (
                "kind.slider = { along = [0, 3, 4], stiffness = -1 }",
                "joint.0.kind.slider.stiffness",
            ),
            (
                "kind.slider = { along = [0, 3, 4], force.sine = { amplitude = 1.0, period = 0.0 } }",
                "joint.0.kind.slider.force.sine.period",
            ),
            ("kind.ball = {}\non_parent = [1.2, 1.6]", "joint.0.on_parent"),
            ("kind.ball.damping = -1.0\non_parent = [0.0, 1.2, 1.6]", "joint.0.kind.ball.damping"),
            ("kind.hinge = {}\non_parent = [0.0, 1.2, 1.6]", "joint.0.kind.hinge.axis"),
        ] {
            assert!(wrong(joint).contains(&key.to_owned()), "{joint}: {:?}", wrong(joint));
        }
    }
}
