//! Constrained Delaunay triangulation of boundary and interior points (spade).

use std::collections::HashMap;

use spade::handles::{DirectedEdgeHandle, FaceHandle, InnerTag};
use spade::{CdtEdge, ConstrainedDelaunayTriangulation, Point2, Triangulation as _};

use super::copies::{Copies, steps_between};
use super::edges::BoundaryEdges;
use super::front::SizedPoints;
use super::triangulation::{Triangulation, WALL};
use crate::number::index_u32;
use crate::planar::torus::Torus;
use crate::{MeshError, Point, SizeField, interrupt};

type Delaunay = ConstrainedDelaunayTriangulation<Point2<f64>>;

/// A triangle of the triangulation.
type Face<'a> = FaceHandle<'a, InnerTag, Point2<f64>, (), CdtEdge<()>, ()>;

/// A side of a triangle, which is on its left.
type Side<'a> = DirectedEdgeHandle<'a, Point2<f64>, (), CdtEdge<()>, ()>;

/// Number of a triangle that is not in the fluid.
const OUTSIDE: u32 = u32::MAX;

/// Triangles of the fluid between the boundary edges, through all given interior points.
///
/// Of a torus images of the points are triangulated, too, and one of the images of each triangle is taken.
///
/// # Errors
/// [`MeshError::Boundary`] when boundary edges cross each other or vertices coincide.
pub fn triangulate(
    boundary: &BoundaryEdges,
    interior: &SizedPoints,
    sizes: &SizeField,
    torus: Torus,
) -> Result<Triangulation, MeshError> {
    let points: Vec<Point<2>> = boundary.points.iter().chain(&interior.points).copied().collect();
    let at_boundary = boundary.points.iter().map(|x| sizes.at(*x));
    let sizes: Vec<f64> = at_boundary.chain(interior.sizes.iter().copied()).collect();
    let copies = Copies::new(&points, &sizes, torus);
    let refuse = |copy: usize, reason| {
        let at = copies.places[copy.min(copies.places.len() - 1)];
        MeshError::Boundary { x: at.x, y: at.y, reason }
    };
    let vertices = copies.places.iter().map(|p| Point2::new(p.x, p.y)).collect();
    let constraints = copies.edges(&boundary.edges);
    let mut conflict = None;
    let cdt = Delaunay::try_bulk_load_cdt(vertices, constraints, |edge| {
        conflict = conflict.or(Some(edge[0]))
    })
    .map_err(|_| refuse(0, "a coordinate is not finite, or too large"))?;
    interrupt::check()?;
    if let Some(vertex) = conflict {
        return Err(refuse(vertex, "boundary edges cross"));
    }
    if cdt.num_vertices() != copies.places.len() {
        return Err(refuse(0, "two vertices coincide"));
    }

    let not_closed = |vertex| refuse(vertex, "the boundary is not closed");
    let fluid = Fluid::new(&cdt, boundary, &copies).map_err(not_closed)?;
    interrupt::check()?;
    let (triangles, across) = (fluid.triangles(), fluid.across().map_err(not_closed)?);
    Ok(Triangulation::new(points, sizes, triangles, across, boundary.edges.clone(), torus))
}

/// A side wherever it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct SideKey {
    ends: [u32; 2],
    /// Whole periods from one to the other.
    steps: [i32; 2],
}

/// The triangles of the fluid: those that can be reached from the left of boundary edges without
/// crossing one.
struct Fluid<'a> {
    copies: &'a Copies,
    faces: Vec<Face<'a>>,
    /// Position of each face in `faces`, or [`OUTSIDE`].
    number: Vec<u32>,
    /// Boundary edge that starts at each vertex.
    edge_from: Vec<u32>,
    /// Of a torus, the triangle on the left of each side, which stands for all its images.
    left_of: HashMap<SideKey, Face<'a>>,
}

