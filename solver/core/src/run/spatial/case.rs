//! What a case in space says of meshes: domain, sizes, bodies.

use alewife_mesh::spatial::{Body as Solid, Domain, Part};
use alewife_mesh::{Point, Sizing};
use nalgebra::{Isometry3, Vector3};

use crate::body::{MeshPoses, Pose};
use crate::case::{Body, Case, MeshFile, Model};
use crate::contact::frame_of;
use crate::coupling::{BodyShapes, Problem, ShapeError};
use crate::gait::DeformedOutline;
use crate::motion::Limits;
use crate::motion::MotionSettings;
use crate::run::RunError;
use crate::run::build::{limits, motion_settings, no_solid, rod_shape, shape_motion, sizing};

/// What stays the same over all meshes of a run.
#[derive(Debug)]
pub(super) struct SpatialCase {
    /// The domain.
    pub domain: Domain,
    /// The wanted cell sizes.
    pub sizing: Sizing<3>,
    /// When a mesh is replaced.
    pub limits: Limits,
    /// How the mesh moves.
    pub motion: MotionSettings,
    /// Whether bodies are holes of a given mesh, which is not made again.
    pub is_given: bool,
    /// Bodies that share a pivot.
    pub pivots: Vec<[usize; 2]>,
    /// The bodies at time zero.
    solids: Vec<Solid>,
    /// Their centres of mass, in the frames of the bodies (m).
    pub centroids: Vec<Point<3>>,
    /// Which bodies deform.
    pub deforms: Vec<bool>,
}

impl SpatialCase {
    /// That of a case and its problem.
    pub fn new(model: &Model, problem: &Problem<3>) -> Result<Self, RunError> {
        let solids = solids(model)?;
        let centroid = |(solid, body): (&Solid, &crate::coupling::RigidBody)| {
            // A body that deforms has its frame about its centre
            match body.shape {
                Some(_) => Point::<3>::zeros(),
                None => solid.pose.inverse_transform_point(&body.pose.center.into()).coords,
            }
        };
        Ok(Self {
            is_given: model.case.bodies_are_holes(),
            domain: model.case.domain_in_space().ok_or_else(|| no_domain(&model.case))?,
            sizing: sizing(&model.case),
            limits: limits(&model.case),
            motion: motion_settings(model, problem),
            centroids: solids.iter().zip(&problem.bodies).map(centroid).collect(),
            deforms: problem.bodies.iter().map(|body| body.shape.is_some()).collect(),
            pivots: problem.pairs_on_pivots(),
            solids,
        })
    }

    /// The bodies with these shapes in poses.
    pub fn solids_at(&self, poses: &MeshPoses, shapes: &BodyShapes) -> Vec<Solid> {
        let bodies = self.solids.iter().zip(&self.centroids).zip(poses.iter()).enumerate();
        let placed = |(body, ((solid, centroid), pose)): (usize, ((&Solid, &Point<3>), &Pose))| {
            let placed = Solid { pose: frame_of(pose, centroid), ..solid.clone() };
            with_shape(placed, shapes.deformed(body))
        };
        bodies.map(placed).collect()
    }
}

/// A body with the shape it has when it deforms.
fn with_shape(solid: Solid, deformed: Option<&DeformedOutline>) -> Solid {
    match deformed.and_then(DeformedOutline::solid) {
        Some(shape) => Solid { parts: vec![Part { shape, pose: Isometry3::identity() }], ..solid },
        None => solid,
    }
}

/// The bodies of a case as they are meshed at time zero.
pub(super) fn solids(model: &Model) -> Result<Vec<Solid>, RunError> {
    let scale = model.case.mesh.scale;
    let solid = |body: &Body| {
        let rest = body.solid(scale).ok_or_else(|| no_solid(body))?;
        let motion = match rod_shape(&model.case, body)? {
            Some(rod) => Some(rod),
            None => shape_motion(body, model.case.geometry)?,
        };
        let start = motion.map(|motion| motion.at(0.0)).transpose();
        let start = start.map_err(|reason| ShapeError { body: body.name.clone(), reason })?;
        Ok(with_shape(rest, start.as_ref()))
    };
    model.bodies.iter().map(solid).collect()
}

/// Moves bodies by whole periods to where their frames are in the domain; gives how far (m).
pub(super) fn move_into(domain: &Domain, solids: &mut [Solid]) -> Vec<Vector3<f64>> {
    let into = |solid: &mut Solid| {
        let center = &mut solid.pose.translation.vector;
        let shift = domain.shift_into(*center);
        *center += shift;
        shift
    };
    solids.iter_mut().map(into).collect()
}

/// Why a case has no domain in space.
pub(super) fn no_domain(case: &Case) -> RunError {
    let fault = case.given_mesh().and_then(MeshFile::fault);
    let planar = || "this domain is not one in three dimensions".to_owned();
    RunError::Unsupported(fault.map_or_else(planar, |fault| fault.message))
}
