//! Numbering of the raw unknowns: velocity by node, pressure by vertex, rigid motion by body.

use std::ops::Range;

use alewife_mesh::{Mesh, NodeId};

/// Where each raw unknown sits in a vector: D velocities a P2 node, one pressure a vertex, then
/// D (D + 1) / 2 rigid velocities a body (U_x, U_y, omega in 2D).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DofLayout<const D: usize> {
    /// P2 nodes.
    pub n_nodes: usize,
    /// Vertices.
    pub n_vertices: usize,
    /// Bodies.
    pub n_bodies: usize,
}

impl<const D: usize> DofLayout<D> {
    /// Rigid velocities of one body.
    pub const RIGID: usize = D * (D + 1) / 2;

    /// The layout of a mesh with a number of bodies.
    #[must_use]
    pub fn new(mesh: &Mesh<D>, n_bodies: usize) -> Self {
        Self { n_nodes: mesh.n_nodes(), n_vertices: mesh.n_vertices, n_bodies }
    }

    /// Velocity component `axis` at a node.
    #[must_use]
    pub fn velocity(&self, node: NodeId, axis: usize) -> usize {
        node.index() * D + axis
    }

    /// Pressure at a vertex.
    #[must_use]
    pub fn pressure(&self, vertex: NodeId) -> usize {
        self.n_nodes * D + vertex.index()
    }

    /// All pressures.
    #[must_use]
    pub fn pressures(&self) -> Range<usize> {
        self.n_nodes * D..self.n_fluid()
    }

    /// All nodes, in order.
    pub fn nodes(&self) -> impl ExactSizeIterator<Item = NodeId> + Clone + use<D> {
        (0..self.n_nodes).map(NodeId::new)
    }

    /// All vertices, in order.
    pub fn vertices(&self) -> impl ExactSizeIterator<Item = NodeId> + Clone + use<D> {
        (0..self.n_vertices).map(NodeId::new)
    }

    /// Rigid velocity `mode` of a body: translations first, then rotations.
    #[must_use]
    pub fn rigid(&self, body: usize, mode: usize) -> usize {
        self.n_nodes * D + self.n_vertices + body * Self::RIGID + mode
    }

    /// Number of velocities and pressures.
    #[must_use]
    pub fn n_fluid(&self) -> usize {
        self.n_nodes * D + self.n_vertices
    }

    /// Number of all raw unknowns.
    #[must_use]
    pub fn n_raw(&self) -> usize {
        self.n_fluid() + self.n_bodies * Self::RIGID
    }
}
