//! Constrained Delaunay triangulation of boundary and interior points (spade).

use spade::handles::{FaceHandle, InnerTag};
use spade::{CdtEdge, ConstrainedDelaunayTriangulation, Point2, Triangulation as _};

use super::edges::BoundaryEdges;
use super::front::SizedPoints;
use super::triangulation::{Triangulation, WALL};
use crate::number::index_u32;
use crate::{MeshError, Point, SizeField};

type Delaunay = ConstrainedDelaunayTriangulation<Point2<f64>>;

/// A triangle of the triangulation.
type Face<'a> = FaceHandle<'a, InnerTag, Point2<f64>, (), CdtEdge<()>, ()>;

/// Number of a triangle that is not in the fluid.
const OUTSIDE: u32 = u32::MAX;

/// Triangles of the fluid between the boundary edges, through all given interior points.
///
/// # Errors
/// [`MeshError::Boundary`] when boundary edges cross each other or vertices coincide.
pub fn triangulate(
    boundary: &BoundaryEdges,
    interior: &SizedPoints,
    sizes: &SizeField,
) -> Result<Triangulation, MeshError> {
    let points: Vec<Point<2>> = boundary.points.iter().chain(&interior.points).copied().collect();
    let refuse = |vertex: usize, reason| {
        let at = points[vertex.min(points.len() - 1)];
        MeshError::Boundary { x: at.x, y: at.y, reason }
    };
    let vertices = points.iter().map(|p| Point2::new(p.x, p.y)).collect();
    let constraints =
        boundary.edges.iter().map(|e| e.vertices.map(|v| v as usize)).collect::<Vec<_>>();
    let mut conflict = None;
    let cdt = Delaunay::try_bulk_load_cdt(vertices, constraints, |edge| {
        conflict = conflict.or(Some(edge[0]))
    })
    .map_err(|_| refuse(0, "a coordinate is not finite, or too large"))?;
    if let Some(vertex) = conflict {
        return Err(refuse(vertex, "boundary edges cross"));
    }
    if cdt.num_vertices() != points.len() {
        return Err(refuse(0, "two vertices coincide"));
    }

    let fluid = Fluid::new(&cdt, boundary)
        .map_err(|vertex| refuse(vertex, "the boundary is not closed"))?;
    let at_boundary = boundary.points.iter().map(|x| sizes.at(*x));
    let sizes = at_boundary.chain(interior.sizes.iter().copied()).collect();
    Ok(Triangulation::new(points, sizes, fluid.triangles(), fluid.across(), boundary.edges.clone()))
}

/// The triangles of the fluid: those that can be reached from the left of boundary edges without
/// crossing one.
struct Fluid<'a> {
    faces: Vec<Face<'a>>,
    /// Position of each face in `faces`, or [`OUTSIDE`].
    number: Vec<u32>,
    /// Boundary edge that starts at each vertex.
    edge_from: Vec<u32>,
}

impl<'a> Fluid<'a> {
    /// Gathers the triangles; a vertex at which the boundary is open is the error.
    fn new(cdt: &'a Delaunay, boundary: &BoundaryEdges) -> Result<Self, usize> {
        let mut edge_from = vec![u32::MAX; cdt.num_vertices()];
        for (i, edge) in boundary.edges.iter().enumerate() {
            edge_from[edge.vertices[0] as usize] = index_u32(i);
        }
        let number = vec![OUTSIDE; cdt.num_all_faces()];
        let mut fluid = Self { faces: Vec::new(), number, edge_from };
        for edge in cdt.directed_edges().filter(|e| e.is_constraint_edge()) {
            let (from, to) = (edge.from().index(), edge.to().index());
            let boundary_edge = boundary.edges[fluid.edge_from[from] as usize];
            if boundary_edge.vertices[1] as usize == to {
                fluid.include(edge.face().as_inner().ok_or(from)?);
            }
        }
        let mut next = 0;
        while next < fluid.faces.len() {
            for edge in fluid.faces[next].adjacent_edges() {
                if !edge.is_constraint_edge() {
                    fluid.include(edge.rev().face().as_inner().ok_or(edge.from().index())?);
                }
            }
            next += 1;
        }
        Ok(fluid)
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
        let corners = |face: &Face<'_>| face.vertices().map(|vertex| index_u32(vertex.index()));
        self.faces.iter().map(corners).collect()
    }

    /// What is behind the sides of all triangles.
    fn across(&self) -> Vec<[u32; 3]> {
        let behind = |face: &Face<'_>| {
            face.adjacent_edges().map(|edge| {
                if edge.is_constraint_edge() {
                    WALL | self.edge_from[edge.from().index()]
                } else {
                    self.number[edge.rev().face().index()]
                }
            })
        };
        self.faces.iter().map(behind).collect()
    }
}
