//! Problems of a domain that is given as a mesh: names and shapes of its sides, and bodies in it.

use alewife_mesh::SideShape;

use crate::rules::Findings;
use crate::spec::formula::numbers;
use crate::{BoundaryCondition, Case, DomainSpec, Geometry, MeshFile, Motion, ShapeSpec};

/// What it holds has been read; here is what does not go with the rest of the case.
pub fn check(findings: &mut Findings<'_>) {
    let case = findings.case();
    for note in case.given_mesh().map(MeshFile::notes).unwrap_or_default() {
        let help = "nothing has to be done if this is meant";
        findings.warning("domain.mesh.file", note.clone(), help);
    }
    if let Some(fault) = case.given_mesh().and_then(MeshFile::fault) {
        findings.error(&fault.key, fault.message, &fault.help);
    }
    let is_made = matches!(case.domain, DomainSpec::Surface(_));
    if let DomainSpec::Surface(region) = &case.domain
        && region.data.is_none()
    {
        findings.error(
            "domain.surface",
            "the surface has no triangles".to_owned(),
            "name their file: file = \"vessel.stl\", of STL, OBJ or PLY",
        );
    }
    if case.sides().contains(&"axis") {
        findings.error(
            if is_made { "domain.surface" } else { "domain.mesh.file" },
            "a side of the mesh is named `axis`, which is that of axisymmetric domains".to_owned(),
            "give the physical group, or the solid, another name",
        );
    }
    check_bodies(findings);
}

/// Bodies are what the mesh leaves out, in space also such as are cut out of it, but not both.
fn check_bodies(findings: &mut Findings<'_>) {
    let (case, model) = (findings.case(), findings.model());
    let are_holes = case.bodies_are_holes();
    if case.periodic_axes().contains(&true) {
        check_periodic(findings);
    }
    if case.geometry == Geometry::Spatial && !are_holes {
        return;
    }
    for (index, body) in model.bodies.iter().enumerate() {
        if !matches!(body.shape, ShapeSpec::Side(_)) {
            let reason = match case.geometry {
                Geometry::Spatial => "beside bodies that are its holes",
                _ => "in the plane, where its bodies are its holes",
            };
            findings.error(
                &format!("body.{index}.shape"),
                format!("\"{}\" cannot be put into a mesh that is given {reason}", body.name),
                "name the side around a hole, shape.side = \"cylinder\", or let the program mesh: domain.box",
            );
        }
    }
    if case.contact.is_some() && are_holes {
        findings.error(
            "contact",
            "holes of a given mesh have no contact: it is not made again where they come near each other"
                .to_owned(),
            "leave it out, or let the program mesh: domain.box",
        );
    }
}

/// A periodic mesh is neither moved nor made again.
fn check_periodic(findings: &mut Findings<'_>) {
    let (case, model) = (findings.case(), findings.model());
    for (index, body) in model.bodies.iter().enumerate() {
        if body.motion != Motion::Held || !matches!(body.shape, ShapeSpec::Side(_)) {
            findings.error(
                &format!("body.{index}"),
                format!(
                    "\"{}\" is not held, or no hole, in a given mesh with periodic sides",
                    body.name
                ),
                "write shape.side with motion = \"held\", or take domain.box for bodies that move",
            );
        }
    }
    if case.geometry == Geometry::Spatial && !case.tracer.is_empty() {
        findings.error(
            "tracer",
            "tracers do not cross periodic sides of a given mesh in space".to_owned(),
            "take domain.box for that",
        );
    }
}

/// Whether a condition can hold on a side of a given mesh.
pub fn check_side(
    findings: &mut Findings<'_>,
    key: &str,
    side: &str,
    condition: &BoundaryCondition,
) {
    let is_made = matches!(findings.case().domain, DomainSpec::Surface(_));
    let mesh = findings.case().given_mesh();
    let Some(shape) = mesh.and_then(|mesh| mesh.side_shape(side)) else { return };
    match condition {
        BoundaryCondition::WavingSheet { .. } => findings.error(
            key,
            "sides of a given mesh do not wave".to_owned(),
            "take domain.box for that",
        ),
        BoundaryCondition::Periodic(_) if is_made => findings.error(
            key,
            "sides of a mesh that is made inside a surface are not periodic".to_owned(),
            "take domain.box for that, or domain.mesh with both sides meshed alike",
        ),
        BoundaryCondition::Axis => findings.error(
            key,
            format!("`axis` holds on the axis only, not on `{side}`"),
            "for a mirror plane or a frictionless wall write \"symmetry\"",
        ),
        BoundaryCondition::Symmetry if shape.normal_axis().is_none() => findings.error(
            key,
            format!("`symmetry` holds on flat sides normal to x, y or z, and `{side}` is none"),
            "write \"no-slip\" or \"traction-free\", or turn the region",
        ),
        BoundaryCondition::Parabolic { .. } | BoundaryCondition::Developed { .. }
            if !shape.is_flat =>
        {
            findings.error(
                key,
                format!("`{side}` is not straight, or in space not flat"),
                "a flow is developed on a flat side; on others write { velocity = { value = [...] } }, of numbers or \
                 expressions",
            );
        }
        _ => {}
    }
}

/// Flow into a given mesh through a side, without its factor in time (m2/s planar, m3/s otherwise).
pub fn inflow_through(
    case: &Case,
    shape: &SideShape,
    condition: &BoundaryCondition,
) -> Option<f64> {
    Some(match condition {
        BoundaryCondition::Velocity { value, .. } => {
            let value = numbers(value)?;
            -value.iter().zip(shape.area.iter()).map(|(u, area)| u * area).sum::<f64>()
        }
        // Of another shape than a round one the mesh tells
        BoundaryCondition::Parabolic { .. } if shape.circle.is_none() => return None,
        BoundaryCondition::Parabolic { peak, .. } => {
            let mean = if case.geometry == Geometry::Spatial { 1.0 / 2.0 } else { 2.0 / 3.0 };
            peak * mean * shape.area.norm()
        }
        BoundaryCondition::Shear { rate, origin, .. } => {
            let height = shape.circle.map_or(0.0, |circle| circle.center.y - origin);
            -rate * height * shape.area.x
        }
        _ => 0.0,
    })
}
