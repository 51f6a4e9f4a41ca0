//! `Topology<D>`: cells, tagged boundary facets and periodic pairs of a mesh, wherever its nodes are.

use crate::{BoundaryId, CellId, FacetId, NodeId, Simplex};

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
    pub cell: CellId,
    /// Local facet of that cell, an index into [`Simplex::FACETS`].
    pub side: u8,
    /// The boundary it is part of.
    pub boundary: BoundaryId,
}

/// Two nodes of a periodic mesh: the unknowns of the copy are those of the original.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct PeriodicPair {
    /// The node that has no unknowns of its own.
    pub copy: NodeId,
    /// The node whose unknowns it shares; never itself a copy.
    pub original: NodeId,
}

/// An edge of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Edge<'a> {
    /// Vertices at its ends.
    pub ends: [NodeId; 2],
    /// Its inner nodes, at [`Simplex::EDGE_PARAMETERS`].
    pub inner: &'a [NodeId],
}

/// What remains of a mesh while its nodes move.
#[derive(Debug, Clone, PartialEq)]
pub struct Topology<const D: usize> {
    /// Number of vertices; the first `n_vertices` nodes are the vertices.
    pub n_vertices: usize,
    /// Nodes of all cells, [`Simplex::N_NODES`] for each.
    pub cells: Vec<NodeId>,
    /// Whether a cell has a curved side (needs its full isoparametric map); the rest is affine.
    pub curved: Vec<bool>,
    /// All boundary facets.
    pub facets: Vec<Facet>,
    /// The named boundaries the facets refer to.
    pub boundaries: Vec<Boundary>,
    /// Periodic pairs of nodes, sorted by copy.
    pub periodic: Vec<PeriodicPair>,
}

impl<const D: usize> Topology<D> {
    /// Number of cells.
    #[must_use]
    pub fn n_cells(&self) -> usize {
        self.curved.len()
    }

    /// All cells, in order.
    pub fn cell_ids(&self) -> impl ExactSizeIterator<Item = CellId> + Clone + use<D> {
        (0..self.n_cells()).map(CellId::new)
    }

    /// All vertices, in order.
    pub fn vertex_ids(&self) -> impl ExactSizeIterator<Item = NodeId> + Clone + use<D> {
        (0..self.n_vertices).map(NodeId::new)
    }

    /// All boundary facets, in order.
    pub fn facet_ids(&self) -> impl ExactSizeIterator<Item = FacetId> + Clone + use<D> {
        (0..self.facets.len()).map(FacetId::new)
    }

    /// Nodes of each cell in turn, [`Simplex::N_NODES`] of them.
    pub fn cells(&self) -> impl ExactSizeIterator<Item = &[NodeId]> + Clone {
        self.cells.chunks_exact(Simplex::<D>::N_NODES)
    }

    /// Nodes of one cell, [`Simplex::N_NODES`] of them.
    #[must_use]
    pub fn cell(&self, cell: CellId) -> &[NodeId] {
        let n = Simplex::<D>::N_NODES;
        &self.cells[cell.index() * n..(cell.index() + 1) * n]
    }

    /// Vertices of one cell, D + 1 of them.
    #[must_use]
    pub fn cell_vertices(&self, cell: CellId) -> &[NodeId] {
        &self.cell(cell)[..=D]
    }

    /// Edges of one cell, in the order of [`Simplex::EDGES`].
    pub fn cell_edges(&self, cell: CellId) -> impl ExactSizeIterator<Item = Edge<'_>> + Clone {
        let nodes = self.cell(cell);
        Simplex::<D>::EDGES.iter().enumerate().map(move |(edge, ends)| Edge {
            ends: ends.map(|vertex| nodes[vertex]),
            inner: &nodes[Simplex::<D>::edge_nodes(edge)],
        })
    }

    /// Vertices of a facet; in the plane the fluid is on the left from the first to the second.
    #[must_use]
    pub fn facet_vertices(&self, facet: &Facet) -> [NodeId; D] {
        let nodes = self.cell(facet.cell);
        Simplex::<D>::facet_vertices(usize::from(facet.side)).map(|local| nodes[local])
    }

    /// Nodes of a facet: its vertices, then its inner nodes.
    pub fn facet_nodes<'a>(
        &'a self,
        facet: &Facet,
    ) -> impl DoubleEndedIterator<Item = NodeId> + ExactSizeIterator + Clone + use<'a, D> {
        let nodes = self.cell(facet.cell);
        Simplex::<D>::FACETS[usize::from(facet.side)].iter().map(|&local| nodes[local])
    }

    /// Nodes of a facet that are no vertices.
    pub fn facet_inner_nodes<'a>(
        &'a self,
        facet: &Facet,
    ) -> impl DoubleEndedIterator<Item = NodeId> + ExactSizeIterator + Clone + use<'a, D> {
        let nodes = self.cell(facet.cell);
        Simplex::<D>::facet_inner_nodes(usize::from(facet.side)).iter().map(|&local| nodes[local])
    }
}
