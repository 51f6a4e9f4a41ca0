//! `Mesh<D>`: positions of the P2 nodes, and the topology that meshes with the same cells share.

mod curved;
mod index;
mod pairs;
mod simplex;
mod straight;
mod topology;

pub(crate) use curved::determinant;
pub use curved::{CellMap, CellNodes, jacobian_coefficients, map_quadratic, shape_functions};
pub use index::{BoundaryId, CellId, FacetId, NodeId};
pub use pairs::{PairedMesh, SidePair, Unpaired, coordinates_of};
pub use simplex::{NodeArray, Simplex};
pub use topology::{Boundary, BoundaryKind, Edge, Facet, PeriodicPair, Topology};

use std::ops::Deref;
use std::sync::Arc;

use nalgebra::SVector;

/// A place in space (m), D components.
pub type Point<const D: usize> = SVector<f64, D>;

/// A conforming mesh of triangles (D = 2) or tetrahedra (D = 3) with quadratic geometry.
///
/// [`Simplex`](crate::Simplex) fixes the local numbering of nodes, edges and facets; cells are
/// positive (counter-clockwise in the plane). Interior edges are straight: their inner nodes lie on
/// the line between their ends.
///
/// A copy of a mesh, and one with other nodes, shares its topology.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh<const D: usize> {
    /// Positions of all nodes (m): the vertices first, then the inner nodes of the edges.
    pub nodes: Vec<Point<D>>,
    topology: Arc<Topology<D>>,
}

impl<const D: usize> Deref for Mesh<D> {
    type Target = Topology<D>;

    fn deref(&self) -> &Topology<D> {
        &self.topology
    }
}

impl<const D: usize> Mesh<D> {
    /// A mesh of these nodes (m) and cells.
    #[must_use]
    pub fn new(nodes: Vec<Point<D>>, topology: Topology<D>) -> Self {
        Self { nodes, topology: Arc::new(topology) }
    }

    /// The boundary of a name; `None` where there is none.
    #[must_use]
    pub fn boundary_named(&self, name: &str) -> Option<BoundaryId> {
        self.boundaries.iter().position(|boundary| boundary.name == name).map(BoundaryId::new)
    }

    /// The same cells with their nodes elsewhere (m), as many as here.
    #[must_use]
    pub fn with_nodes(&self, nodes: Vec<Point<D>>) -> Self {
        debug_assert_eq!(nodes.len(), self.n_nodes(), "nodes of a mesh");
        Self { nodes, topology: Arc::clone(&self.topology) }
    }

    /// Its topology, to be changed: it is no longer shared with other meshes then.
    pub fn topology_mut(&mut self) -> &mut Topology<D> {
        Arc::make_mut(&mut self.topology)
    }

    /// Number of nodes.
    #[must_use]
    pub fn n_nodes(&self) -> usize {
        self.nodes.len()
    }

    /// All nodes, in order.
    pub fn node_ids(&self) -> impl ExactSizeIterator<Item = NodeId> + Clone + use<D> {
        (0..self.n_nodes()).map(NodeId::new)
    }

    /// Centroid (m) of the vertices of one cell.
    #[must_use]
    pub fn cell_center(&self, cell: CellId) -> Point<D> {
        let sum: Point<D> = self.cell_vertices(cell).iter().map(|&node| self.nodes[node]).sum();
        sum / (D + 1) as f64
    }
}
