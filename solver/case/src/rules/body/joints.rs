//! Problems of `[[joint]]`: ends, trees, poses at the start, and numbers of strokes.

use std::f64::consts::TAU;

use super::joints_in_space::{direction, place_of_child};
use crate::model::numbers::significant;
use crate::rules::Findings;
use crate::rules::command::check_command;
use crate::spec::body::joint::{LABORATORY, PlanarPose, child_pose};
use crate::spec::body::stroke::Cycle;
use crate::{Geometry, Hinge, Joint, JointKind, Model, Motion, Slider, Stroke, TimeSettings};

/// Distance between a child and where its joint puts it, over the size of the joint, that is taken
/// for rounding.
const ROUNDING: f64 = 1e-6;

pub fn check(findings: &mut Findings<'_>) {
    let model = findings.model();
    let mut parents: Vec<Option<usize>> = vec![None; model.bodies.len()];
    let mut is_joined = vec![false; model.bodies.len()];
    let mut attached = Vec::new();
    for (index, joint) in model.joints.iter().enumerate() {
        let key = format!("joint.{index}");
        if model.swimmer_of_joint(index).is_none() {
            stroke_of_joint(findings, &key, &joint.kind);
            if findings.case().geometry == Geometry::Spatial {
                direction(findings, &key, &joint.kind);
            }
        }
        let Some(ends) = ends(findings, &key, joint) else { continue };
        if is_joined[ends.child] || ends.parent == Some(ends.child) {
            findings.error(
                &format!("{key}.child"),
                if ends.parent == Some(ends.child) {
                    format!("\"{}\" hangs on itself", joint.child)
                } else {
                    let above = parents[ends.child].map(|parent| &model.bodies[parent].name);
                    let above = above.map_or("another body", String::as_str);
                    format!(
                        "\"{}\" hangs on \"{}\", and on \"{above}\" already",
                        joint.child, joint.parent
                    )
                },
                "bodies make trees: a body hangs on one other body at most",
            );
            continue;
        }
        parents[ends.child] = ends.parent;
        is_joined[ends.child] = true;
        attached.push((index, ends));
    }
    // Within a loop no body is where its joint puts it
    if let Some(bodies) = find_loop(&parents) {
        loop_of_joints(findings, &bodies);
        return;
    }
    for (index, ends) in attached {
        if model.swimmer_of_joint(index).is_none() {
            let (key, joint) = (format!("joint.{index}"), &model.joints[index]);
            motion_of_child(findings, &key, joint, ends);
            if findings.case().geometry == Geometry::Spatial {
                place_of_child(findings, &key, joint, ends.parent, ends.child);
            } else {
                pose_of_child(findings, &key, joint, ends);
            }
        }
    }
    if findings.case().geometry == Geometry::Axisymmetric {
        along_the_axis(findings);
    }
}

/// Bodies that hang on each other in a loop.
fn loop_of_joints(findings: &mut Findings<'_>, bodies: &[usize]) {
    let model = findings.model();
    let names: Vec<String> = bodies
        .iter()
        .chain(bodies.first())
        .map(|body| format!("\"{}\"", model.bodies[*body].name))
        .collect();
    let joint = bodies.iter().find_map(|body| model.joint_above(*body));
    findings.error(
        &joint.map_or_else(|| "joint".to_owned(), |joint| format!("joint.{joint}")),
        format!("the joints make a loop: {}", names.join(" hangs on ")),
        "bodies make trees: one of them must hang on nothing; leave out one of these joints",
    );
}

/// Indices of the bodies a joint is between; no parent where the child hangs on the laboratory.
#[derive(Clone, Copy)]
struct Ends {
    parent: Option<usize>,
    child: usize,
}

fn ends(findings: &mut Findings<'_>, key: &str, joint: &Joint) -> Option<Ends> {
    let model = findings.model();
    let mut end = |what: &str, name: &str| {
        let body = model.body_index(name);
        if body.is_none() {
            let mut names: Vec<&str> = model.bodies.iter().map(|body| body.name.as_str()).collect();
            if what == "parent" {
                names.push(LABORATORY);
            }
            findings.error(
                &format!("{key}.{what}"),
                format!("`{what}` is \"{name}\", but no body has that name"),
                &crate::text::type_error::suggestion(name, &names),
            );
        }
        body
    };
    if model.hangs_on_laboratory(joint) {
        return Some(Ends { parent: None, child: end("child", &joint.child)? });
    }
    let (parent, child) = (end("parent", &joint.parent), end("child", &joint.child));
    Some(Ends { parent: Some(parent?), child: child? })
}

