//! Problems of `[[swimmer]]`: numbers of parts, cycles, names, and the explicit scheme.

use std::collections::HashSet;

use super::bodies::check_word;
use super::joints::{arm, hinge, stroke};
use super::skin;
use crate::rules::Findings;
use crate::rules::space::check_orientation;
use crate::{
    FlowModel, Geometry, Motion, Pivot, Scheme, Stroke, SwimmerKind, SwimmerSpec, TimeSettings,
};

pub fn check(findings: &mut Findings<'_>) {
    for (index, swimmer) in findings.case().swimmer.iter().enumerate() {
        let key = format!("swimmer.{index}");
        check_word(findings, &format!("{key}.name"), &swimmer.name);
        periods(findings, &key, &swimmer.kind, swimmer.period);
        if let Some(orientation) = &swimmer.orientation {
            check_orientation(findings, &format!("{key}.orientation"), orientation);
        }
        parts(findings, &key, swimmer);
    }
    short_steps(findings);
    names(findings);
    explicit_scheme(findings);
}

/// The bodies and joints a swimmer is made of.
fn parts(findings: &mut Findings<'_>, key: &str, swimmer: &SwimmerSpec) {
    match &swimmer.kind {
        SwimmerKind::Star { arms, radius, radii, .. } => {
            for (nth, length) in arms.iter().enumerate() {
                let sum = radii.get(nth).map(|end| radius + end);
                arm_of_swimmer(findings, &format!("{key}.kind.star.arms.{nth}"), length, sum);
            }
        }
        SwimmerKind::Chain { links, gap, joints, skin } => {
            if let Some(skin) = skin.filter(|_| findings.case().geometry == Geometry::Planar) {
                let (key, gap) = (&format!("{key}.kind.chain"), *gap);
                skin::check(findings, &skin::Chain { key, links, gap, joints, skin });
            }
            for (nth, joint) in joints.iter().enumerate() {
                let key = format!("{key}.kind.chain.joints.{nth}");
                match joint {
                    Pivot::Bent { angle } => stroke(findings, &format!("{key}.bent.angle"), angle),
                    Pivot::Hinge(one) => hinge(findings, &format!("{key}.hinge"), one),
                }
            }
        }
        SwimmerKind::LinkedSpheres { arms, radii, .. } => {
            for (nth, length) in arms.iter().enumerate() {
                let key = format!("{key}.kind.linked-spheres.arms.{nth}");
                let sum = radii.get(nth).zip(radii.get(nth + 1)).map(|(left, right)| left + right);
                arm_of_swimmer(findings, &key, length, sum);
            }
        }
        SwimmerKind::Bodies(names) => group(findings, key, swimmer, names),
        SwimmerKind::Body { .. } => {}
    }
}

/// An arm between round bodies whose radii have a known sum (m).
fn arm_of_swimmer(findings: &mut Findings<'_>, key: &str, length: &Stroke, radii: Option<f64>) {
    stroke(findings, key, length);
    arm(findings, key, length);
    if let Some(radii) = radii {
        reaches(findings, key, length, radii);
    }
}

/// A swimmer made of bodies that have names of their own.
fn group(findings: &mut Findings<'_>, key: &str, swimmer: &SwimmerSpec, names: &[String]) {
    let distinct: HashSet<&String> = names.iter().collect();
    if names.is_empty() || distinct.len() < names.len() {
        findings.error(
            &format!("{key}.kind.bodies"),
            "a swimmer is made of one body or more, each named once".to_owned(),
            "write bodies = [\"NAME\", ...] with names of [[body]]",
        );
    }
    let idle = [
        ("center", swimmer.center.iter().any(|along| *along != 0.0)),
        ("orientation", swimmer.orientation.is_some()),
        ("angle", swimmer.angle != 0.0),
        ("density", swimmer.density.is_some()),
        ("motion", swimmer.motion != Motion::Free),
        ("size", swimmer.size.is_some()),
        ("copies", swimmer.copies.is_some()),
    ];
    for (name, _) in idle.iter().filter(|(_, is_given)| *is_given) {
        findings.error(
            &format!("{key}.{name}"),
            format!("`{name}` has no effect on bodies that are there already"),
            "leave it out, and write it for the bodies themselves",
        );
    }
}

