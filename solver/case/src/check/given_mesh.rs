//! Problems of a domain that is given as a mesh: names of its sides, and bodies in it.

use super::Findings;
use crate::Geometry;

/// What it holds has been read; here is what does not go with the rest of the case.
pub fn check(findings: &mut Findings<'_>) {
    let (case, model) = (findings.case(), findings.model());
    if case.sides().contains(&"axis") {
        findings.error(
            "domain.mesh.file",
            "a side of the mesh is named `axis`, which is that of axisymmetric domains".to_owned(),
            "give the physical group another name",
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
