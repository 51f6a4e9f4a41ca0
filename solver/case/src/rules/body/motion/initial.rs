//! Problems of `body.velocity` and `body.angular_velocity`, the motion of a free body at time zero.

use crate::rules::Findings;
use crate::{Body, FlowModel, Geometry, Initial, JointKind, Lock, Model, Motion, TimeSettings};

pub fn check(findings: &mut Findings<'_>, index: usize, body: &Body) {
    let is_given = |key: &str| match key {
        "velocity" => body.velocity.iter().any(|part| *part != 0.0),
        _ => !body.angular_velocity.is_zero(),
    };
    for key in ["velocity", "angular_velocity"].into_iter().filter(|key| is_given(key)) {
        let key = format!("body.{index}.{key}");
        if let Some([message, help]) = refusal(findings.model(), index, &key) {
            findings.error(&key, message, &help);
        }
    }
    check_locks(findings, index, body);
}

/// Why a body cannot start with a velocity of its own, and what helps.
fn refusal(model: &Model, index: usize, key: &str) -> Option<[String; 2]> {
    let (case, body) = (&model.case, &model.bodies[index]);
    let name = &body.name;
    let refused = |message: String, help: &str| Some([message, help.to_owned()]);
    if body.motion != Motion::Free {
        return refused(
            format!("`{key}` is that of a free body at time zero, and \"{name}\" is not free"),
            "write motion = \"free\", or motion.imposed = { velocity = [...], angular_velocity = ... }",
        );
    }
    let TimeSettings::Unsteady(time) = &case.time else {
        return refused(
            format!("\"{name}\" starts with a velocity, and a steady flow has no start"),
            "use [time.unsteady], or write motion.imposed.velocity = [...]",
        );
    };
    if case.fluid.model == FlowModel::Stokes {
        return refused(
            format!("\"{name}\" starts with a velocity, and without inertia no velocity lasts"),
            "take fluid.model = \"navier-stokes\" or \"unsteady-stokes\", or leave it out",
        );
    }
    if time.initial == Initial::Stokes {
        return refused(
            format!(
                "\"{name}\" starts with a velocity, and time.unsteady.initial = \"stokes\" with none"
            ),
            "leave time.unsteady.initial out: the fluid starts as an impulse on the bodies makes it",
        );
    }
    if body.rod.is_some() {
        return refused(
            format!("\"{name}\" bends by itself, and starts at rest"),
            "leave it out; give [body.activation] or a force to set it in motion",
        );
    }
    let joint = &model.joints[model.joint_above(index)?];
    let may_turn = matches!(joint.kind, JointKind::Hinge(_) | JointKind::Ball(_));
    if key.ends_with(".velocity") || !may_turn {
        return refused(
            format!("\"{name}\" hangs on \"{}\" and starts with it", joint.parent),
            if may_turn {
                "give the body that all hang on a velocity, and this one an angular_velocity at most"
            } else {
                "give the body that all hang on a velocity"
            },
        );
    }
    None
}

/// A motion that is locked does not begin.
fn check_locks(findings: &mut Findings<'_>, index: usize, body: &Body) {
    let begins = |lock: &Lock| match lock {
        Lock::X => body.velocity.first().is_some_and(|part| *part != 0.0),
        Lock::Y => body.velocity.get(1).is_some_and(|part| *part != 0.0),
        Lock::Z => body.velocity.get(2).is_some_and(|part| *part != 0.0),
        Lock::Rotation => !body.angular_velocity.is_zero(),
    };
    if body.motion != Motion::Free || findings.case().geometry == Geometry::Axisymmetric {
        return;
    }
    for lock in body.locked.iter().filter(|lock| begins(lock)) {
        let key = if *lock == Lock::Rotation { "angular_velocity" } else { "velocity" };
        findings.error(
            &format!("body.{index}.{key}"),
            format!("\"{}\" starts with a motion that `locked` does not let it make", body.name),
            "write 0.0 for it, or unlock the motion",
        );
    }
}

#[cfg(test)]
mod tests {
    use crate::{Case, check};

    /// Keys of the problems of a case with these settings.
    fn wrong(geometry: &str, settings: &[&str]) -> Vec<String> {
        let is_flat = geometry == "planar";
        let (shape, domain) = if is_flat {
            ("disc", "disc = { radius = 4.0 }")
        } else {
            ("sphere", "half-disc = { radius = 4.0 }")
        };
        let text = format!(
            "title = 't'
geometry = '{geometry}'
fluid = {{ model = 'navier-stokes', viscosity = 1.0, density = 1.0 }}
domain.{domain}
boundary.wall = 'no-slip'
mesh.size = 0.3
time.unsteady = {{ step = 0.1, end = 1.0 }}
[[body]]
name = 'b'
shape.{shape}.radius = 1.0
center = [0.0, 0.0]
motion = 'free'
"
        );
        let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
        let file = Case::parse("t.toml", &text, &settings).unwrap();
        check(&file).into_iter().map(|found| found.key).collect()
    }

    #[test]
    fn free_bodies_with_inertia_may_start_with_a_velocity() {
        let none = Vec::<String>::new();
        assert_eq!(wrong("planar", &["body.0.velocity=[1.0, 0.0]"]), none);
        assert_eq!(wrong("planar", &["body.0.angular_velocity=-2.0"]), none);
        assert_eq!(wrong("axisymmetric", &["body.0.velocity=[1.0, 0.0]"]), none);
    }

    #[test]
    fn what_does_not_start_with_a_velocity_is_refused() {
        let velocity = "body.0.velocity=[1.0, 0.0]";
        for setting in [
            "body.0.motion='held'",
            "time={ steady = {} }",
            "fluid.model='stokes'",
            "time.unsteady.initial='stokes'",
            "body.0.locked=['x']",
        ] {
            let found = wrong("planar", &[velocity, setting]);
            assert!(found.contains(&"body.0.velocity".to_owned()), "{setting}: {found:?}");
        }
        let turned = ["body.0.angular_velocity=1.0", "body.0.locked=['rotation']"];
        assert_eq!(wrong("planar", &turned), ["body.0.angular_velocity"]);
        assert_eq!(wrong("axisymmetric", &["body.0.velocity=[0.0, 1.0]"]), ["body.0.velocity.1"]);
        let spin = wrong("axisymmetric", &["body.0.angular_velocity=1.0"]);
        assert_eq!(spin, ["body.0.angular_velocity"]);
        let tilted = wrong("planar", &["body.0.angular_velocity=[1.0, 0.0, 0.0]"]);
        assert_eq!(tilted, ["body.0.angular_velocity"]);
        assert_eq!(wrong("planar", &["body.0.velocity=[1.0]"]), ["body.0.velocity"]);
    }
}