/// A swimmer has a name of its own, but for that of its only body.
fn names(findings: &mut Findings<'_>) {
    let (case, model) = (findings.case(), findings.model());
    let mut taken: HashSet<&str> = model.bodies.iter().map(|body| body.name.as_str()).collect();
    for group in &model.swimmers {
        let name = group.name.as_str();
        let is_body = matches!(group.bodies[..], [body] if model.bodies[body].name == name);
        if !is_body && (taken.contains(name) || case.sides().contains(&name)) {
            findings.error(
                "swimmer",
                format!("the name \"{name}\" is taken by a body, a swimmer or a side"),
                "give every body and every swimmer a name of its own",
            );
        }
        taken.insert(name);
    }
}

/// Round bodies at the ends of an arm must not meet.
fn reaches(findings: &mut Findings<'_>, key: &str, length: &Stroke, radii: f64) {
    let [least, _] = length.range();
    if least > 0.0 && least <= radii {
        findings.error(
            key,
            format!("the arm is as short as {least}, and the radii at its ends sum up to {radii}"),
            "keep it longer than that at all times, with room for cells in the gap",
        );
    }
}

/// Strokes with different periods have no cycle in common, unless one is named.
fn periods(findings: &mut Findings<'_>, key: &str, kind: &SwimmerKind, named: Option<f64>) {
    let strokes: Vec<&Stroke> = match kind {
        SwimmerKind::LinkedSpheres { arms, .. } | SwimmerKind::Star { arms, .. } => {
            arms.iter().collect()
        }
        SwimmerKind::Chain { joints, .. } => joints
            .iter()
            .filter_map(|joint| match joint {
                Pivot::Bent { angle } => Some(angle),
                Pivot::Hinge(hinge) => hinge.torque.as_ref(),
            })
            .collect(),
        SwimmerKind::Body { .. } | SwimmerKind::Bodies(_) => Vec::new(),
    };
    let found: Vec<f64> = strokes.iter().filter_map(|stroke| stroke.period()).collect();
    let Some(&first) = found.first() else { return };
    if named.is_none() && found.iter().any(|other| (other - first).abs() > 1e-9 * first) {
        findings.warning(
            &format!("{key}.kind"),
            format!("the strokes have different periods, and cycles are taken to be of {first}"),
            "write period = ... for the swimmer: the time after which all of them begin again",
        );
    }
}

/// Steps so long that nothing of a cycle is left.
fn short_steps(findings: &mut Findings<'_>) {
    let case = findings.case();
    let TimeSettings::Unsteady(unsteady) = &case.time else { return };
    // Steps that are none are refused elsewhere
    if unsteady.adaptive.is_some() || unsteady.step <= 0.0 {
        return;
    }
    let periods = findings.model().swimmers.iter().filter_map(|group| group.period);
    let shortest = periods.fold(f64::INFINITY, f64::min);
    // A period that is none is refused as well
    if shortest > 0.0 && unsteady.step * FEWEST_STEPS > shortest {
        findings.warning(
            "time.unsteady.step",
            if shortest < unsteady.step {
                format!("a cycle of {shortest} is shorter than a step of {}", unsteady.step)
            } else {
                format!("a cycle of {shortest} has {:.1} steps only", shortest / unsteady.step)
            },
            "take steps of a tenth of a cycle or less, and compare with half of that",
        );
    }
}

/// Steps of a cycle below which you are warned.
const FEWEST_STEPS: f64 = 10.0;

/// The explicit method has no inertia and nothing stiff.
fn explicit_scheme(findings: &mut Findings<'_>) {
    let case = findings.case();
    let TimeSettings::Unsteady(unsteady) = &case.time else { return };
    if unsteady.scheme != Scheme::Rk3 {
        return;
    }
    let model = findings.model();
    let is_stiff = model.joints.iter().any(|joint| joint.kind.stiffness() > 0.0);
    let hinders = [
        (
            case.fluid.model != FlowModel::Stokes,
            "the model has inertia",
            "leave `scheme` out for `bdf2`, or write model = \"stokes\"",
        ),
        (
            model.bodies.iter().any(|body| body.spring.is_some()),
            "there are springs",
            "leave `scheme` out for `bdf2`, or leave the springs out",
        ),
        (
            is_stiff,
            "there are joints with stiffness",
            "leave `scheme` out for `bdf2`, or write stiffness = 0.0",
        ),
    ];
    for (_, why, remedy) in hinders.iter().filter(|(hinders, _, _)| *hinders) {
        findings.error(
            "time.unsteady.scheme",
            format!("the scheme `rk3` cannot be used: {why}"),
            remedy,
        );
    }
}
