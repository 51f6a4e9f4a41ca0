//! `Parts`: vertices, cells and named facets of a file on the way to a mesh.

use std::collections::{BTreeMap, BTreeSet};

use crate::{BoundaryId, Point, Simplex};

/// Vertices, cells and named facets on the way to a mesh.
#[derive(Debug, Clone)]
pub struct Parts<const D: usize> {
    /// Positions of the vertices (m).
    pub vertices: Vec<Point<D>>,
    /// Vertices of each cell, D + 1 of them, the cells positive.
    pub cells: Vec<Vec<usize>>,
    /// Elements the cells are from.
    pub tags: Vec<u64>,
    /// Boundaries of the facets on the boundary, by their vertices in ascending order.
    pub sides: BTreeMap<[usize; D], BoundaryId>,
    /// Tag and position (m) of the nodes given in edges, by the ends in ascending order.
    pub middles: BTreeMap<[usize; 2], Middle<D>>,
    /// What was made of the file that its author may not expect.
    pub notes: Vec<String>,
}

/// A node in an edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Middle<const D: usize> {
    /// Its tag in the file.
    pub tag: u64,
    /// Where it is (m).
    pub point: Point<D>,
}

/// Vertices of a facet of a cell, ascending.
pub fn facet_of<const D: usize>(cell: &[usize], side: usize) -> [usize; D] {
    let mut vertices = Simplex::<D>::facet_vertices(side).map(|local| cell[local]);
    vertices.sort_unstable();
    vertices
}

/// Edges of facets, by their ends in ascending order.
pub fn edges_of<const D: usize>(sides: &BTreeMap<[usize; D], BoundaryId>) -> BTreeSet<[usize; 2]> {
    let pairs = sides.keys().flat_map(|vertices| {
        let each = vertices.iter().enumerate();
        each.flat_map(|(i, a)| vertices[i + 1..].iter().map(|b| [*a, *b]))
    });
    pairs.collect()
}
