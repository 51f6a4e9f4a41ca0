//! Problems of `surface`: solids that are none, and places where none can be.

use crate::rules::Findings;
use crate::spec::body::given::surface::SurfaceShape;

/// Whether there is a solid.
pub fn check(findings: &mut Findings<'_>, key: &str, surface: &SurfaceShape) {
    if surface.solid().is_some() || !findings.has_no_error() {
        return;
    }
    if surface.data.is_none() {
        findings.error(
            key,
            "the surface has no triangles".to_owned(),
            "write file = \"body.stl\", the path of an STL, OBJ or PLY file",
        );
        return;
    }
    findings.error(
        key,
        "a surface from a file is not supported here: it is the whole shape of a [[body]]".to_owned(),
        "unite the parts where the surface was made; links and parts of unions are made of other shapes",
    );
}
