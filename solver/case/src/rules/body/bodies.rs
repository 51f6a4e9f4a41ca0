//! Problems of `[[body]]`: names, shapes, motions, and gaits that do not fit.

use std::collections::HashMap;
use std::f64::consts::PI;

use super::motion::{by_axis, initial, locked, mass};
use super::{gait, polygon, rod, solid, spring, surface};
use crate::rules::Findings;
use crate::rules::flow::boundary::check_factor;
use crate::spec::body::given::polygon::signed_area;
use crate::text::names::{LONGEST_NAME, is_word};
use crate::text::type_error::suggestion;
use crate::{Body, GaitSpec, Geometry, Lock, Motion, Probe, ShapeSpec};

/// Largest difference between a heading and the axis that is taken for rounding (rad).
const HEADING_ROUNDING: f64 = 1e-3;

/// Density over that of the fluid, or its inverse, that is warned about; a million is lead in air.
const DENSEST: f64 = 1e6;

/// Names that stand for something else in `series.csv`.
const RESERVED: [&str; 2] = ["flow", "time"];

pub fn check(findings: &mut Findings<'_>) {
    let case = findings.case();
    let mut taken: HashMap<&str, usize> = HashMap::new();
    for (index, body) in findings.model().bodies.iter().enumerate() {
        let key = format!("body.{index}");
        // Names of bodies that are made follow from that of their swimmer
        if findings.model().swimmer_of_body(index).is_none() {
            check_word(findings, &format!("{key}.name"), &body.name);
        }
        match (findings.model().swimmer_of_body(index), taken.get(body.name.as_str())) {
            (Some(swimmer), Some(other)) => name_of_swimmer(findings, *other, swimmer),
            (_, other) => check_name(findings, &format!("{key}.name"), &body.name, other.is_some()),
        }
        taken.entry(&body.name).or_insert(index);
        check_shape(findings, &format!("{key}.shape"), &body.shape);
        check_density(findings, &key, body);
        check_motion(findings, &key, body);
        by_axis::check(findings, index, body);
        initial::check(findings, index, body);
        locked::check(findings, index, body);
        mass::check(findings, index, body);
        spring::check(findings, &key, body);
        gait::check(findings, &key, body);
        rod::check(findings, &key, body);
        if case.geometry == Geometry::Axisymmetric && findings.is_vector(&body.center) {
            check_on_axis(findings, &key, body);
        }
    }
    for (index, probe) in case.probe.iter().enumerate() {
        check_word(findings, &format!("probe.{index}.name"), &probe.name);
        let is_taken = taken.contains_key(probe.name.as_str());
        check_name(findings, &format!("probe.{index}.name"), &probe.name, is_taken);
        taken.insert(&probe.name, usize::MAX);
        check_rider(findings, &format!("probe.{index}.body"), probe);
    }
    for (index, tracer) in case.tracer.iter().enumerate() {
        let key = format!("tracer.{index}.name");
        check_word(findings, &key, &tracer.name);
        check_name(findings, &key, &tracer.name, taken.contains_key(tracer.name.as_str()));
        taken.insert(&tracer.name, usize::MAX);
    }
}

/// A probe rides on a body that has a frame.
fn check_rider(findings: &mut Findings<'_>, key: &str, probe: &Probe) {
    let Some(name) = &probe.body else { return };
    let model = findings.model();
    match model.body_index(name).map(|body| &model.bodies[body]) {
        None => {
            let names: Vec<&str> = model.bodies.iter().map(|body| body.name.as_str()).collect();
            findings.error(
                key,
                format!("`body` is \"{name}\", but no body has that name"),
                &suggestion(name, &names),
            );
        }
        Some(body) if body.rod.is_some() => findings.error(
            key,
            format!("\"{name}\" is a rod, and has no frame that a probe could ride in"),
            "leave `body` out, or put the probe on a rigid body",
        ),
        Some(_) => {}
    }
}

/// A body has the name of one that is made for a swimmer.
fn name_of_swimmer(findings: &mut Findings<'_>, body: usize, swimmer: usize) {
    let model = findings.model();
    let mut of_swimmer = (0..model.bodies.len())
        .filter(|body| model.swimmer_of_body(*body) == Some(swimmer))
        .map(|body| model.bodies[body].name.as_str());
    let (first, last) = (of_swimmer.clone().next(), of_swimmer.next_back());
    let [first, last] = [first, last].map(Option::unwrap_or_default);
    let (own, name) = (&findings.case().swimmer[swimmer].name, &model.bodies[body].name);
    findings.error(
        &format!("body.{body}.name"),
        format!(
            "the name \"{name}\" is that of a body of the swimmer \"{own}\", which has \"{first}\" to \
             \"{last}\""
        ),
        "give the body another name",
    );
}

