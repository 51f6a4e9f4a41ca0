//! `SpatialScene`: domain and surfaces of the bodies of a mesh in space.

use std::sync::Arc;

use alewife_mesh::spatial::{GapQuery, generate};
use alewife_mesh::{BoundaryId, Mesh, NodeId, Point};
use nalgebra::Vector3;

use super::case::{SpatialCase, move_into};
use crate::body::Pose;
use crate::contact::{Gaps, SpatialGaps, frame_of};
use crate::coupling::BodyShapes;
use crate::motion::{Fresh, needs_remesh};
use crate::simulation::scene::{Meshed, PosesByShift, RemeshError, Scene};

/// Domain and bodies as they were meshed.
#[derive(Debug)]
pub(super) struct SpatialScene {
    case: Arc<SpatialCase>,
    fresh: Fresh,
    surroundings: GapQuery,
    gaps: SpatialGaps,
}

impl SpatialScene {
    /// Takes a mesh with the bodies at poses.
    pub fn new(
        case: Arc<SpatialCase>,
        mesh: &Mesh<3>,
        poses: &[Pose],
    ) -> Result<Self, RemeshError> {
        let solids = case.solids_at(poses);
        let surroundings = GapQuery::new(&case.domain, &solids)?;
        let fresh = Fresh::new(mesh, &surroundings, case.limits);
        let gaps = SpatialGaps::new(&case.domain, &solids, &case.centroids)?
            .with_joined(case.pivots.iter().copied());
        Ok(Self { case, fresh, surroundings, gaps })
    }
}

impl Scene<3> for SpatialScene {
    fn gaps(&self) -> &dyn Gaps {
        &self.gaps
    }

    /// No body in space deforms so far.
    fn deformed_gaps(&self, _shapes: &BodyShapes) -> Option<Box<dyn Gaps>> {
        None
    }

    fn material_position(
        &self,
        _node: NodeId,
        _body: usize,
        _shapes: &BodyShapes,
    ) -> Option<Vector3<f64>> {
        None
    }

    fn side_displacement(
        &self,
        _boundary: BoundaryId,
        _reference: &Point<3>,
        _time: f64,
    ) -> Option<Point<3>> {
        None
    }

    fn has_moving_wall(&self) -> bool {
        false
    }

    fn lowest_quality(&self) -> f64 {
        self.fresh.lowest()
    }

    fn remesh_reason(
        &mut self,
        mesh: &Mesh<3>,
        poses: &[Pose],
        _shapes: &BodyShapes,
    ) -> Option<String> {
        for (body, (pose, centroid)) in poses.iter().zip(&self.case.centroids).enumerate() {
            let place = frame_of(pose, centroid);
            if let Some(moved) = self.surroundings.body(body).map(|known| known.placed_at(&place)) {
                self.surroundings.set_body(body, moved);
            }
        }
        needs_remesh(mesh, &self.fresh, &self.surroundings).map(|reason| reason.to_string())
    }

    fn remesh(
        &self,
        poses: &[Pose],
        _shapes: &BodyShapes,
        shifted: PosesByShift<'_>,
    ) -> Result<Meshed<3>, RemeshError> {
        let case = &self.case;
        let mut solids = case.solids_at(poses);
        let shifts = move_into(&case.domain, &mut solids);
        let mesh = generate(&case.domain, &solids, &case.sizing)?;
        let poses = shifted(&shifts);
        let scene = Self::new(Arc::clone(case), &mesh, &poses)?;
        Ok(Meshed { mesh, scene: Box::new(scene), poses, shifts })
    }

    fn images(&self, [old, new]: [&Mesh<3>; 2]) -> Vec<Point<3>> {
        self.case.domain.images_around(old.nodes.iter().chain(&new.nodes))
    }

    fn domain_start(&self) -> Point<3> {
        self.case.domain.corners()[0]
    }
}
