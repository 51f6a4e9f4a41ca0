//! The first mesh of a planar or axisymmetric case, and what moves it.

use std::sync::Arc;

use alewife_mesh::{Mesh, Outline, PlacedShape, Point};

use super::case::{MeshedCase, PlanarCase, placed_bodies};
use super::resume::moving_mesh_of;
use super::scene::PlanarScene;
use crate::case::{Case, Model};
use crate::coupling::Problem;
use crate::motion::MovingMesh;
use crate::motion::RemeshError;
use crate::run::RunError;
use crate::run::case_mesh::{CaseMesh, Dimension, InitialMesh, MakeMovingMesh, NearestOnBody};
use crate::run::resume::Reference;

impl CaseMesh<2> for Dimension<2> {
    fn generate(model: &Model) -> Result<InitialMesh<2>, RunError> {
        Ok(initial(MeshedCase::generate(model)?))
    }

    fn adopt(model: &Model, mesh: Mesh<2>) -> Result<InitialMesh<2>, RunError> {
        Ok(initial(MeshedCase::of(model, mesh)?))
    }

    fn images(case: &Case, mesh: &Mesh<2>) -> Vec<Point<2>> {
        case.mesh_domain().images_around(mesh.nodes.iter().copied())
    }

    fn nearest_on_bodies(model: &Model) -> Result<Vec<NearestOnBody<2>>, RunError> {
        let nearest = |shape: &PlacedShape| -> Result<NearestOnBody<2>, RunError> {
            let outline = Outline::new(shape)?;
            Ok(Box::new(move |point| outline.nearest(*point).point))
        };
        placed_bodies(model)?.iter().map(nearest).collect()
    }

    fn moving_mesh_of(
        model: &Model,
        problem: &Problem<2>,
        reference: &Reference<'_, 2>,
    ) -> Result<MovingMesh<2>, RunError> {
        moving_mesh_of(model, problem, reference)
    }
}

/// A mesh with what moves it.
fn initial(meshed: MeshedCase) -> InitialMesh<2> {
    let MeshedCase { mesh, shapes, shifts } = meshed;
    let make: MakeMovingMesh<2> = Box::new(move |model, problem, mesh, poses| {
        let planar = Arc::new(PlanarCase::new(model, problem)?);
        let moving = || -> Result<_, RemeshError> {
            let scene = PlanarScene::new(Arc::clone(&planar), mesh, shapes, &poses)?;
            let settings = planar.motion.clone();
            let moving = MovingMesh::new(mesh, Box::new(scene), settings, poses, 0.0)?;
            Ok(moving.with_coordinates(problem.initial_coordinates()))
        };
        moving().map_err(RunError::from_remesh)
    });
    InitialMesh { mesh, shifts, make_moving: make }
}
