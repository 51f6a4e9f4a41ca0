//! `Mesh<D>`: positions of the P2 nodes, cells, tagged boundary facets.

use nalgebra::SVector;

/// A place in space (m), D components.
pub type Point<const D: usize> = SVector<f64, D>;

/// Number of P2 nodes of a simplex: 6 for a triangle, 10 for a tetrahedron.
#[must_use]
pub const fn nodes_per_cell(dimension: usize) -> usize {
    (dimension + 1) * (dimension + 2) / 2
}

/// What a boundary of the mesh belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BoundaryKind {
    /// A side of the domain.
    Side,
    /// The surface of the body with this index.
    Body(usize),
    /// The axis of an axisymmetric domain.
    Axis,
}

/// A named part of the boundary.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Boundary {
    /// Name used in the case file: `left`, `wall`, `axis`, or the name of the body.
    pub name: String,
    /// What it belongs to.
    pub kind: BoundaryKind,
}

/// A boundary facet: one side of one cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Facet {
    /// The cell it bounds.
    pub cell: u32,
    /// Local side. In 2D side s joins local vertices s and (s + 1) % 3, its mid node is 3 + s.
    pub side: u8,
    /// Index into [`Mesh::boundaries`].
    pub boundary: u16,
}

/// A conforming mesh of triangles (D = 2) or tetrahedra (D = 3) with quadratic geometry.
///
/// Local numbering in 2D: vertices 0, 1, 2 counter-clockwise, then the mid nodes of the edges
/// (0,1), (1,2), (2,0); this is VTK's order for quadratic triangles (type 22).
/// Interior edges are straight: their mid node is the average of their ends.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh<const D: usize> {
    /// Positions of all P2 nodes (m): the vertices first, then one node per edge.
    pub nodes: Vec<Point<D>>,
    /// Number of vertices; the first `n_vertices` nodes are the vertices.
    pub n_vertices: usize,
    /// Node indices of all cells, [`nodes_per_cell`] for each.
    pub cells: Vec<u32>,
    /// Whether a cell has a curved side (needs its full isoparametric map); the rest is affine.
    pub curved: Vec<bool>,
    /// All boundary facets.
    pub facets: Vec<Facet>,
    /// The named boundaries the facets refer to.
    pub boundaries: Vec<Boundary>,
    /// Periodic pairs (copy, original) of P2 nodes: the copy's unknowns are the original's.
    pub periodic: Vec<(u32, u32)>,
}

impl<const D: usize> Mesh<D> {
    /// Number of cells.
    #[must_use]
    pub fn n_cells(&self) -> usize {
        self.curved.len()
    }

    /// Number of P2 nodes.
    #[must_use]
    pub fn n_nodes(&self) -> usize {
        self.nodes.len()
    }

    /// P2 nodes of one cell, [`nodes_per_cell`] of them.
    #[must_use]
    pub fn cell(&self, cell: usize) -> &[u32] {
        let n = nodes_per_cell(D);
        &self.cells[cell * n..(cell + 1) * n]
    }
}

impl Mesh<2> {
    /// Nodes of a facet: start, end, middle; the fluid is on the left from start to end.
    #[must_use]
    pub fn facet_nodes(&self, facet: &Facet) -> [u32; 3] {
        let (cell, side) = (self.cell(facet.cell as usize), facet.side as usize);
        [cell[side], cell[(side + 1) % 3], cell[3 + side]]
    }
}
