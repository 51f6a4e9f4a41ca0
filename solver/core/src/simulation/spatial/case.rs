//! What a case in space says of meshes: domain, sizes, bodies.

use alewife_mesh::spatial::{Body as Solid, Domain};
use alewife_mesh::{Point, Sizing};
use nalgebra::Vector3;

use crate::body::Pose;
use crate::case::Model;
use crate::contact::frame_of;
use crate::coupling::Problem;
use crate::motion::Limits;
use crate::simulation::RunError;
use crate::simulation::build::no_solid;
use crate::simulation::moving_mesh::MotionSettings;
use crate::simulation::sizing::{limits, sizing};

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
    /// Bodies that share a pivot.
    pub pivots: Vec<[usize; 2]>,
    /// The bodies at time zero.
    solids: Vec<Solid>,
    /// Their centres of mass, in the frames of the bodies (m).
    pub centroids: Vec<Point<3>>,
}

impl SpatialCase {
    /// That of a case and its problem.
    pub fn new(model: &Model, problem: &Problem<3>) -> Result<Self, RunError> {
        let solids = solids(model)?;
        let centroid = |(solid, body): (&Solid, &crate::coupling::RigidBody)| {
            solid.pose.inverse_transform_point(&body.pose.center.into()).coords
        };
        Ok(Self {
            domain: model.case.domain_in_space().ok_or_else(no_domain)?,
            sizing: sizing(&model.case),
            limits: limits(&model.case),
            motion: MotionSettings::new(model, problem),
            centroids: solids.iter().zip(&problem.bodies).map(centroid).collect(),
            pivots: problem.pairs_on_pivots(),
            solids,
        })
    }

    /// The bodies in poses.
    pub fn solids_at(&self, poses: &[Pose]) -> Vec<Solid> {
        let placed = |((solid, centroid), pose): ((&Solid, &Point<3>), &Pose)| Solid {
            pose: frame_of(pose, centroid),
            ..solid.clone()
        };
        self.solids.iter().zip(&self.centroids).zip(poses).map(placed).collect()
    }
}

/// The bodies of a case as they are meshed at time zero.
pub(super) fn solids(model: &Model) -> Result<Vec<Solid>, RunError> {
    let scale = model.case.mesh.scale;
    model.bodies.iter().map(|body| body.solid(scale).ok_or_else(|| no_solid(body))).collect()
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

pub(super) fn no_domain() -> RunError {
    RunError::Unsupported("this domain is not one in three dimensions".to_owned())
}
