//! What is spatial by nature in a run: solids, their domain, meshes of tetrahedra.

use alewife_mesh::spatial::{Body as Solid, Domain, Shape, generate};
use alewife_mesh::{Mesh, Point};
use nalgebra::{Isometry3, Translation3, Vector3};

use super::RunError;
use super::build::{no_solid, rotation};
use super::case_mesh::{CaseMesh, Dimension, InitialMesh};
use super::moving_mesh::MovingMesh;
use super::resume::Reference;
use super::sizing::sizing;
use crate::case::{Body, BoundaryCondition, Case, DomainSpec, Model, Orientation, ShapeSpec};
use crate::coupling::Problem;

impl CaseMesh<3> for Dimension<3> {
    fn generate(model: &Model) -> Result<InitialMesh<3>, RunError> {
        let case = &model.case;
        let solids = model.bodies.iter().map(|body| solid(case, body));
        let solids = solids.collect::<Result<Vec<Solid>, RunError>>()?;
        let mesh = generate(&domain(case)?, &solids, &sizing(case))?;
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

/// The domain of a case.
fn domain(case: &Case) -> Result<Domain, RunError> {
    match &case.domain {
        DomainSpec::Box { .. } => {
            let extent = case.extent();
            let is_mirror =
                |side: &&str| matches!(case.boundary.get(*side), Some(BoundaryCondition::Symmetry));
            let mut symmetric = [false; 6];
            for (nth, side) in case.sides().iter().enumerate() {
                symmetric[nth] = is_mirror(side);
            }
            Ok(Domain::Box {
                min: extent.min.into(),
                max: extent.max.into(),
                periodic: case.periodic_axes(),
                symmetric,
            })
        }
        DomainSpec::Cylinder { x, radius } => Ok(Domain::Cylinder { x: *x, radius: *radius }),
        DomainSpec::Sphere { center, radius } => {
            Ok(Domain::Ball { center: (*center).into(), radius: *radius })
        }
        DomainSpec::Channel { .. } | DomainSpec::Disc { .. } | DomainSpec::HalfDisc { .. } => {
            Err(RunError::Unsupported("this domain is not one in three dimensions".to_owned()))
        }
    }
}

/// A body as it is meshed.
fn solid(case: &Case, body: &Body) -> Result<Solid, RunError> {
    let shape = match &body.shape {
        ShapeSpec::Sphere { radius } => Shape::Sphere { radius: *radius },
        ShapeSpec::Capsule { length, radius } => {
            Shape::Capsule { radius: *radius, length: length - 2.0 * radius }
        }
        ShapeSpec::Cylinder { radius, .. } => Shape::Cylinder { radius: *radius },
        other => match other.semi_axes() {
            Some(semi_axes) => Shape::Ellipsoid { semi_axes },
            None => return Err(no_solid(body)),
        },
    };
    let center = Vector3::from_fn(|axis, _| body.center.get(axis).copied().unwrap_or(f64::NAN));
    let mut turn = rotation(body.orientation.as_ref());
    if let ShapeSpec::Cylinder { axis, .. } = &body.shape {
        let along = [Vector3::x(), Vector3::y(), Vector3::z()][axis.index()];
        turn = rotation(Some(&Orientation::Along(along.into())));
    }
    let pose = Isometry3::from_parts(Translation3::from(center), turn);
    let size = body.size.map(|size| size * case.mesh.scale);
    Ok(Solid { size, ..Solid::new(&body.name, shape, pose) })
}
