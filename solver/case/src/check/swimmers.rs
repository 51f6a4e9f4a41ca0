//! Problems of `[[joint]]` and `[[swimmer]]`: strokes, trees, and numbers that make no body.

use std::f64::consts::TAU;

use super::Findings;
use crate::joint::{PlanarPose, child_pose};
use crate::{
    Copies, FlowModel, Geometry, Hinge, JointKind, Motion, Pivot, Scheme, Stroke, SwimmerKind,
    TimeSettings,
};

/// Distance between a child and where its joint puts it, over the size of the joint, that is taken
/// for rounding.
const ROUNDING: f64 = 1e-6;

pub fn check(findings: &mut Findings<'_>) {
    joints(findings);
    swimmers(findings);
    explicit_scheme(findings);
}

fn joints(findings: &mut Findings<'_>) {
    let (case, model) = (findings.case(), findings.model());
    let mut parents: Vec<Option<usize>> = vec![None; model.bodies.len()];
    for (index, joint) in model.joints.iter().enumerate() {
        let key = format!("joint.{index}");
        let is_made = model.swimmer_of_joint(index).is_some();
        if !is_made {
            stroke_of_joint(findings, &key, &joint.kind);
        }
        let mut ends = [None; 2];
        for (end, (what, name)) in
            ends.iter_mut().zip([("parent", &joint.parent), ("child", &joint.child)])
        {
            *end = model.body_index(name);
            if end.is_none() {
                let names: Vec<&str> = model.bodies.iter().map(|body| body.name.as_str()).collect();
                findings.error(
                    &format!("{key}.{what}"),
                    format!("`{what}` is \"{name}\", but no body has that name"),
                    &crate::deserialize::suggestion(name, &names),
                );
            }
        }
        let [Some(parent), Some(child)] = ends else { continue };
        if parents[child].is_some() || parent == child {
            findings.error(
                &format!("{key}.child"),
                format!("\"{}\" hangs on two bodies, or on itself", joint.child),
                "bodies make trees: a body hangs on one other body at most",
            );
            continue;
        }
        parents[child] = Some(parent);
        if is_made {
            continue;
        }
        if model.bodies[child].motion != Motion::Free {
            findings.error(
                &format!("{key}.child"),
                format!(
                    "\"{}\" hangs on \"{}\", and cannot be held or moved besides",
                    joint.child, joint.parent
                ),
                "write motion = \"free\" for it; the body all others hang on may be held or moved",
            );
        }
        let pose = |body: usize| {
            let body = &model.bodies[body];
            let at = |axis: usize| body.center.get(axis).copied().unwrap_or(0.0);
            PlanarPose { center: [at(0), at(1)].into(), angle: body.angle }
        };
        let found = pose(child);
        // A free pivot may start at any angle: that of the bodies
        let bend = found.angle - pose(parent).angle;
        let kind = match &joint.kind {
            JointKind::Hinge(hinge) => JointKind::Hinge(Hinge { rest: bend, ..hinge.clone() }),
            kind => kind.clone(),
        };
        let wanted = child_pose(pose(parent), joint.on_parent, joint.on_child, &kind, 0.0);
        let size = (wanted.center - pose(parent).center).norm();
        let is_arm = matches!(joint.kind, JointKind::Arm { .. });
        let off = (wanted.center - found.center).norm();
        if off > ROUNDING * size {
            findings.error(
                &format!("{key}.child"),
                format!(
                    "the joint puts \"{}\" at [{}, {}] at time 0, not at [{}, {}]",
                    joint.child, wanted.center.x, wanted.center.y, found.center.x, found.center.y
                ),
                &format!("write center = [{}, {}] for it", wanted.center.x, wanted.center.y),
            );
        }
        let turned = (wanted.angle - found.angle + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
        if !is_arm && turned.abs() > ROUNDING && !matches!(joint.kind, JointKind::Hinge(_)) {
            findings.error(
                &format!("{key}.child"),
                format!(
                    "the joint turns \"{}\" to {} at time 0, not to {}",
                    joint.child, wanted.angle, found.angle
                ),
                &format!("write angle = {} for it", wanted.angle),
            );
        }
    }
    if (0..parents.len()).any(|start| {
        let mut body = start;
        (0..parents.len()).all(|_| {
            parents[body].is_some_and(|parent| {
                body = parent;
                true
            })
        })
    }) {
        findings.error(
            "joint",
            "the joints make a circle".to_owned(),
            "bodies make trees: one of them must hang on nothing",
        );
    }
    if case.geometry == Geometry::Axisymmetric {
        for (index, joint) in model.joints.iter().enumerate() {
            let is_along = match &joint.kind {
                JointKind::Arm { direction, .. } => direction.sin().abs() < 1e-9,
                JointKind::Bent { .. } | JointKind::Hinge(_) => false,
            };
            if !is_along || joint.on_parent[1] != 0.0 || joint.on_child[1] != 0.0 {
                findings.error(
                    &format!("joint.{index}.kind"),
                    format!("the joint of \"{}\" leaves the axis", joint.child),
                    "axisymmetric bodies hang on arms along the axis: direction = 0.0 or 3.141592653589793",
                );
            }
        }
    }
}

fn stroke_of_joint(findings: &mut Findings<'_>, key: &str, kind: &JointKind) {
    match kind {
        JointKind::Arm { length, .. } => {
            stroke(findings, &format!("{key}.kind.arm.length"), length);
            arm(findings, &format!("{key}.kind.arm.length"), length);
        }
        JointKind::Bent { angle } => stroke(findings, &format!("{key}.kind.bent.angle"), angle),
        JointKind::Hinge(one) => hinge(findings, &format!("{key}.kind.hinge"), one),
    }
}

fn hinge(findings: &mut Findings<'_>, key: &str, hinge: &Hinge) {
    findings.not_negative(&format!("{key}.stiffness"), hinge.stiffness);
    findings.not_negative(&format!("{key}.damping"), hinge.damping);
    if let Some(torque) = &hinge.torque {
        stroke(findings, &format!("{key}.torque"), torque);
    }
}

/// An arm has a positive length at all times.
fn arm(findings: &mut Findings<'_>, key: &str, length: &Stroke) {
    let [least, _] = length.range();
    if least <= 0.0 {
        findings.error(
            key,
            format!("the arm is as short as {least}"),
            "its length must be positive at all times",
        );
    }
}

/// Numbers of a stroke.
pub(super) fn stroke(findings: &mut Findings<'_>, key: &str, stroke: &Stroke) {
    match stroke {
        Stroke::Constant(_) => {}
        Stroke::Sine { period, ramp, .. } => {
            findings.positive(&format!("{key}.sine.period"), *period);
            findings.not_negative(&format!("{key}.sine.ramp"), *ramp);
        }
        Stroke::Legs { knots, period, .. } => {
            findings.positive(&format!("{key}.legs.period"), *period);
            let is_rising = knots.windows(2).all(|pair| pair[1][0] > pair[0][0]);
            let is_inside = knots.first().is_some_and(|knot| knot[0] == 0.0)
                && knots.last().is_some_and(|knot| knot[0] < *period);
            if !is_rising || !is_inside {
                findings.error(
                    &format!("{key}.legs.knots"),
                    "the times of the knots must rise from 0 to below the period".to_owned(),
                    "write knots = [[0.0, v0], [t1, v1], ...]; at the period the value is v0 again",
                );
            }
        }
        Stroke::Table(knots) => {
            let is_rising = knots.windows(2).all(|pair| pair[1][0] > pair[0][0]);
            if knots.is_empty() || !is_rising {
                findings.error(
                    &format!("{key}.table"),
                    "the times of a table must rise from knot to knot".to_owned(),
                    "write table = [[t0, v0], [t1, v1], ...] with t0 < t1 < ...",
                );
            }
        }
    }
}

fn swimmers(findings: &mut Findings<'_>) {
    let case = findings.case();
    let is_planar = case.geometry == Geometry::Planar;
    for (index, swimmer) in case.swimmer.iter().enumerate() {
        let key = format!("swimmer.{index}");
        if let Some(period) = swimmer.period {
            findings.positive(&format!("{key}.period"), period);
        }
        periods(findings, &key, &swimmer.kind, swimmer.period);
        if let Some(resistance) = swimmer.resistance {
            findings.positive(&format!("{key}.resistance"), resistance);
        }
        let mut planar_only = |name: &str| {
            if !is_planar {
                findings.error(
                    &format!("{key}.kind"),
                    format!("a {name} cannot stand in an axisymmetric case"),
                    "axisymmetric swimmers: body, linked-spheres, bodies",
                );
            }
        };
        match &swimmer.kind {
            SwimmerKind::Star { arms, radius, radii, .. } => {
                planar_only("star");
                if radii.is_empty() {
                    findings.error(
                        &format!("{key}.kind.star.radii"),
                        "a star without arms is a disc".to_owned(),
                        "give one radius or more",
                    );
                }
                for (nth, length) in arms.iter().enumerate() {
                    let key = format!("{key}.kind.star.arms.{nth}");
                    stroke(findings, &key, length);
                    arm(findings, &key, length);
                    if let Some(end) = radii.get(nth) {
                        reaches(findings, &key, length, radius + end);
                    }
                }
            }
            SwimmerKind::Chain { gap, joints, .. } => {
                planar_only("chain");
                findings.positive(&format!("{key}.kind.chain.gap"), *gap);
                for (nth, joint) in joints.iter().enumerate() {
                    let key = format!("{key}.kind.chain.joints.{nth}");
                    match joint {
                        Pivot::Bent { angle } => {
                            stroke(findings, &format!("{key}.bent.angle"), angle)
                        }
                        Pivot::Hinge(one) => hinge(findings, &format!("{key}.hinge"), one),
                    }
                }
            }
            SwimmerKind::LinkedSpheres { arms, radii, .. } => {
                if radii.len() < 2 {
                    findings.error(
                        &format!("{key}.kind.linked-spheres.radii"),
                        format!("{} sphere has nothing to be linked to", radii.len()),
                        "give two radii or more",
                    );
                }
                for (nth, length) in arms.iter().enumerate() {
                    let key = format!("{key}.kind.linked-spheres.arms.{nth}");
                    stroke(findings, &key, length);
                    arm(findings, &key, length);
                    if let [Some(left), Some(right)] = [radii.get(nth), radii.get(nth + 1)] {
                        reaches(findings, &key, length, left + right);
                    }
                }
            }
            SwimmerKind::Bodies(names) => {
                let mut sorted = names.clone();
                sorted.sort();
                sorted.dedup();
                if names.is_empty() || sorted.len() < names.len() {
                    findings.error(
                        &format!("{key}.kind.bodies"),
                        "a swimmer is made of one body or more, each named once".to_owned(),
                        "write bodies = [\"NAME\", ...] with names of [[body]]",
                    );
                }
                let idle = [
                    ("center", swimmer.center != [0.0; 2]),
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
            SwimmerKind::Body { .. } => {}
        }
        match &swimmer.copies {
            Some(Copies::Random { count, gap, .. }) => {
                findings.not_negative(&format!("{key}.copies.random.gap"), *gap);
                none(findings, &format!("{key}.copies.random.count"), *count);
            }
            Some(Copies::Lattice { counts, .. }) => {
                none(findings, &format!("{key}.copies.lattice.counts"), counts[0] * counts[1]);
            }
            None => {}
        }
    }
    short_steps(findings);
    let model = findings.model();
    let mut names: Vec<&str> = model.bodies.iter().map(|body| body.name.as_str()).collect();
    for group in &model.swimmers {
        let is_body = matches!(group.bodies[..], [body] if model.bodies[body].name == group.name);
        let is_side = case.domain.sides().contains(&group.name.as_str());
        if !is_body && (names.contains(&group.name.as_str()) || is_side) {
            findings.error(
                "swimmer",
                format!("the name \"{}\" is taken by a body, a swimmer or a side", group.name),
                "give every body and every swimmer a name of its own",
            );
        }
        names.push(&group.name);
    }
}

/// Copies that make no swimmer.
fn none(findings: &mut Findings<'_>, key: &str, count: usize) {
    if count == 0 {
        let message = format!("`{key}` makes no swimmer at all");
        findings.error(key, message, "write 1 or more, or leave the swimmer out");
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
    if unsteady.adaptive.is_some() {
        return;
    }
    let periods = findings.model().swimmers.iter().filter_map(|group| group.period);
    let shortest = periods.fold(f64::INFINITY, f64::min);
    if unsteady.step * FEWEST_STEPS > shortest {
        findings.warning(
            "time.unsteady.step",
            format!("a cycle of {shortest} has {:.1} steps only", shortest / unsteady.step),
            "take steps of a tenth of a cycle or less, and compare with half of that",
        );
    }
}

/// Steps of a cycle below which you are warned.
const FEWEST_STEPS: f64 = 10.0;

/// The explicit method has no inertia, no contact and nothing stiff.
fn explicit_scheme(findings: &mut Findings<'_>) {
    let case = findings.case();
    let TimeSettings::Unsteady(unsteady) = &case.time else { return };
    if unsteady.scheme != Scheme::Rk3 {
        return;
    }
    let model = findings.model();
    let is_stiff = model
        .joints
        .iter()
        .any(|joint| matches!(&joint.kind, JointKind::Hinge(hinge) if hinge.stiffness > 0.0));
    let hinders = [
        (case.fluid.model != FlowModel::Stokes, "the model has inertia"),
        (case.contact.is_some(), "there is [contact]"),
        (model.bodies.iter().any(|body| body.spring.is_some()), "there are springs"),
        (is_stiff, "there are hinges with stiffness"),
    ];
    for (_, why) in hinders.iter().filter(|(hinders, _)| *hinders) {
        findings.error(
            "time.unsteady.scheme",
            format!("the scheme `rk3` cannot be used: {why}"),
            "leave it out for `bdf2`, or write model = \"stokes\" without contact, springs and stiffness",
        );
    }
}
