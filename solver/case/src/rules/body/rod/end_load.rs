//! Problems of `rod.load`: loads that are none, or that what holds an end takes.

use crate::rules::Findings;
use crate::rules::body::joints::stroke as numbers_of_stroke;
use crate::{
    BentByLoad, Body, EndLoadSpec, EndMoment, Geometry, Hold, LoadedEnd, RodEnd, bent_by_loads,
    significant,
};

/// Loads at the ends of a rod.
pub fn check(findings: &mut Findings<'_>, key: &str, body: &Body) {
    let is_given = body.rod.as_ref().is_some_and(|rod| rod.load.is_some());
    if is_given && body.end_loads().next().is_none() {
        findings.error(
            key,
            "a load needs the end at which it acts".to_owned(),
            "write load.tip = { ... } or load.base = { ... }, or leave `load` out",
        );
    }
    for LoadedEnd { end, load } in body.end_loads() {
        let key = format!("{key}.{}", end.name());
        numbers(findings, &key, load);
        if end == RodEnd::Base {
            held(findings, &key, body, load);
        }
    }
    for BentByLoad { end, by, curvature, half_width } in
        bent_by_loads(findings.case().geometry, body).into_iter().filter(BentByLoad::is_too_sharp)
    {
        findings.warning(
            &format!("{key}.{}.{by}", end.name()),
            format!(
                "the {by} at the {} of \"{}\" bends it to a radius of curvature of {}, and half of its thickness is \
                 {}",
                end.name(),
                body.name,
                significant(1.0 / curvature),
                significant(half_width)
            ),
            "load it less, or make it stiffer or thinner: a rod that is bent so sharply is no slender body",
        );
    }
}

fn numbers(findings: &mut Findings<'_>, key: &str, load: &EndLoadSpec) {
    let EndLoadSpec { force, moment, .. } = load;
    let is_in_space = findings.case().geometry == Geometry::Spatial;
    let (n, place, axes) =
        if is_in_space { (3, "in space", "x, y and z") } else { (2, "in the plane", "x and y") };
    if load.strokes().next().is_none() {
        findings.error(
            key,
            "there is neither a `force` nor a `moment`".to_owned(),
            if is_in_space {
                "write force = [{ constant = ... }, { constant = ... }, { constant = ... }] (N) or moment, a list alike (N m)"
            } else {
                "write force = [{ constant = ... }, { constant = ... }] (N/m) or moment.constant = ... (N)"
            },
        );
    } else if !force.is_empty() && force.len() != n {
        let component = vec!["{ constant = ... }"; n].join(", ");
        findings.error(
            &format!("{key}.force"),
            format!("a force {place} has {n} components, and here are {}", force.len()),
            &format!("write force = [{component}], along {axes}"),
        );
    }
    for (axis, stroke) in force.iter().enumerate() {
        numbers_of_stroke(findings, &format!("{key}.force.{axis}"), stroke);
    }
    match (moment, is_in_space) {
        (None, _) => {}
        (Some(EndMoment::Planar(moment)), false) => {
            numbers_of_stroke(findings, &format!("{key}.moment"), moment);
        }
        (Some(EndMoment::Spatial(moments)), true) if moments.len() == 3 => {
            for (axis, moment) in moments.iter().enumerate() {
                numbers_of_stroke(findings, &format!("{key}.moment.{axis}"), moment);
            }
        }
        (Some(EndMoment::Planar(_)), true) => findings.error(
            &format!("{key}.moment"),
            "a moment in space has 3 components, and here is one".to_owned(),
            IN_SPACE,
        ),
        (Some(EndMoment::Spatial(moments)), true) => findings.error(
            &format!("{key}.moment"),
            format!("a moment in space has 3 components, and here are {}", moments.len()),
            IN_SPACE,
        ),
        (Some(EndMoment::Spatial(_)), false) => findings.error(
            &format!("{key}.moment"),
            "a moment in the plane is one function of time, and here is a list".to_owned(),
            "write moment.constant = ... (N), counter-clockwise",
        ),
    }
}

/// What a moment in space looks like.
const IN_SPACE: &str = "write moment = [{ constant = ... }, { constant = ... }, { constant = ... }] (N m), about x, y and z";

/// What holds the head takes the loads there.
fn held(findings: &mut Findings<'_>, key: &str, body: &Body, load: &EndLoadSpec) {
    let Some(attached) = &body.attached else { return };
    let turns = attached.hold == Hold::Hinged;
    for (name, is_taken) in
        [("force", !load.force.is_empty()), ("moment", load.moment.is_some() && !turns)]
    {
        if is_taken {
            findings.error(
                &format!("{key}.{name}"),
                format!("what holds the head of \"{}\" takes a {name} there", body.name),
                if turns {
                    "give a moment, or a load at the tip, or leave it out"
                } else {
                    "give a load at the tip, or leave it out"
                },
            );
        }
    }
}
