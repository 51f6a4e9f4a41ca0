//! What is spatial by nature in a run: solids, their domain, meshes of tetrahedra.

mod case;
mod scene;

use std::sync::Arc;

use alewife_mesh::spatial::{Body as Solid, BodySurface, estimate_cells, generate};
use alewife_mesh::{Mesh, Point, Surface};
use nalgebra::Vector3;

use self::case::{SpatialCase, move_into, no_domain, solids};
use self::scene::SpatialScene;
use super::RunError;
use super::build::{sides_of_bodies, sizing};
use super::case_mesh::{CaseMesh, Dimension, InitialMesh, MakeMovingMesh, NearestOnBody};
use super::resume::{Reference, ResumeError};
use super::start::check_cells;
use crate::body::MeshPoses;
use crate::case::{Case, Model};
use crate::coupling::{BodyShapes, Problem};
use crate::motion::MovingMesh;
use crate::motion::RemeshError;

impl CaseMesh<3> for Dimension<3> {
    fn generate(model: &Model) -> Result<InitialMesh<3>, RunError> {
        let case = &model.case;
        let holes = sides_of_bodies(model);
        if let (false, Some(given)) = (holes.is_empty(), case.given_mesh()) {
            let given = given.spatial().ok_or_else(|| no_domain(case))?;
            let shifts = vec![Vector3::zeros(); holes.len()];
            return Ok(initial(given.mesh().with_bodies(&holes), shifts));
        }
        let (mut solids, sizing) = (solids(model)?, sizing(case));
        let domain = case.domain_in_space().ok_or_else(|| no_domain(case))?;
        let shifts = move_into(&domain, &mut solids);
        check_cells::<3>(case.mesh.max_cells, |limit| {
            estimate_cells(&domain, &solids, &sizing, limit)
        })?;
        let mesh = generate(&domain, &solids, &sizing)?;
        Ok(initial(mesh, shifts))
    }

    fn adopt(model: &Model, mesh: Mesh<3>) -> Result<InitialMesh<3>, RunError> {
        let domain = model.case.domain_in_space().ok_or_else(|| no_domain(&model.case))?;
        let shifts = move_into(&domain, &mut solids(model)?);
        Ok(initial(mesh, shifts))
    }

    fn images(case: &Case, mesh: &Mesh<3>) -> Vec<Point<3>> {
        let domain = case.domain_in_space();
        domain.map_or(vec![Point::<3>::zeros()], |domain| domain.images_around(&mesh.nodes))
    }

    fn nearest_on_bodies(model: &Model) -> Result<Vec<NearestOnBody<3>>, RunError> {
        let nearest = |solid: &Solid| -> Result<NearestOnBody<3>, RunError> {
            let surface = BodySurface::new(solid)?;
            Ok(Box::new(move |point| surface.nearest_point(*point).point))
        };
        solids(model)?.iter().map(nearest).collect()
    }

    fn moving_mesh_of(
        model: &Model,
        problem: &Problem<3>,
        reference: &Reference<'_, 3>,
    ) -> Result<MovingMesh<3>, RunError> {
        let Reference { saved, mesh } = reference;
        let failed = |error| ResumeError::from(error).into();
        let at = Placed {
            poses: saved.poses.clone(),
            coordinates: saved.coordinates.clone(),
            time: saved.time,
        };
        moving(model, problem, mesh, at, failed)
    }
}

/// A mesh with what moves it, its bodies moved by whole periods (m).
fn initial(mesh: Mesh<3>, shifts: Vec<Vector3<f64>>) -> InitialMesh<3> {
    let make: MakeMovingMesh<3> = Box::new(|model, problem, mesh, poses| {
        let at = Placed { poses, coordinates: problem.initial_coordinates(), time: 0.0 };
        moving(model, problem, mesh, at, RunError::from_remesh)
    });
    InitialMesh { mesh, shifts, make_moving: make }
}

/// Bodies as a mesh was generated for them: poses in it, coordinates of all of them, and when (s).
struct Placed {
    poses: MeshPoses,
    coordinates: Vec<f64>,
    time: f64,
}

/// What moves a mesh that was generated with the bodies so; `failed` says what it means that it cannot be set up.
fn moving(
    model: &Model,
    problem: &Problem<3>,
    mesh: &Mesh<3>,
    at: Placed,
    failed: fn(RemeshError) -> RunError,
) -> Result<MovingMesh<3>, RunError> {
    let Placed { poses, coordinates, time } = at;
    let case = Arc::new(SpatialCase::new(model, problem)?);
    let shapes = BodyShapes::with(&problem.bodies, time, &coordinates)?;
    let moving = || -> Result<_, RemeshError> {
        let settings = case.motion.clone();
        let scene = SpatialScene::new(Arc::clone(&case), mesh, &poses, &shapes)?;
        Ok(MovingMesh::new(mesh, Box::new(scene), settings, poses, time)?)
    };
    Ok(moving().map_err(failed)?.with_coordinates(coordinates))
}
