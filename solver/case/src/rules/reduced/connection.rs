//! Problems of the table of a connection.

use crate::rules::Findings;
use crate::{ConnectionSpec, Geometry, LoadLaw, Motion, ReducedSpec};

/// Most nodes of a joint.
const MOST_NODES: usize = 64;

const KEY: &str = "reduced.connection";

pub fn check(findings: &mut Findings<'_>, spec: &ReducedSpec) {
    match (&spec.connection, spec.loads) {
        (Some(table), LoadLaw::Connection) => {
            if sizes(findings, table) {
                values(findings, table);
                within(findings, table);
            }
            root(findings);
        }
        (None, LoadLaw::Connection) => {
            let help = "add [reduced.connection] with range, nodes and values";
            let message = "the law \"connection\" needs its table".to_owned();
            findings.error("reduced.loads", message, help);
        }
        (Some(_), law) => {
            let message = format!("the law \"{}\" has no connection", law.name());
            findings.error(KEY, message, "leave it out, or write loads = \"connection\"");
        }
        (None, _) => {}
    }
}

/// As many ranges and numbers of nodes as there are joints.
fn sizes(findings: &mut Findings<'_>, table: &ConnectionSpec) -> bool {
    let n = findings.model().joints.len();
    if !(1..=3).contains(&n) {
        let message = format!("a connection is of 1 to 3 joints, and the case has {n}");
        findings.error("reduced.loads", message, "take loads = \"resistive\"");
        return false;
    }
    let are_positive = table.range.iter().all(|one| one.is_finite() && *one > 0.0);
    if table.range.len() != n || !are_positive {
        let message = format!("the case has {n} joints, and the ranges are {:?}", table.range);
        let help = "write a positive half width of each joint";
        findings.error(&format!("{KEY}.range"), message, help);
        return false;
    }
    if table.nodes.len() != n || !table.nodes.iter().all(|one| (1..=MOST_NODES).contains(one)) {
        let message = format!("the case has {n} joints, and the nodes are {:?}", table.nodes);
        let help = format!("write a number from 1 to {MOST_NODES} of each joint");
        findings.error(&format!("{KEY}.nodes"), message, &help);
        return false;
    }
    true
}

fn values(findings: &mut Findings<'_>, table: &ConnectionSpec) {
    let n_velocities = if findings.case().geometry == Geometry::Spatial { 6 } else { 3 };
    let width = n_velocities * table.range.len();
    let n_rows: usize = table.nodes.iter().product();
    if table.values.len() != n_rows {
        let message =
            format!("{n_rows} nodes need a row each, and there are {}", table.values.len());
        return findings.error(&format!("{KEY}.values"), message, "the last joint fastest");
    }
    let is_right = |row: &Vec<f64>| row.len() == width && row.iter().all(|one| one.is_finite());
    if let Some(nth) = table.values.iter().position(|row| !is_right(row)) {
        findings.error(
            &format!("{KEY}.values.{nth}"),
            format!("a row is {:?}", table.values[nth]),
            &format!("write {width} numbers: of each joint {n_velocities} velocities by its rate"),
        );
    }
}

/// Joints stay where the table is known.
fn within(findings: &mut Findings<'_>, table: &ConnectionSpec) {
    for (index, (joint, range)) in findings.model().joints.iter().zip(&table.range).enumerate() {
        let Some([least, most]) = joint.kind.stroke().map(crate::Stroke::range) else { continue };
        if least < -range || most > *range {
            findings.error(
                &format!("{KEY}.range.{index}"),
                format!(
                    "the joint of \"{}\" goes from {least} to {most}, and its range is -{range} to \
                     {range}",
                    joint.child
                ),
                "widen the table, or bend the joint less; a command needs limits",
            );
        }
    }
}

/// The first body goes where the others drive it.
fn root(findings: &mut Findings<'_>) {
    let model = findings.model();
    for (index, body) in model.bodies.iter().enumerate() {
        let is_held = model.joint_above(index).is_none() && body.motion == Motion::Held;
        if is_held {
            let message = format!("\"{}\" is held, and a connection moves it", body.name);
            findings.error(&format!("body.{index}.motion"), message, "write motion = \"free\"");
        }
    }
    for (index, joint) in model.joints.iter().enumerate() {
        if model.hangs_on_laboratory(joint) {
            let message = "a connection is of a swimmer that hangs on nothing".to_owned();
            let help = "leave out the joint to the laboratory, or take loads = \"resistive\"";
            findings.error(&format!("joint.{index}.parent"), message, help);
        }
    }
}
