//! Problems of tendons, servos, a keel and ellipsoids of a reduced model.

use super::is_a_body;
use super::parts::vector;
use crate::rules::Findings;
use crate::rules::space::check_orientation;
use crate::{FlowModel, Geometry, JointKind, LoadLaw, Motion, ReducedSpec, ServoSpec, TendonSpec};

pub fn check(findings: &mut Findings<'_>, spec: &ReducedSpec) {
    let is_slow = findings.case().fluid.model == FlowModel::Stokes;
    for (name, is_there) in [
        ("tendon", !spec.tendon.is_empty()),
        ("servo", !spec.servo.is_empty()),
        ("armature", !spec.armature.is_empty()),
        ("keel", spec.keel.is_some()),
    ] {
        if is_there && is_slow {
            findings.error(
                &format!("reduced.{name}"),
                format!("`{name}` needs a fluid with inertia"),
                "leave it out, or take fluid.model = \"navier-stokes\"",
            );
        }
    }
    for (index, tendon) in spec.tendon.iter().enumerate() {
        let key = format!("reduced.tendon.{index}");
        if spec.tendon[..index].iter().any(|other| other.name == tendon.name) {
            let message = format!("two tendons are called \"{}\"", tendon.name);
            findings.error(&format!("{key}.name"), message, "give each its own name");
        }
        check_tendon(findings, &key, tendon);
    }
    for (index, servo) in spec.servo.iter().enumerate() {
        let key = format!("reduced.servo.{index}");
        if spec.servo[..index].iter().any(|other| other.joint == servo.joint) {
            let message = format!("two servos drive the joint of \"{}\"", servo.joint);
            findings.error(&format!("{key}.joint"), message, "leave one out");
        }
        check_servo(findings, &key, servo);
    }
    for (name, value) in &spec.armature {
        let key = format!("reduced.armature.{name}");
        amount(findings, &key, *value, true);
        let joint = findings.model().joints.iter().find(|joint| joint.child == *name);
        if !joint.is_some_and(|joint| moves_freely(&joint.kind)) {
            let message = format!("\"{name}\" is not below a hinge or a slider");
            let help = below_free_joints(findings);
            findings.error(&key, message, &help);
        }
    }
    keel(findings, spec);
    ellipsoids(findings, spec);
}

/// A number that is finite and above zero, or at least zero, which is told where it is not, once.
fn amount(findings: &mut Findings<'_>, key: &str, value: f64, may_be_zero: bool) {
    let is_amount = value.is_finite() && (value > 0.0 || may_be_zero && value == 0.0);
    if !is_amount && findings.is_right(key) {
        let help = if may_be_zero { "a number of 0 or more" } else { "a number above 0" };
        findings.error(key, format!("`{key}` is {value}"), help);
    }
}

fn check_tendon(findings: &mut Findings<'_>, key: &str, tendon: &TendonSpec) {
    amount(findings, &format!("{key}.stiffness"), tendon.stiffness, false);
    amount(findings, &format!("{key}.damping"), tendon.damping, true);
    if let Some(rest) = tendon.rest {
        amount(findings, &format!("{key}.rest"), rest, false);
    }
    if tendon.sites.len() < 2 {
        let message = format!("\"{}\" goes through fewer than two points", tendon.name);
        let help = "write sites = [{ body = NAME, position = [...] }, ...]";
        findings.error(&format!("{key}.sites"), message, help);
    }
    for (nth, site) in tendon.sites.iter().enumerate() {
        let key = format!("{key}.sites.{nth}");
        is_a_body(findings, &format!("{key}.body"), &site.body);
        vector(findings, &format!("{key}.position"), &site.position);
    }
}

