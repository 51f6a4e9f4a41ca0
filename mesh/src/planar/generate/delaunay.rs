//! Constrained Delaunay triangulation of boundary and interior points (spade).

use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation as _};

use super::edges::BoundaryEdges;
use super::front::SizedPoints;
use super::triangulation::{Triangulation, WALL};
use crate::{MeshError, Point, SizeField};

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
    let cdt = ConstrainedDelaunayTriangulation::<Point2<f64>>::try_bulk_load_cdt(
        vertices,
        constraints,
        |edge| conflict = conflict.or(Some(edge[0])),
    )
    .map_err(|_| refuse(0, "a coordinate is not finite, or too large"))?;
    if let Some(vertex) = conflict {
        return Err(refuse(vertex, "boundary edges cross"));
    }
    if cdt.num_vertices() != points.len() {
        return Err(refuse(0, "two vertices coincide"));
    }

    // The fluid is what can be reached from the left of boundary edges without crossing one
    let mut edge_from = vec![u32::MAX; points.len()];
    for (i, edge) in boundary.edges.iter().enumerate() {
        edge_from[edge.vertices[0] as usize] = i as u32;
    }
    const OUTSIDE: u32 = u32::MAX;
    let mut number = vec![OUTSIDE; cdt.num_all_faces()];
    let mut order = Vec::new();
    for edge in cdt.directed_edges().filter(|e| e.is_constraint_edge()) {
        let (from, to) = (edge.from().index(), edge.to().index());
        let boundary_edge = boundary.edges[edge_from[from] as usize];
        if boundary_edge.vertices[1] as usize != to {
            continue;
        }
        let Some(face) = edge.face().as_inner() else {
            return Err(refuse(from, "the boundary is not closed"));
        };
        if number[face.index()] == OUTSIDE {
            number[face.index()] = order.len() as u32;
            order.push(face);
        }
    }
    let mut next = 0;
    while next < order.len() {
        for edge in order[next].adjacent_edges().iter().filter(|e| !e.is_constraint_edge()) {
            let Some(face) = edge.rev().face().as_inner() else {
                return Err(refuse(edge.from().index(), "the boundary is not closed"));
            };
            if number[face.index()] == OUTSIDE {
                number[face.index()] = order.len() as u32;
                order.push(face);
            }
        }
        next += 1;
    }
    let triangles = order.iter().map(|f| f.vertices().map(|v| v.index() as u32)).collect();
    let across = order
        .iter()
        .map(|face| {
            face.adjacent_edges().map(|edge| {
                if edge.is_constraint_edge() {
                    WALL | edge_from[edge.from().index()]
                } else {
                    number[edge.rev().face().index()]
                }
            })
        })
        .collect();
    let at_boundary = boundary.points.iter().map(|x| sizes.at(*x));
    let sizes = at_boundary.chain(interior.sizes.iter().copied()).collect();
    Ok(Triangulation::new(points, sizes, triangles, across, boundary.edges.clone()))
}
