//! What is spatial by nature in a run: solids, their domain, meshes of tetrahedra.

use alewife_mesh::spatial::{Body as Solid, estimate_cells, generate};
use alewife_mesh::{Mesh, Point};
use nalgebra::Vector3;

use super::RunError;
use super::build::no_solid;
use super::case_mesh::{CaseMesh, Dimension, InitialMesh};
use super::moving_mesh::MovingMesh;
use super::resume::Reference;
use super::sizing::sizing;
use super::start::check_cells;
use crate::case::{Case, Model};
use crate::coupling::Problem;

impl CaseMesh<3> for Dimension<3> {
    fn generate(model: &Model) -> Result<InitialMesh<3>, RunError> {
        let case = &model.case;
        let (solids, sizing) = (solids(model)?, sizing(case));
        let domain = case.domain_in_space().ok_or_else(no_domain)?;
        check_cells::<3>(|limit| estimate_cells(&domain, &solids, &sizing, limit))?;
        let mesh = generate(&domain, &solids, &sizing)?;
        Ok(resting(model, mesh))
    }

    fn adopt(model: &Model, mesh: Mesh<3>) -> Result<InitialMesh<3>, RunError> {
        Ok(resting(model, mesh))
    }

    /// Itself alone: periodic sides in space are flat, and the mesh fills the box.
    fn images(_case: &Case, _mesh: &Mesh<3>) -> Vec<Point<3>> {
        vec![Point::<3>::zeros()]
    }

    fn moving_mesh_of(
        _model: &Model,
        _problem: &Problem<3>,
        _reference: &Reference<'_, 3>,
    ) -> Result<MovingMesh<3>, RunError> {
        Err(no_moving_mesh())
    }
}

fn no_moving_mesh() -> RunError {
    let reason = "bodies cannot move through the mesh in three dimensions so far";
    RunError::Unsupported(reason.to_owned())
}

/// A mesh that does not move.
fn resting(model: &Model, mesh: Mesh<3>) -> InitialMesh<3> {
    let shifts = vec![Vector3::zeros(); model.bodies.len()];
    InitialMesh { mesh, shifts, make_moving: Box::new(|_, _, _, _| Err(no_moving_mesh())) }
}

/// The bodies of a case as they are meshed.
fn solids(model: &Model) -> Result<Vec<Solid>, RunError> {
    let scale = model.case.mesh.scale;
    model.bodies.iter().map(|body| body.solid(scale).ok_or_else(|| no_solid(body))).collect()
}

fn no_domain() -> RunError {
    RunError::Unsupported("this domain is not one in three dimensions".to_owned())
}