fn check_servo(findings: &mut Findings<'_>, key: &str, servo: &ServoSpec) {
    amount(findings, &format!("{key}.gain"), servo.gain, false);
    if let Some(limit) = servo.limit {
        amount(findings, &format!("{key}.limit"), limit, false);
    }
    if !servo.rate.is_finite() {
        findings.error(&format!("{key}.rate"), format!("it is {}", servo.rate), "a number");
    }
    let joint = findings.model().joints.iter().find(|joint| joint.child == servo.joint);
    let is_free = joint.is_some_and(|joint| match &joint.kind {
        JointKind::Hinge(hinge) => hinge.torque.is_none(),
        JointKind::Slider(slider) => slider.force.is_none(),
        _ => false,
    });
    if !is_free {
        let message =
            format!("\"{}\" is not below a hinge or a slider without a motor", servo.joint);
        let help = below_free_joints(findings);
        findings.error(&format!("{key}.joint"), message, &help);
    }
}

fn moves_freely(kind: &JointKind) -> bool {
    matches!(kind, JointKind::Hinge(_) | JointKind::Slider(_))
}

/// The bodies that joints with a coordinate of their own are named by.
fn below_free_joints(findings: &Findings<'_>) -> String {
    let joints = findings.model().joints.iter().filter(|joint| moves_freely(&joint.kind));
    let names: Vec<&str> = joints.map(|joint| joint.child.as_str()).collect();
    format!("bodies below hinges and sliders: {}", names.join(", "))
}

fn keel(findings: &mut Findings<'_>, spec: &ReducedSpec) {
    let Some(keel) = &spec.keel else { return };
    for (name, value) in [
        ("heave_stiffness", keel.heave_stiffness),
        ("heave_damping", keel.heave_damping),
        ("tilt_stiffness", keel.tilt_stiffness),
        ("tilt_damping", keel.tilt_damping),
    ] {
        amount(findings, &format!("reduced.keel.{name}"), value, true);
    }
    if let Some(position) = &keel.position {
        vector(findings, "reduced.keel.position", position);
    }
    if findings.case().geometry != Geometry::Spatial {
        let message = "a keel is of a case in three dimensions".to_owned();
        findings.error("reduced.keel", message, "leave it out, or write geometry = \"spatial\"");
        return;
    }
    let model = findings.model();
    let root = (0..model.bodies.len()).find(|body| model.joint_above(*body).is_none());
    let is_free = root.is_some_and(|root| {
        let body = &model.bodies[root];
        let is_guided = !body.locked.is_empty() || !body.driven.is_empty() || body.spring.is_some();
        body.motion == Motion::Free && !is_guided
    });
    let starts = model.bodies.iter().any(|body| {
        !body.angular_velocity.is_zero() || body.velocity.iter().any(|part| *part != 0.0)
    });
    if !is_free {
        let message = "a keel is of a first body that is free".to_owned();
        findings.error("reduced.keel", message, "leave it out, or write motion = \"free\"");
    } else if starts {
        let message = "a swimmer with a keel starts at rest".to_owned();
        findings.error("reduced.keel", message, "leave out `velocity` and `angular_velocity`");
    }
}

fn ellipsoids(findings: &mut Findings<'_>, spec: &ReducedSpec) {
    for (index, ellipsoid) in spec.ellipsoid.iter().enumerate() {
        let key = format!("reduced.ellipsoid.{index}");
        is_a_body(findings, &format!("{key}.body"), &ellipsoid.body);
        vector(findings, &format!("{key}.position"), &ellipsoid.position);
        for value in ellipsoid.semi_axes {
            amount(findings, &format!("{key}.semi_axes"), value, false);
        }
        if let Some(orientation) = &ellipsoid.orientation {
            check_orientation(findings, &format!("{key}.orientation"), orientation);
        }
    }
    if !spec.ellipsoid.is_empty() && spec.loads != LoadLaw::Ellipsoid {
        let message = format!("the law \"{}\" takes no ellipsoids", spec.loads.name());
        let help = "leave them out, or write loads = \"ellipsoid\"";
        findings.error("reduced.ellipsoid", message, help);
    }
}
