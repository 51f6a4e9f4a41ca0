//! Problems of `attached`: heads of rods that are held by nothing, or far from it.

use alewife_mesh::spatial::{BodySurface, SectionPoint};
use alewife_mesh::{Outline, Surface};
use nalgebra::Point3;

use crate::rules::Findings;
use crate::{Attached, Body, Geometry, Hold};

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
    let off = match findings.case().geometry {
        Geometry::Spatial => off_in_space(body, other),
        Geometry::Planar | Geometry::Axisymmetric => off_in_the_plane(body, other),
    };
    let Some(off) = off.filter(|off| *off > FARTHEST * length) else { return };
    findings.error(
        &format!("{key}.to"),
        format!("the head of \"{}\" is {off} from the surface of \"{}\"", body.name, other.name),
        "move it by `center` and the way it is turned to where its head is near that body",
    );
}

/// Distance of the head of a slender body from the surface of another one (m).
fn off_in_the_plane(body: &Body, other: &Body) -> Option<f64> {
    let placed = |body: &Body| Outline::new(&body.placed(1.0)).ok();
    let (own, surface) = (placed(body)?, placed(other)?);
    // The first point of a slender outline is its head
    let head = own.at(0.0)[0];
    Some((surface.at(surface.parameter_of(head))[0] - head).norm())
}

/// The same in space.
fn off_in_space(body: &Body, other: &Body) -> Option<f64> {
    let sections = body.shape.profile()?.sections(body.shape.section_height()?)?;
    let nose = sections.point(SectionPoint { along: 0.0, around: 0.0 }).x;
    let head = body.solid(1.0)?.pose * Point3::new(nose, 0.0, 0.0);
    let surface = BodySurface::new(&other.solid(1.0)?).ok()?;
    Some(surface.nearest_point(head.coords).gap.abs())
}
