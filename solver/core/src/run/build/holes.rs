//! The sides of a given mesh that are surfaces of bodies.

use alewife_mesh::SideOfBody;

use crate::case::{Model, ShapeSpec};

/// Those of the bodies of a model, one for each where bodies are what a mesh leaves out; else none.
pub(in crate::run) fn sides_of_bodies(model: &Model) -> Vec<SideOfBody<'_>> {
    let sides = model.bodies.iter().filter_map(|body| match &body.shape {
        ShapeSpec::Side(hole) => Some(SideOfBody { side: &hole.side, body: &body.name }),
        _ => None,
    });
    sides.collect()
}
