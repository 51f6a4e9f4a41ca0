//! The reference mesh of a saved state, with the outlines it was generated for.

use std::sync::Arc;

use alewife_mesh::Outline;

use super::case::PlanarCase;
use super::scene::PlanarScene;
use crate::body::on_mesh;
use crate::case::Model;
use crate::coupling::{BodyShapes, Problem};
use crate::simulation::RunError;
use crate::simulation::moving_mesh::MovingMesh;
use crate::simulation::resume::{Reference, ResumeError};

/// Distance over the length of an edge by which the outline of a body may be elsewhere when a run
/// resumes.
const OUTLINE_JUMP: f64 = 1e-2;

/// What moves the mesh of a saved state.
///
/// # Errors
/// When the case has other outlines.
pub(super) fn moving_mesh_of(
    model: &Model,
    problem: &Problem<2>,
    reference: &Reference<'_, 2>,
) -> Result<MovingMesh<2>, RunError> {
    let Reference { saved, mesh } = reference;
    let shapes = BodyShapes::at(&problem.bodies, saved.time)?;
    check_outlines(problem, reference, &shapes)?;
    let planar = Arc::new(PlanarCase::new(model, problem)?);
    let settings = planar.motion_settings(&model.case);
    let (start, poses) = (&saved.domain_start, saved.poses.clone());
    let scene = PlanarScene::restored(planar, mesh, start, poses.clone(), &shapes)
        .map_err(ResumeError::from)?;
    Ok(MovingMesh::new(mesh, Box::new(scene), settings, poses, saved.time)?)
}

/// Whether bodies that deform had these outlines when a mesh was generated.
fn check_outlines(
    problem: &Problem<2>,
    reference: &Reference<'_, 2>,
    shapes: &BodyShapes,
) -> Result<(), ResumeError> {
    let Reference { saved, mesh } = reference;
    for (body, rigid) in problem.bodies.iter().enumerate() {
        let Some(outline) = shapes.outline(body) else { continue };
        let pose = &saved.poses[body];
        let outline: Outline = outline.placed_at(on_mesh(&pose.center), pose.angle());
        for facet in mesh.facets.iter().filter(|facet| facet.boundary == rigid.boundary) {
            let [start, end] = mesh.facet_vertices(facet).map(|node| mesh.nodes[node]);
            let distance = (outline.at(outline.parameter_of(start))[0] - start).norm();
            if distance > OUTLINE_JUMP * (end - start).norm() {
                return Err(ResumeError::Outline { body: rigid.name.clone(), distance });
            }
        }
    }
    Ok(())
}
