//! Problems of `attached`: heads of rods that are held by nothing, or far from it.

use alewife_mesh::Outline;

use crate::rules::Findings;
use crate::{Attached, Body, Hold};

/// Distance of the head of a rod from the body it is attached to, over its length.
const FARTHEST: f64 = 0.5;

/// Whether the head of a rod of a length (m) can be attached so.
pub fn check(
    findings: &mut Findings<'_>,
    key: &str,
    body: &Body,
    attached: &Attached,
    length: f64,
) {
    if let Some(to) = &attached.to {
        let bodies = &findings.model().bodies;
        let Some(other) = bodies.iter().find(|other| other.name == *to) else {
            findings.error(
                &format!("{key}.to"),
                format!("there is no body \"{to}\""),
                "name another body, or leave `to` out for the laboratory",
            );
            return;
        };
        if other.name == body.name {
            findings.error(
                &format!("{key}.to"),
                format!("\"{to}\" cannot be attached to itself"),
                "name another body, or leave `to` out for the laboratory",
            );
            return;
        }
        if other.rod.is_some() {
            findings.error(
                &format!("{key}.to"),
                format!("\"{to}\" is a rod, and rods are attached to rigid bodies"),
                "name a rigid body, or leave `to` out for the laboratory",
            );
            return;
        }
        if matches!(attached.hold, Hold::Angle(_)) {
            findings.error(
                &format!("{key}.hold"),
                format!("an angle in time is one in the laboratory, and \"{to}\" is a body"),
                "write hold = \"clamped\" or \"hinged\", or leave `to` out",
            );
            return;
        }
        off_surface(findings, key, body, other, length);
    }
}

/// A rod is attached near the surface of the other body: between them is fluid, which the mesh needs.
fn off_surface(findings: &mut Findings<'_>, key: &str, body: &Body, other: &Body, length: f64) {
    let placed = |body: &Body| Outline::new(&body.placed(1.0)).ok();
    let (Some(own), Some(surface)) = (placed(body), placed(other)) else { return };
    // The first point of a slender outline is its head
    let head = own.at(0.0)[0];
    let off = (surface.at(surface.parameter_of(head))[0] - head).norm();
    if off > FARTHEST * length {
        findings.error(
            &format!("{key}.to"),
            format!(
                "the head of \"{}\" is {off} from the surface of \"{}\"",
                body.name, other.name
            ),
            "move it by `center` and `angle` to where its head is near that body",
        );
    }
}
