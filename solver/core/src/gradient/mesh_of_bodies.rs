//! `MeshOfBodies`: the mesh of a case, for the same bodies in other places and of other sizes.

use alewife_mesh::{BoundaryId, BoundaryKind, Facet, Mesh, NodeId, Point};
use nalgebra::Vector3;

use super::error::GradientError;
use super::moment::Moment;
use super::point::CasePoint;
use crate::body::{Pose, on_mesh};
use crate::case::{CaseFile, Model};
use crate::coupling::Problem;
use crate::motion::{
    DEGENERATE, Limits, MeshMotion, MotionSettings, RigidMove, mesh_boundary_conditions,
};
use crate::run::{CaseMesh, Dimension, NearestOnBody, build_problem, motion_settings};

/// The mesh of a case with what moves it.
pub(super) struct MeshOfBodies<const D: usize> {
    mesh: Mesh<D>,
    /// Body of each boundary.
    bodies: Vec<Option<usize>>,
    /// Whole periods by which each body has been moved into the mesh (m).
    shifts: Vec<Vector3<f64>>,
    /// The bodies of the case at time zero.
    poses: Vec<Pose>,
    /// The same where the mesh was made.
    made_at: Vec<Pose>,
    /// Whether the mesh turns with each body.
    turns: Vec<bool>,
    nearest: Vec<NearestOnBody<D>>,
    motion: MeshMotion<D>,
    /// Shortest edge on a body (m).
    shortest_edge: f64,
}

/// A mesh as it was made.
pub(super) struct Made<'a, const D: usize> {
    /// The mesh.
    pub mesh: &'a Mesh<D>,
    /// Whole periods by which each body has been moved into it (m).
    pub shifts: &'a [Vector3<f64>],
    /// Poses of the bodies in the laboratory.
    pub poses: &'a [Pose],
}

impl<const D: usize> MeshOfBodies<D>
where
    Dimension<D>: CaseMesh<D>,
{
    /// Takes a mesh that was made for bodies of a case, which may have moved since its beginning, and its problem.
    pub fn new(
        model: &Model,
        problem: &Problem<D>,
        made: Made<'_, D>,
    ) -> Result<Self, GradientError> {
        let Made { mesh, shifts, poses: made_at } = made;
        let bodies = mesh.boundaries.iter().map(|boundary| match boundary.kind {
            BoundaryKind::Body(body) => Some(body),
            BoundaryKind::Side | BoundaryKind::Axis => None,
        });
        let bodies: Vec<Option<usize>> = bodies.collect();
        let MotionSettings { kind, turns } = motion_settings(model, problem);
        let motion = MeshMotion::new(mesh, kind, &mesh_boundary_conditions(mesh, true))?;
        let mut shortest_edge = f64::INFINITY;
        for facet in mesh.facets.iter().filter(|facet| bodies[facet.boundary.index()].is_some()) {
            let vertices = mesh.facet_vertices(facet);
            for (end, to) in vertices.iter().enumerate() {
                for from in &vertices[..end] {
                    let length = (mesh.nodes[*to] - mesh.nodes[*from]).norm();
                    shortest_edge = shortest_edge.min(length);
                }
            }
        }
        Ok(Self {
            mesh: mesh.clone(),
            bodies,
            shifts: shifts.to_vec(),
            poses: problem.bodies.iter().map(|body| body.pose).collect(),
            made_at: made_at.to_vec(),
            turns,
            nearest: Dimension::<D>::nearest_on_bodies(model)?,
            motion,
            shortest_edge,
        })
    }

    /// A case with other numbers at a moment, on this mesh with its nodes moved.
    pub fn point(&self, file: CaseFile, moment: &Moment) -> Result<CasePoint<D>, GradientError> {
        let problem = build_problem(&file.model, &self.mesh)?;
        let poses = Moment::START.poses(&problem);
        let now = moment.poses(&problem);
        let nearest = Dimension::<D>::nearest_on_bodies(&file.model)?;
        let given = |boundary: BoundaryId, _: NodeId, at: &Point<D>| {
            let Some(body) = self.bodies[boundary.index()] else { return Point::<D>::zeros() };
            let in_laboratory = at - on_mesh::<D>(&self.shifts[body]);
            let carried = |from: &Pose, to: &Pose, point: &Point<D>| {
                self.carrying(body, from, to).displacement(point)
            };
            // By way of where the bodies begin, as it is there that surfaces are known
            let back = carried(&self.made_at[body], &self.poses[body], &in_laboratory);
            let here = in_laboratory + back;
            let there = here + carried(&self.poses[body], &poses[body], &here);
            // Nodes need not be on the surface, but stay as far from it
            let way = nearest[body](&there) - self.nearest[body](&here);
            back + way + carried(&poses[body], &now[body], &(here + way))
        };
        let mut way = 0.0f64;
        for facet in &self.mesh.facets {
            for node in self.mesh.facet_vertices(facet) {
                way = way.max(given(facet.boundary, node, &self.mesh.nodes[node]).norm());
            }
        }
        let mut mesh = self.mesh.clone();
        if way == 0.0 {
            return CasePoint::new(file, problem, mesh, &self.shifts, moment);
        }
        let moved = self.motion.displacements(&given)?;
        mesh.nodes.iter_mut().zip(&moved).for_each(|(node, way)| *node += way);
        // Volumes may be those of the mesh
        let problem = build_problem(&file.model, &mesh)?;
        let mut point = CasePoint::new(file, problem, mesh, &self.shifts, moment)?;
        point.moved = moved;
        Ok(point)
    }

    /// How a body carries its nodes from one pose to another: a round one does not turn them.
    fn carrying(&self, body: usize, from: &Pose, to: &Pose) -> RigidMove {
        let orientation = if self.turns[body] { to.orientation } else { from.orientation };
        RigidMove::between(from, &Pose { orientation, ..*to })
    }

    /// Whole periods by which each body has been moved into it (m).
    pub fn shifts(&self) -> &[Vector3<f64>] {
        &self.shifts
    }

    /// Shortest edge on a body (m).
    pub fn shortest_edge(&self) -> f64 {
        self.shortest_edge
    }

    /// Largest way of a node on a body between two cases, over the shortest edge on a body.
    pub fn way(&self, from: &CasePoint<D>, to: &CasePoint<D>) -> f64 {
        let moved = |case: &CasePoint<D>, node: NodeId| {
            case.moved.get(node.index()).copied().unwrap_or_else(Point::<D>::zeros)
        };
        let mut way = 0.0f64;
        for facet in self.mesh.facets.iter().filter(|facet| self.is_body(facet)) {
            for node in self.mesh.facet_vertices(facet) {
                way = way.max((moved(to, node) - moved(from, node)).norm());
            }
        }
        way / self.shortest_edge
    }

    /// Whether the mesh is as good in all cells as it was before its nodes moved, but for a factor.
    pub fn is_fit(&self, point: &CasePoint<D>) -> bool {
        let quality = point.mesh.cell_qualities();
        let new = self.mesh.cell_qualities();
        let limit = Limits::default().quality;
        quality.iter().zip(&new).all(|(quality, new)| *quality >= limit * new)
    }

    /// Whether no flow can be solved on the mesh.
    pub fn is_degenerate(&self, point: &CasePoint<D>) -> bool {
        let lowest =
            |mesh: &Mesh<D>| mesh.worst_cell().map_or(f64::INFINITY, |worst| worst.quality);
        lowest(&point.mesh) <= DEGENERATE * lowest(&self.mesh)
    }

    fn is_body(&self, facet: &Facet) -> bool {
        self.bodies[facet.boundary.index()].is_some()
    }
}
