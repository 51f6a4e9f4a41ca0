//! Numbering of the raw unknowns: velocity by node, pressure by vertex, velocities of bodies.

use std::ops::Range;

use alewife_mesh::{CellId, Mesh, NodeId};

/// Where each raw unknown sits in a vector: D velocities a P2 node, one pressure a vertex, then
/// the rigid velocities of each body in the motions its geometry has (x, y and the rotation in the plane),
/// then the rates of the coordinates of all bodies that have some.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DofLayout<const D: usize> {
    /// P2 nodes.
    pub n_nodes: usize,
    /// Vertices.
    pub n_vertices: usize,
    /// Bodies.
    pub n_bodies: usize,
    /// Rigid motions of one body.
    pub n_modes: usize,
    /// Coordinates of all bodies together.
    pub n_coordinates: usize,
}

impl<const D: usize> DofLayout<D> {
    /// The layout of a mesh with a number of bodies that have some rigid motions each.
    #[must_use]
    pub fn new(mesh: &Mesh<D>, n_bodies: usize, n_modes: usize) -> Self {
        let (n_nodes, n_vertices) = (mesh.n_nodes(), mesh.n_vertices);
        Self { n_nodes, n_vertices, n_bodies, n_modes, n_coordinates: 0 }
    }

    /// The same with so many coordinates of bodies.
    #[must_use]
    pub fn with_coordinates(self, n_coordinates: usize) -> Self {
        Self { n_coordinates, ..self }
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

    /// Nodes of the pressure in a cell: its vertices.
    #[inline(always)]
    #[must_use]
    pub fn pressure_nodes(mesh: &Mesh<D>, cell: CellId) -> &[NodeId] {
        mesh.cell_vertices(cell)
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

    /// Rigid velocity of a body by the position of a motion among those it has: translations first, then
    /// rotations.
    #[must_use]
    pub fn rigid(&self, body: usize, position: usize) -> usize {
        self.n_nodes * D + self.n_vertices + body * self.n_modes + position
    }

    /// Rate of a coordinate, numbered through all bodies.
    #[must_use]
    pub fn rate(&self, coordinate: usize) -> usize {
        self.n_fluid() + self.n_bodies * self.n_modes + coordinate
    }

    /// Number of velocities and pressures.
    #[must_use]
    pub fn n_fluid(&self) -> usize {
        self.n_nodes * D + self.n_vertices
    }

    /// Number of all raw unknowns.
    #[must_use]
    pub fn n_raw(&self) -> usize {
        self.rate(self.n_coordinates)
    }
}
