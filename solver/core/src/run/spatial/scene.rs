//! `SpatialScene`: domain and surfaces of the bodies of a mesh in space.

use std::collections::BTreeMap;
use std::sync::Arc;

use alewife_mesh::spatial::{GapQuery, estimate_cells, generate};
use alewife_mesh::{BoundaryKind, Mesh, NodeId, Point};
use nalgebra::Vector3;

use super::case::{SpatialCase, move_into};
use crate::body::MeshPoses;
use crate::contact::{Gaps, SpatialGaps, frame_of};
use crate::coupling::BodyShapes;
use crate::gait::MaterialPoint;
use crate::motion::{Fresh, needs_remesh};
use crate::motion::{Meshed, MostCells, PosesByShift, RemeshError, RestPlace, Scene};

/// Domain and bodies as they were meshed.
#[derive(Debug)]
pub(super) struct SpatialScene {
    case: Arc<SpatialCase>,
    /// Material points of the nodes on bodies that deform.
    materials: BTreeMap<NodeId, OnSurface>,
    fresh: Fresh,
    surroundings: GapQuery,
    gaps: SpatialGaps,
}

/// A point of the surface of a body that deforms.
#[derive(Debug, Clone, Copy)]
struct OnSurface {
    body: usize,
    at: MaterialPoint,
}

impl SpatialScene {
    /// Takes a mesh with the bodies of these shapes at poses.
    pub fn new(
        case: Arc<SpatialCase>,
        mesh: &Mesh<3>,
        poses: &MeshPoses,
        shapes: &BodyShapes,
    ) -> Result<Self, RemeshError> {
        let solids = case.solids_at(poses, shapes);
        let surroundings = GapQuery::new(&case.domain, &solids)?;
        let fresh = Fresh::new(mesh, &surroundings, case.limits);
        let gaps = SpatialGaps::new(&case.domain, &solids, &case.centroids)?
            .with_joined(case.pivots.iter().copied());
        let materials = materials(mesh, poses, shapes);
        Ok(Self { case, materials, fresh, surroundings, gaps })
    }
}

/// Material points of the nodes on bodies that deform.
fn materials(
    mesh: &Mesh<3>,
    poses: &MeshPoses,
    shapes: &BodyShapes,
) -> BTreeMap<NodeId, OnSurface> {
    let mut materials = BTreeMap::new();
    for facet in &mesh.facets {
        let BoundaryKind::Body(body) = mesh.boundaries[facet.boundary].kind else { continue };
        let Some(deformed) = shapes.deformed(body) else { continue };
        let pose = &poses[body];
        for node in mesh.facet_nodes(facet) {
            materials.entry(node).or_insert_with(|| {
                let lever = mesh.nodes[node] - pose.center;
                let at = deformed.material_at(&(pose.rotation().inverse() * lever));
                OnSurface { body, at }
            });
        }
    }
    materials
}

impl Scene<3> for SpatialScene {
    fn gaps(&self) -> &dyn Gaps {
        &self.gaps
    }

    fn deformed_gaps(&self, shapes: &BodyShapes) -> Option<Box<dyn Gaps>> {
        let mut gaps: Option<SpatialGaps> = None;
        for body in 0..self.case.deforms.len() {
            if let Some(surface) = shapes.surface(body) {
                gaps.get_or_insert_with(|| self.gaps.clone()).deform_surface(body, surface.clone());
            }
        }
        gaps.map(|gaps| -> Box<dyn Gaps> { Box::new(gaps) })
    }

    fn material_position(
        &self,
        node: NodeId,
        body: usize,
        shapes: &BodyShapes,
    ) -> Option<Vector3<f64>> {
        Some(shapes.deformed(body)?.place(self.materials.get(&node)?.at))
    }

    fn rest_places(&self, shapes: &BodyShapes) -> Vec<RestPlace> {
        let place = |(node, on): (&NodeId, &OnSurface)| {
            let place = shapes.deformed(on.body)?.rest_place_in_space(on.at)?;
            Some(RestPlace { node: *node, body: on.body, place })
        };
        self.materials.iter().filter_map(place).collect()
    }

    fn lowest_quality(&self) -> f64 {
        self.fresh.lowest()
    }

    fn remesh_reason(
        &mut self,
        mesh: &Mesh<3>,
        poses: &MeshPoses,
        shapes: &BodyShapes,
    ) -> Option<String> {
        for (body, (pose, centroid)) in poses.iter().zip(&self.case.centroids).enumerate() {
            let place = frame_of(pose, centroid);
            let own = shapes.surface(body).or_else(|| self.surroundings.body(body));
            if let Some(moved) = own.map(|known| known.placed_at(&place)) {
                self.surroundings.set_body(body, moved);
            }
        }
        needs_remesh(mesh, &self.fresh, &self.surroundings).map(|reason| reason.to_string())
    }

    fn remesh(
        &self,
        poses: &MeshPoses,
        shapes: &BodyShapes,
        shifted: PosesByShift<'_>,
        most: MostCells,
    ) -> Result<Meshed<3>, RemeshError> {
        let case = &self.case;
        if case.is_given {
            return Err(RemeshError::Given);
        }
        let mut solids = case.solids_at(poses, shapes);
        let shifts = move_into(&case.domain, &mut solids);
        most.check_before(|limit| estimate_cells(&case.domain, &solids, &case.sizing, limit))?;
        let mesh = generate(&case.domain, &solids, &case.sizing)?;
        most.check(&mesh)?;
        let poses = shifted(&shifts);
        let scene = Self::new(Arc::clone(case), &mesh, &poses, shapes)?;
        Ok(Meshed { mesh, scene: Box::new(scene), poses, shifts })
    }

    fn images(&self, [old, new]: [&Mesh<3>; 2]) -> Vec<Point<3>> {
        self.case.domain.images_around(old.nodes.iter().chain(&new.nodes))
    }
}