impl<'a> Fluid<'a> {
    /// Gathers the triangles; a vertex at which the boundary is open is the error.
    fn new(cdt: &'a Delaunay, boundary: &BoundaryEdges, copies: &'a Copies) -> Result<Self, usize> {
        let mut edge_from = vec![u32::MAX; cdt.num_vertices()];
        for (i, edge) in boundary.edges.iter().enumerate() {
            edge_from[edge.vertices[0] as usize] = index_u32(i);
        }
        let number = vec![OUTSIDE; cdt.num_all_faces()];
        let left_of = HashMap::new();
        let mut fluid = Self { copies, faces: Vec::new(), number, edge_from, left_of };
        if copies.has_images() {
            let originals = cdt.inner_faces().filter(|face| fluid.is_original(face));
            let sides = originals.flat_map(|face| face.adjacent_edges().map(|side| (side, face)));
            fluid.left_of = sides.map(|(side, face)| (fluid.key(side), face)).collect();
        }
        let is_wall = |side: &Side<'a>| {
            let [from, to] = fluid.key(*side).ends;
            side.is_constraint_edge()
                && boundary.edges[fluid.edge_from[from as usize] as usize].vertices[1] == to
        };
        let mut walls: Vec<Side<'a>> = cdt.directed_edges().filter(is_wall).collect();
        if copies.has_images() {
            // Wherever on the torus everything is, the triangles are in the same order
            walls.sort_by_key(|side| fluid.edge_from[fluid.key(*side).ends[0] as usize]);
        }
        for wall in walls {
            fluid.include(fluid.left(wall)?);
        }
        let mut next = 0;
        while next < fluid.faces.len() && !interrupt::is_requested() {
            for side in fluid.sides(&fluid.faces[next]) {
                // Images that are divided in different ways overlap
                if fluid.left(side)? != fluid.faces[next] {
                    return Err(side.from().index());
                }
                if !side.is_constraint_edge() {
                    fluid.include(fluid.left(side.rev())?);
                }
            }
            next += 1;
        }
        Ok(fluid)
    }

    fn is_original(&self, face: &Face<'_>) -> bool {
        self.copies.is_original(face.vertices().map(|vertex| vertex.index()))
    }

    /// The sides of a triangle, of a torus from the lowest vertex on.
    fn sides(&self, face: &Face<'a>) -> [Side<'a>; 3] {
        let mut sides = face.adjacent_edges();
        if self.copies.has_images() {
            let lowest = (0..3).min_by_key(|i| self.key(sides[*i]).ends[0]);
            sides.rotate_left(lowest.unwrap_or(0));
        }
        sides
    }

    fn key(&self, side: Side<'_>) -> SideKey {
        let [from, to] = [side.from(), side.to()].map(|end| self.copies.of[end.index()]);
        let steps = steps_between(from.steps, to.steps);
        SideKey { ends: [from.vertex, to.vertex], steps }
    }

    /// The triangle on the left of a side; its start is the error where there is none.
    fn left(&self, side: Side<'a>) -> Result<Face<'a>, usize> {
        let own = side.face().as_inner().filter(|face| self.is_original(face));
        own.or_else(|| self.left_of.get(&self.key(side)).copied()).ok_or(side.from().index())
    }

    fn include(&mut self, face: Face<'a>) {
        let number = &mut self.number[face.index()];
        if *number == OUTSIDE {
            *number = index_u32(self.faces.len());
            self.faces.push(face);
        }
    }

    /// Corners of all triangles.
    fn triangles(&self) -> Vec<[u32; 3]> {
        let corners = |face: &Face<'a>| self.sides(face).map(|side| self.key(side).ends[0]);
        self.faces.iter().map(corners).collect()
    }

    /// What is behind the sides of all triangles.
    fn across(&self) -> Result<Vec<[u32; 3]>, usize> {
        let behind = |side: Side<'a>| {
            if side.is_constraint_edge() {
                return Ok(WALL | self.edge_from[self.key(side).ends[0] as usize]);
            }
            self.left(side.rev()).map(|face| self.number[face.index()])
        };
        let around = |face: &Face<'a>| {
            let [a, b, c] = self.sides(face).map(behind);
            Ok([a?, b?, c?])
        };
        self.faces.iter().map(around).collect()
    }
}
