//! What steps, loads, markers and the record of a soft case may be.

use super::mistakes::Mistakes;
use crate::Geometry;
use crate::soft::spec::LoadCurve;

/// Most steps of a motion, all of whose places are kept.
const MOST_STEPS: usize = 10_000_000;

pub fn check(mistakes: &mut Mistakes<'_>) {
    steps(mistakes);
    if let Some(loads) = mistakes.case().loads.clone() {
        mistakes.positive("loads.density", loads.density);
        curve(mistakes, "loads.drag", &loads.drag);
        curve(mistakes, "loads.thrust", &loads.thrust);
    }
    if let Some(record) = mistakes.case().record.clone() {
        mistakes.positive("record.time_unit", record.time_unit);
        mistakes.positive("record.length_unit", record.length_unit);
    }
    markers(mistakes);
    angles(mistakes);
}

fn steps(mistakes: &mut Mistakes<'_>) {
    let soft = mistakes.case().soft.clone();
    mistakes.positive("soft.frame", soft.frame);
    for (key, n) in [("soft.frames", soft.frames), ("soft.substeps", soft.substeps)] {
        if n == 0 {
            mistakes.add(key, format!("`{key}` is 0"), "write 1 or more");
        }
    }
    if soft.frames.saturating_mul(soft.substeps) > MOST_STEPS {
        let message = format!("{} frames of {} steps", soft.frames, soft.substeps);
        mistakes.add("soft.frames", message, &format!("write {MOST_STEPS} steps at most"));
    }
    if !(soft.tolerance > 0.0 && soft.tolerance <= 1e-2) {
        let message = format!("`soft.tolerance` is {}", soft.tolerance);
        mistakes.add("soft.tolerance", message, "write a number above 0, 0.01 at most");
    }
}

fn curve(mistakes: &mut Mistakes<'_>, key: &str, curve: &LoadCurve) {
    match curve {
        LoadCurve::Bezier(points) if points.len() != 4 => {
            let at = format!("{key}.bezier");
            let message = format!("`{at}` has {} points", points.len());
            mistakes.add(&at, message, "a Bezier curve has four; write others as a `table`");
        }
        LoadCurve::Table(values) if values.len() < 2 => {
            let at = format!("{key}.table");
            let message = format!("`{at}` has {} values", values.len());
            mistakes.add(&at, message, "write two or more, evenly apart in the angle");
        }
        _ => {}
    }
}

fn markers(mistakes: &mut Mistakes<'_>) {
    let markers = mistakes.case().marker.clone();
    let n = mistakes.case().geometry.dimensions();
    let has_record = mistakes.case().record.is_some();
    for (index, marker) in markers.iter().enumerate() {
        let key = format!("marker.{index}");
        mistakes.per_dimension(&format!("{key}.at"), marker.at.len());
        mistakes.not_negative(&format!("{key}.weight"), marker.weight);
        name(mistakes, &key, "a marker", &marker.name);
        if markers[..index].iter().any(|other| other.name == marker.name) {
            let message = format!("two markers are called \"{}\"", marker.name);
            mistakes.add(&format!("{key}.name"), message, "give each its own name");
        }
        if !marker.columns.is_empty() && !has_record {
            let message = format!("\"{}\" has columns of a record, and there is none", marker.name);
            mistakes.add(&format!("{key}.columns"), message, "add [record] with its file");
        }
        if marker.columns.each()[n..].iter().any(Option::is_some) {
            let message = format!("`{key}.columns` has z in a case of {n} dimensions");
            mistakes.add(&format!("{key}.columns"), message, "accepted: x and y");
        }
    }
}

/// Refuses what is no name of columns.
fn name(mistakes: &mut Mistakes<'_>, key: &str, what: &str, name: &str) {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if name.is_empty() || !name.chars().all(is_plain) {
        let message = format!("{what} has the name {name:?}");
        let help = "write letters, digits, - and _: names are those of columns";
        mistakes.add(&format!("{key}.name"), message, help);
    }
}

fn angles(mistakes: &mut Mistakes<'_>) {
    let case = mistakes.case().clone();
    if !case.angle.is_empty() && case.geometry != Geometry::Planar {
        let message = "angles are those of planar bodies".to_owned();
        return mistakes.add("angle", message, "compare the places of markers");
    }
    let known: Vec<&str> = case.marker.iter().map(|marker| marker.name.as_str()).collect();
    for (index, angle) in case.angle.iter().enumerate() {
        let key = format!("angle.{index}");
        name(mistakes, &key, "an angle", &angle.name);
        mistakes.not_negative(&format!("{key}.weight"), angle.weight);
        if case.angle[..index].iter().any(|other| other.name == angle.name) {
            let message = format!("two angles are called \"{}\"", angle.name);
            mistakes.add(&format!("{key}.name"), message, "give each its own name");
        }
        for (nth, marker) in angle.markers.iter().enumerate() {
            let at = format!("{key}.markers.{nth}");
            if !known.contains(&marker.as_str()) {
                let message = format!("there is no marker \"{marker}\"");
                mistakes.add(&at, message, &format!("the markers: {}", known.join(", ")));
            } else if angle.markers[..nth].contains(marker) {
                let message = format!("\"{marker}\" stands twice in an angle");
                mistakes.add(&at, message, "name three markers, in their order along the body");
            }
        }
        if angle.column.is_some() && case.record.is_none() {
            let message = format!("\"{}\" has a column of a record, and there is none", angle.name);
            mistakes.add(&format!("{key}.column"), message, "add [record] with its file");
        }
    }
}
