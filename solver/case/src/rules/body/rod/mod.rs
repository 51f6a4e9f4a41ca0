//! Problems of `body.rod`, `attached` and `activation`: rods of no body, that fold, or that are held nowhere.

mod activation;
mod attached;
pub mod bent;
pub(in crate::rules) mod beside;
mod end_load;
mod periodic;
mod slender;

use self::slender::{Slender, rises_along, too_sharp};
use alewife_mesh::whole;
use nalgebra::{Rotation3, Vector3};

use crate::rules::{Findings, OneOf};
use crate::{AlongBody, Body, Hold, RestShape, RodSpec};

pub fn check(findings: &mut Findings<'_>, key: &str, body: &Body) {
    let Some(rod) = &body.rod else {
        without_rod(findings, key, body);
        return;
    };
    let name = &body.name;
    let Some(profile) = body.shape.profile() else {
        // Lengths that make no body are refused already
        if !["fish", "flagellate", "tube"].contains(&body.shape.name()) {
            findings.error(
                &format!("{key}.rod"),
                format!("\"{name}\" is of shape `{}`, which has no midline", body.shape.name()),
                "give it the shape of a fish or a flagellate, or leave `rod` out",
            );
        }
        return;
    };
    let body_of = Slender {
        length: profile.length(),
        half_width: profile.stations().iter().map(|at| at.half_width).fold(0.0, f64::max),
    };
    beside::check(findings, key, body);
    stiffness(findings, &format!("{key}.rod"), rod, body_of);
    rest(findings, &format!("{key}.rod.rest"), rod, body_of);
    periodic::check(findings, &format!("{key}.rod"), body, rod, body_of.length);
    end_load::check(findings, &format!("{key}.rod.load"), body);
    if let Some(attached) = &body.attached {
        attached::check(findings, &format!("{key}.attached"), body, attached, body_of.length);
        if let Hold::Angle(angle) = &attached.hold {
            activation::moved(findings, &format!("{key}.attached.hold.angle"), angle);
        }
    }
    if let Some(active) = &body.activation {
        activation::check(findings, &format!("{key}.activation"), active, body_of);
    }
}

fn without_rod(findings: &mut Findings<'_>, key: &str, body: &Body) {
    for (name, is_given) in
        [("attached", body.attached.is_some()), ("activation", body.activation.is_some())]
    {
        if is_given {
            findings.error(
                &format!("{key}.{name}"),
                format!("`{name}` is of a rod, and \"{}\" is none", body.name),
                &format!("write rod = {{ bending = ... }}, or leave `{name}` out"),
            );
        }
    }
}

fn stiffness(findings: &mut Findings<'_>, key: &str, rod: &RodSpec, body: Slender) {
    let of = OneOf {
        what: "a rod",
        names: ["bending", "young"],
        given: [rod.bending.is_some(), rod.young.is_some()],
        help: "bending = ... (N m2; N m planar) is the stiffness of its sections, young = ... (Pa) that of its \
               material",
    };
    findings.one_of(key, &of);
    for (name, given) in [("bending", &rod.bending), ("twisting", &rod.twisting)] {
        let Some(AlongBody::Table(rows)) = given else { continue };
        let key = format!("{key}.{name}");
        rises_along(findings, &key, rows, body);
        if let Some(nth) = rows.iter().position(|row| row[1] <= 0.0) {
            let [along, stiffness] = rows[nth];
            findings.error(
                &format!("{key}.{nth}.1"),
                format!("the stiffness at {along} is {stiffness}, but must be positive"),
                "write [[distance from the head, stiffness], ...] with stiffnesses above 0",
            );
        }
    }
}

fn rest(findings: &mut Findings<'_>, key: &str, rod: &RodSpec, body: Slender) {
    let Some(rest) = &rod.rest else { return };
    let key = match rest {
        RestShape::Curvature(_) => format!("{key}.curvature"),
        RestShape::Table(rows) => {
            let key = format!("{key}.table");
            rises_along(findings, &key, rows, body);
            key
        }
        RestShape::Turning(_) => format!("{key}.turning"),
    };
    too_sharp(findings, &key, rest.sharpest(), body, "at rest");
    if rest.sharpest() * body.half_width < 1.0
        && let Some([from, to]) = crossing(rest, body)
    {
        findings.error(
            &key,
            format!("at rest the body meets itself, {from} and {to} from its head"),
            "write smaller curvatures: over the length they turn it too far round",
        );
    }
}

/// Distances from the head (m) of two points of a body that are on each other at rest, if there are any.
fn crossing(rest: &RestShape, body: Slender) -> Option<[f64; 2]> {
    const POINTS: u32 = 256;
    let step = body.length / f64::from(POINTS);
    let (mut places, mut place) = (vec![Vector3::zeros()], Vector3::zeros());
    let mut turned = Rotation3::identity();
    for nth in 0..POINTS {
        let turning = match rest {
            RestShape::Turning(turning) => Vector3::from(*turning),
            _ => Vector3::z() * rest.at((f64::from(nth) + 0.5) * step),
        };
        let half = Rotation3::new(turning * (0.5 * step));
        place += turned * half * Vector3::x() * -step;
        turned *= half * half;
        places.push(place);
    }
    // Nearer ones are neighbours
    let apart = whole((4.0 * body.half_width / step).ceil());
    let meets =
        |one: &Vector3<f64>, other: &Vector3<f64>| (one - other).norm() < 2.0 * body.half_width;
    places.iter().enumerate().find_map(|(first, one)| {
        let later = places.iter().enumerate().skip(first + apart);
        let (second, _) = later.into_iter().find(|(_, other)| meets(one, other))?;
        Some([first as f64 * step, second as f64 * step])
    })
}

#[cfg(test)]
mod tests;
