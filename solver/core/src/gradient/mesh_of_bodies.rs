//! `MeshOfBodies`: the mesh of a case, for the same bodies in other places and of other sizes.

use alewife_mesh::{BoundaryId, BoundaryKind, Facet, Mesh, NodeId, Point};
use nalgebra::Vector3;

use super::error::GradientError;
use super::moment::Moment;
use super::point::CasePoint;
use crate::body::{Pose, on_mesh};
use crate::case::{CaseFile, Model};
use crate::coupling::Problem;
use crate::motion::{Limits, MeshMotion, RigidMove, mesh_boundary_conditions};
use crate::run::{CaseMesh, Dimension, NearestOnBody, build_problem, motion_settings};

/// The mesh of a case with what moves it.
pub(super) struct MeshOfBodies<const D: usize> {
    mesh: Mesh<D>,
    /// Body of each boundary.
    bodies: Vec<Option<usize>>,
    /// Whole periods by which each body has been moved into the mesh (m).
    shifts: Vec<Vector3<f64>>,
    poses: Vec<Pose>,
    nearest: Vec<NearestOnBody<D>>,
    motion: MeshMotion<D>,
    /// Shortest edge on a body (m).
    shortest_edge: f64,
}

impl<const D: usize> MeshOfBodies<D>
where
    Dimension<D>: CaseMesh<D>,
{
    /// Takes the mesh of a case and its problem.
    pub fn new(
        model: &Model,
        problem: &Problem<D>,
        mesh: &Mesh<D>,
        shifts: &[Vector3<f64>],
    ) -> Result<Self, GradientError> {
        let bodies = mesh.boundaries.iter().map(|boundary| match boundary.kind {
            BoundaryKind::Body(body) => Some(body),
            BoundaryKind::Side | BoundaryKind::Axis => None,
        });
        let bodies: Vec<Option<usize>> = bodies.collect();
        let kind = motion_settings(model, problem).kind;
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
            nearest: Dimension::<D>::nearest_on_bodies(model)?,
            motion,
            shortest_edge,
        })
    }

    /// A case with other numbers at a moment, on this mesh with its nodes moved.
    pub fn point(&self, file: CaseFile, moment: &Moment) -> Result<CasePoint<D>, GradientError> {
        let problem = build_problem(&file.model, &self.mesh)?;
        let poses = Moment::START.poses(&problem);
        let pairs = poses.iter().zip(moment.poses(&problem));
        let moves: Vec<RigidMove> =
            pairs.map(|(start, now)| RigidMove::between(start, &now)).collect();
        let nearest = Dimension::<D>::nearest_on_bodies(&file.model)?;
        let given = |boundary: BoundaryId, _: NodeId, at: &Point<D>| {
            let Some(body) = self.bodies[boundary.index()] else { return Point::<D>::zeros() };
            let shift = on_mesh::<D>(&self.shifts[body]);
            let here = at - shift;
            let carried =
                here + RigidMove::between(&self.poses[body], &poses[body]).displacement(&here);
            // Nodes need not be on the surface, but stay as far from it
            let way = nearest[body](&carried) - self.nearest[body](&here);
            way + moves[body].displacement(&(here + way))
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

    fn is_body(&self, facet: &Facet) -> bool {
        self.bodies[facet.boundary.index()].is_some()
    }
}