/// A name is one word, and no novel.
pub(crate) fn check_word(findings: &mut Findings<'_>, key: &str, name: &str) {
    let n = name.chars().count();
    if n > LONGEST_NAME {
        let start: String = name.chars().take(20).collect();
        findings.error(
            key,
            format!("the name \"{start}...\" has {n} characters"),
            &format!("names have at most {LONGEST_NAME}"),
        );
    } else if !is_word(name) {
        findings.error(
            key,
            format!("\"{name}\" cannot be a name"),
            "write one word of the letters a-z, digits, - and _",
        );
    }
}

/// A name means one thing.
fn check_name(findings: &mut Findings<'_>, key: &str, name: &str, is_taken: bool) {
    let sides = findings.case().sides();
    if is_taken {
        findings.error(
            key,
            format!("the name \"{name}\" is taken by a body, a probe or tracers above"),
            "give every body, every probe and all tracers names of their own",
        );
    }
    if sides.contains(&name) || RESERVED.contains(&name) {
        findings.error(
            key,
            format!("\"{name}\" cannot be a name here: it stands for something else"),
            &format!("taken are the sides {} and the words flow, time", sides.join(", ")),
        );
    }
}

/// Lengths that make a shape.
pub(crate) fn check_shape(findings: &mut Findings<'_>, key: &str, shape: &ShapeSpec) {
    match shape {
        ShapeSpec::Capsule { length, radius } if *length <= 2.0 * radius => findings.error(
            &format!("{key}.capsule.length"),
            format!("the capsule is {length} long and its ends have the radius {radius}"),
            "the length from end to end is larger than twice the radius",
        ),
        ShapeSpec::Fish(_) | ShapeSpec::Flagellate(_) => gait::check_shape(findings, key, shape),
        ShapeSpec::Helix(helix) => solid::check_helix(findings, &format!("{key}.helix"), helix),
        ShapeSpec::Curve(curve) => solid::check_curve(findings, &format!("{key}.curve"), curve),
        ShapeSpec::Revolved { profile } => {
            solid::check_profile(findings, &format!("{key}.revolved.profile"), profile);
        }
        ShapeSpec::Union(parts) => {
            solid::check_parts(findings, &format!("{key}.union"), parts, check_shape);
        }
        ShapeSpec::Surface(shape) => surface::check(findings, &format!("{key}.surface"), shape),
        ShapeSpec::Side(shape) if shape.hole.is_none() => findings.error(
            &format!("{key}.side"),
            "a hole of a mesh is a body of its own".to_owned(),
            "write it in [[body]], and name the bodies in swimmer.kind.bodies",
        ),
        ShapeSpec::Polygon(shape) => polygon::check(findings, &format!("{key}.polygon"), shape),
        ShapeSpec::Spline { points } if points.len() > 2 && signed_area(points) <= 0.0 => {
            findings.error(
                &format!("{key}.spline.points"),
                "the points of the spline run clockwise".to_owned(),
                "list them counter-clockwise",
            );
        }
        _ => {}
    }
}

/// A density that is hardly meant: of another unit, or a slip of the exponent.
fn check_density(findings: &mut Findings<'_>, key: &str, body: &Body) {
    let fluid = findings.case().fluid.density;
    let Some(own) = body.density else { return };
    let is_absurd = own > DENSEST * fluid || (own > 0.0 && own * DENSEST < fluid);
    if fluid > 0.0 && body.motion == Motion::Free && is_absurd {
        findings.warning(
            &format!("{key}.density"),
            format!(
                "\"{}\" has {:.3e} times the density of the fluid: is that its unit?",
                body.name,
                own / fluid
            ),
            "densities are those of the fluid, in the same units; 0.0 is a massless body",
        );
    }
}

