//! Problems of what a rod is given besides, and of what else is in its case.

use crate::rules::Findings;
use crate::{Body, Geometry, Motion, Scheme, TimeSettings};

/// What a rod cannot have besides, since its motion follows from its elasticity.
pub fn check(findings: &mut Findings<'_>, key: &str, body: &Body) {
    let name = &body.name;
    if body.gait.is_some() {
        findings.error(
            &format!("{key}.gait"),
            format!("\"{name}\" is a rod, and bends as its elasticity lets it, by no gait"),
            "write activation = { moment = ... } for muscles, or leave `rod` or `gait` out",
        );
    }
    if body.motion != Motion::Free {
        findings.error(
            &format!("{key}.motion"),
            format!("\"{name}\" is a rod, whose motion is not that of a rigid body"),
            "write motion = \"free\", with attached = { hold = \"clamped\" } to hold its head",
        );
    }
    for (other, is_given) in
        [("locked", !body.locked.is_empty()), ("spring", body.spring.is_some())]
    {
        if is_given {
            findings.error(
                &format!("{key}.{other}"),
                format!("`{other}` is of rigid bodies, and \"{name}\" is a rod"),
                "hold it by attached = { hold = \"clamped\" or \"hinged\" }, or leave it out",
            );
        }
    }
    loads(findings, key, body);
    scheme(findings, key, body);
    others(findings, key, body);
}

/// Loads about a point turn a rigid body, and a rod has no frame that turns.
fn loads(findings: &mut Findings<'_>, key: &str, body: &Body) {
    let name = &body.name;
    for (other, is_given) in [
        ("torque", body.torque.0.iter().any(|part| *part != 0.0)),
        ("magnetic_moment", !body.magnetic_moment.is_empty()),
        ("load_frame", !body.load_frame.is_laboratory()),
    ] {
        if is_given {
            findings.error(
                &format!("{key}.{other}"),
                format!("`{other}` is of rigid bodies, and \"{name}\" is a rod"),
                "leave it out, or put it on a rigid body to which the rod is attached",
            );
        }
    }
}

/// How a rod can be followed in time.
fn scheme(findings: &mut Findings<'_>, key: &str, body: &Body) {
    let name = &body.name;
    match &findings.case().time {
        TimeSettings::Steady(_) => findings.error(
            &format!("{key}.rod"),
            format!("\"{name}\" is a rod, and moves in unsteady runs only"),
            "write time.unsteady = { step = ..., end = ... }",
        ),
        TimeSettings::Unsteady(unsteady) if unsteady.scheme == Scheme::Rk3 => findings.error(
            "time.unsteady.scheme",
            format!("explicit steps cannot follow the stiff bending of \"{name}\""),
            "write scheme = \"bdf2\", or leave it out",
        ),
        TimeSettings::Unsteady(_) => {}
    }
}

/// What cannot be in a case with rods yet.
fn others(findings: &mut Findings<'_>, key: &str, body: &Body) {
    let (case, name) = (findings.case(), &body.name);
    if case.geometry == Geometry::Spatial && case.contact.is_some() {
        findings.error(
            "contact",
            format!("\"{name}\" is a rod, and rods in space have no contact yet"),
            "leave [contact] out, or take geometry = \"planar\"",
        );
    }
    if !findings.model().joints.is_empty() {
        findings.error(
            &format!("{key}.rod"),
            format!("\"{name}\" is a rod, and rods cannot be beside joints yet"),
            "leave out [[joint]] and swimmers of several bodies, or `rod`",
        );
    }
}

/// Rods where nothing holds fluid and bodies along a coordinate.
pub fn unheld(findings: &mut Findings<'_>, along: &str) {
    let Some(nth) = findings.model().bodies.iter().position(|body| body.rod.is_some()) else {
        return;
    };
    let name = &findings.model().bodies[nth].name;
    findings.error(
        &format!("body.{nth}.rod"),
        format!(
            "\"{name}\" is a rod, and rods cannot be where nothing holds fluid and bodies along {along} yet"
        ),
        "let a side be a wall, hold a body, or take fluid.model = \"unsteady-stokes\"",
    );
}
