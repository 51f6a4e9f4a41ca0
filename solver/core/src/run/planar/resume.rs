//! The reference mesh of a saved state, with the outlines it was generated for.

use std::sync::Arc;

use super::case::PlanarCase;
use super::scene::PlanarScene;
use crate::case::Model;
use crate::coupling::{BodyShapes, Problem};
use crate::motion::MovingMesh;
use crate::run::RunError;
use crate::run::resume::{Reference, ResumeError};

/// What moves the mesh of a saved state.
///
/// # Errors
/// When it cannot be set up.
pub(super) fn moving_mesh_of(
    model: &Model,
    problem: &Problem<2>,
    reference: &Reference<'_, 2>,
) -> Result<MovingMesh<2>, RunError> {
    let Reference { saved, mesh } = reference;
    let shapes = BodyShapes::with(&problem.bodies, saved.time, &saved.coordinates)?;
    let planar = Arc::new(PlanarCase::new(model, problem)?);
    let settings = planar.motion.clone();
    let poses = saved.poses.clone();
    let scene = PlanarScene::restored(planar, mesh, &poses, &shapes).map_err(ResumeError::from)?;
    let moving = MovingMesh::new(mesh, Box::new(scene), settings, poses, saved.time)?;
    Ok(moving.with_coordinates(saved.coordinates.clone()))
}