fn check_motion(findings: &mut Findings<'_>, key: &str, body: &Body) {
    if let Motion::Imposed(imposed) = &body.motion {
        let motion = format!("{key}.motion.imposed");
        for (what, factor) in
            [("factor", &imposed.factor), ("angular_factor", &imposed.angular_factor)]
        {
            if let Some(factor) = factor {
                check_factor(findings, &format!("{motion}.{what}"), factor);
            }
        }
    }
    if let Some(factor) = &body.load_factor {
        check_factor(findings, &format!("{key}.load_factor"), factor);
    }
    let all: &[Lock] = findings.case().geometry.motions();
    let is_locked = all.iter().all(|lock| body.locked.contains(lock));
    if body.motion == Motion::Free && is_locked && body.driven.is_empty() {
        findings.warning(
            &format!("{key}.locked"),
            format!("\"{}\" is free, but all its motions are locked", body.name),
            "write motion = \"held\", or take a lock away",
        );
    }
    let is_pulled = body.force.iter().any(|part| *part != 0.0);
    if body.motion == Motion::Free {
        if body.load_factor.is_some() && !is_pulled && body.torque.is_zero() {
            findings.warning(
                &format!("{key}.load_factor"),
                format!("`load_factor` has no force or torque of \"{}\" to multiply", body.name),
                "add force = [x, y] or torque = ..., or leave it out",
            );
        }
        if !body.load_frame.is_laboratory() && !is_pulled && body.torque.is_zero() {
            findings.warning(
                &format!("{key}.load_frame"),
                format!("`load_frame` has no force or torque of \"{}\" to turn", body.name),
                "add force = [x, y] or torque = ..., or leave it out",
            );
        }
        return;
    }
    let idle = [
        ("locked", !body.locked.is_empty()),
        ("force", is_pulled),
        ("torque", !body.torque.is_zero()),
        ("load_factor", body.load_factor.is_some()),
        ("load_frame", !body.load_frame.is_laboratory()),
    ];
    for (name, is_given) in idle {
        if is_given {
            findings.warning(
                &format!("{key}.{name}"),
                format!("`{name}` has no effect on body \"{}\", which is not free", body.name),
                "leave it out, or write motion = \"free\"",
            );
        }
    }
}

/// What moves or points off the axis breaks the symmetry.
fn check_on_axis(findings: &mut Findings<'_>, key: &str, body: &Body) {
    let name = &body.name;
    let mut zero = |field: &str, value: f64, what: &str| {
        if value != 0.0 {
            findings.error(
                &format!("{key}.{field}"),
                format!("`{key}.{field}` is {value}: {what} of \"{name}\" breaks the symmetry"),
                match field {
                    "angle" => {
                        "in an axisymmetric case it must be 0; a squirmer faces -x with \
                         gait.squirmer.heading = 3.141592653589793, linked spheres are given from left \
                         to right"
                    }
                    _ => "in an axisymmetric case it must be 0",
                },
            );
        }
    };
    let across = |values: &[f64]| values.get(1).copied().unwrap_or(0.0);
    zero("center.1", body.center[1], "the distance from the axis");
    zero("center_of_mass.1", across(&body.center_of_mass), "the centre of mass off the axis");
    zero("angle", body.angle, "the angle");
    zero("torque", body.torque.z(), "the torque");
    zero("force.1", across(&body.force), "the force across the axis");
    zero("velocity.1", across(&body.velocity), "the velocity across the axis");
    zero("angular_velocity", body.angular_velocity.z(), "the rotation");
    if let Motion::Imposed(imposed) = &body.motion {
        let velocity = across(&imposed.velocity);
        zero("motion.imposed.velocity.1", velocity, "the velocity across the axis");
        zero("motion.imposed.angular_velocity", imposed.angular_velocity.z(), "the rotation");
    }
    if let Some(spring) = &body.spring {
        zero("spring.stiffness.1", across(&spring.stiffness), "the stiffness across the axis");
        zero("spring.damping.1", across(&spring.damping), "the damping across the axis");
        zero("spring.anchor.1", across(&spring.anchor), "the anchor off the axis");
        zero("spring.torsion", spring.torsion, "the torsion");
        zero("spring.torsion_damping", spring.torsion_damping, "the damping of the rotation");
        zero("spring.rest_angle", spring.rest_angle.unwrap_or(0.0), "the angle at rest");
    }
    if let Some(GaitSpec::Squirmer(squirmer)) = &body.gait {
        let heading = squirmer.heading;
        if heading != 0.0 && (heading.abs() - PI).abs() > HEADING_ROUNDING {
            findings.error(
                &format!("{key}.gait.squirmer.heading"),
                format!("the heading {heading} of \"{name}\" is not along the axis"),
                "write heading = 0.0 (towards +x) or heading = 3.141592653589793 (towards -x)",
            );
        }
        if squirmer.turn.is_some() {
            findings.error(
                &format!("{key}.gait.squirmer.turn"),
                format!(
                    "the swimming axis of \"{name}\" turns: off the axis it breaks the symmetry"
                ),
                "leave it out; to swim to and fro write factors = { 1 = ... }",
            );
        }
    }
}
