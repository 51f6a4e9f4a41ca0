//! Problems of a domain that is given as a mesh: names and shapes of its sides, and bodies in it.

use alewife_mesh::SideShape;

use crate::rules::Findings;
use crate::spec::formula::numbers;
use crate::{BoundaryCondition, Case, DomainSpec, Geometry, MeshFile};

/// What it holds has been read; here is what does not go with the rest of the case.
pub fn check(findings: &mut Findings<'_>) {
    let (case, model) = (findings.case(), findings.model());
    for note in case.given_mesh().map(MeshFile::notes).unwrap_or_default() {
        let help = "nothing has to be done if this is meant";
        findings.warning("domain.mesh.file", note.clone(), help);
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
    if case.geometry == Geometry::Planar && !model.bodies.is_empty() {
        findings.error(
            "domain.mesh",
            "bodies in the plane cannot be in a mesh that is given so far".to_owned(),
            "take domain.box, domain.channel or domain.disc, or make the bodies sides of the mesh",
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
    let mesh = findings.case().given_mesh();
    let Some(shape) = mesh.and_then(|mesh| mesh.side_shape(side)) else { return };
    match condition {
        BoundaryCondition::Periodic(_) | BoundaryCondition::WavingSheet { .. } => findings.error(
            key,
            "sides of a given mesh are neither periodic nor do they wave".to_owned(),
            "take domain.box for that",
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