fn motion_of_child(findings: &mut Findings<'_>, key: &str, joint: &Joint, ends: Ends) {
    if findings.model().bodies[ends.child].motion != Motion::Free {
        findings.error(
            &format!("{key}.child"),
            format!(
                "\"{}\" hangs on \"{}\", and cannot be held or moved besides",
                joint.child, joint.parent
            ),
            "write motion = \"free\" for it; the body all others hang on may be held or moved",
        );
    }
}

/// The child starts where the joint puts it.
fn pose_of_child(findings: &mut Findings<'_>, key: &str, joint: &Joint, ends: Ends) {
    let parent = ends.parent.map(|body| start(findings.model(), body)).unwrap_or_default();
    let found = start(findings.model(), ends.child);
    let [on_parent, on_child] = joint.ends_in_plane();
    // What is free may start at any angle and length: those of the bodies
    let kind = match &joint.kind {
        JointKind::Hinge(hinge) => {
            JointKind::Hinge(Hinge { rest: found.angle - parent.angle, ..hinge.clone() })
        }
        JointKind::Slider(slider) => {
            let rest = slider.length_in_plane([parent, found], [on_parent, on_child]);
            JointKind::Slider(Slider { rest, ..slider.clone() })
        }
        kind => kind.clone(),
    };
    let wanted = child_pose(parent, on_parent, on_child, &kind, 0.0);
    let reach = findings.model().bodies[ends.child].shape.reach();
    let size = (wanted.center - parent.center).norm();
    let size = if ends.parent.is_none() { size.max(reach) } else { size };
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
    if matches!(joint.kind, JointKind::Bent { .. }) && turned.abs() > ROUNDING {
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

/// Pose in which a body starts.
pub(crate) fn start(model: &Model, body: usize) -> PlanarPose {
    let body = &model.bodies[body];
    let at = |axis: usize| body.center.get(axis).copied().unwrap_or(0.0);
    PlanarPose { center: [at(0), at(1)].into(), angle: body.angle }
}

/// Bodies each of which hangs on the next, and the last one on the first.
fn find_loop(parents: &[Option<usize>]) -> Option<Vec<usize>> {
    // Known to lead to a body that hangs on nothing
    let mut is_safe = vec![false; parents.len()];
    let mut is_on_path = vec![false; parents.len()];
    for start in 0..parents.len() {
        let mut path = Vec::new();
        let mut above = Some(start);
        while let Some(body) = above.filter(|body| !is_safe[*body]) {
            if is_on_path[body] {
                return Some(path.into_iter().skip_while(|first| *first != body).collect());
            }
            is_on_path[body] = true;
            path.push(body);
            above = parents[body];
        }
        for body in path {
            is_safe[body] = true;
        }
    }
    None
}

/// Axisymmetric bodies hang on arms along the axis.
fn along_the_axis(findings: &mut Findings<'_>) {
    for (index, joint) in findings.model().joints.iter().enumerate() {
        let is_along = match &joint.kind {
            JointKind::Arm { direction, .. } | JointKind::Slider(Slider { direction, .. }) => {
                direction.sin().abs() < 1e-9
            }
            JointKind::Bent { .. } | JointKind::Hinge(_) | JointKind::Ball(_) => false,
        };
        if !is_along || joint.ends_in_plane().iter().any(|end| end[1] != 0.0) {
            findings.error(
                &format!("joint.{index}.kind"),
                format!("the joint of \"{}\" leaves the axis", joint.child),
                "axisymmetric bodies hang on arms along the axis: direction = 0.0 or \
                 3.141592653589793",
            );
        }
    }
}

fn stroke_of_joint(findings: &mut Findings<'_>, key: &str, kind: &JointKind) {
    match kind {
        JointKind::Arm { length, .. } => {
            stroke(findings, &format!("{key}.kind.arm.length"), length);
            arm(findings, &format!("{key}.kind.arm.length"), length);
        }
        JointKind::Bent { angle, .. } => stroke(findings, &format!("{key}.kind.bent.angle"), angle),
        JointKind::Hinge(one) => hinge(findings, &format!("{key}.kind.hinge"), one),
        JointKind::Slider(Slider { force: Some(force), .. }) => {
            stroke(findings, &format!("{key}.kind.slider.force"), force);
        }
        JointKind::Slider(_) | JointKind::Ball(_) => {}
    }
}

/// The torque of a free pivot.
pub(crate) fn hinge(findings: &mut Findings<'_>, key: &str, hinge: &Hinge) {
    if let Some(torque) = &hinge.torque {
        stroke(findings, &format!("{key}.torque"), torque);
    }
}

/// An arm of given length has a positive one at all times.
pub(crate) fn arm(findings: &mut Findings<'_>, key: &str, length: &Stroke) {
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
pub(crate) fn stroke(findings: &mut Findings<'_>, key: &str, stroke: &Stroke) {
    match stroke {
        Stroke::Constant(_) | Stroke::Steady { .. } | Stroke::Sine { .. } => {}
        Stroke::Legs { knots, period, .. } => {
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
        Stroke::Cubic(knots) => cubic(findings, &format!("{key}.cubic"), knots),
        Stroke::Cycle(cycle) => check_cycle(findings, &format!("{key}.cycle"), cycle),
        Stroke::Command(command) => check_command(findings, &format!("{key}.command"), command),
    }
}

/// Knots with rates: nothing is said of what is before the first or after the last one.
pub(crate) fn cubic(findings: &mut Findings<'_>, key: &str, knots: &[[f64; 3]]) {
    let is_rising = knots.len() > 1 && knots.windows(2).all(|pair| pair[1][0] > pair[0][0]);
    let (Some([first, ..]), Some([last, ..]), true) = (knots.first(), knots.last(), is_rising)
    else {
        findings.error(
            key,
            "there must be two knots or more, and their times must rise".to_owned(),
            "write cubic = [[t0, v0, rate0], [t1, v1, rate1], ...] with t0 < t1 < ...",
        );
        return;
    };
    let end = match &findings.case().time {
        TimeSettings::Steady(_) => 0.0,
        TimeSettings::Unsteady(time) => time.end,
    };
    if *first > 0.0 || *last < end * (1.0 - ROUNDING) {
        findings.error(
            key,
            format!("its times go from {first} to {last}, and the run from 0 to {end}"),
            &if *first > 0.0 && *last - *first >= end {
                format!("shift the times of a file by time_offset = {}", significant(-first))
            } else {
                "give values for the whole run, repeat them by `period` in `file`, write time_scale there where its \
                 times are in another unit, or lower time.unsteady.end"
                    .to_owned()
            },
        );
    }
}

/// Knots of one period.
pub(crate) fn check_cycle(findings: &mut Findings<'_>, key: &str, cycle: &Cycle) {
    let Cycle { knots, period } = cycle;
    let is_rising = knots.len() > 1 && knots.windows(2).all(|pair| pair[1][0] > pair[0][0]);
    let ends = [knots.first(), knots.last()].map(|knot| knot.map_or(0.0, |knot| knot[0]));
    if !is_rising || ends[1] - ends[0] >= *period {
        findings.error(
            &format!("{key}.knots"),
            format!("there must be two knots or more, and their times must rise within {period}"),
            "write knots = [[t0, v0, rate0], [t1, v1, rate1], ...] over one period, without the first one again",
        );
    }
}

#[cfg(test)]
mod tests {
    use super::find_loop;

    #[test]
    fn loops_are_told_from_trees() {
        assert_eq!(find_loop(&[None, Some(0), Some(1), Some(1), None]), None);
        assert_eq!(find_loop(&[Some(1), Some(2), Some(3), None]), None);
        assert_eq!(find_loop(&[None, Some(2), Some(3), Some(1)]), Some(vec![1, 2, 3]));
        assert_eq!(find_loop(&[Some(2), Some(0), Some(3), Some(2)]), Some(vec![2, 3]));
        assert_eq!(find_loop(&[Some(1), Some(0)]), Some(vec![0, 1]));
    }
}
