//! From tetrahedra to the mesh: vertices renumbered, one node per edge, on the exact surfaces along
//! the boundary.

use std::collections::HashMap;

use super::improve::Improver;
use super::opened::{Opened, Steps};
use super::tetrahedra::Face;
use super::tetrahedra::boundary_edges::{INNER, surface_of};
use crate::{BoundaryId, CellId, Facet, Mesh, NodeId, PeriodicPair, Point, Simplex, Topology};

/// A node in an edge, where the edge is shown in one of its places.
struct EdgeNode {
    /// Whole periods to the first end.
    steps: Steps,
    is_on_boundary: bool,
    node: NodeId,
}

/// The mesh as it is being made.
struct Quadratic<'i, 'a> {
    improver: &'i Improver<'a>,
    opened: Opened,
    is_curved: bool,
    nodes: Vec<Point<3>>,
    /// The first node of each vertex; its other places follow.
    numbers: Vec<NodeId>,
    /// Nodes in edges, by the ends of the edges.
    middles: HashMap<[u32; 2], Vec<EdgeNode>>,
}

impl Improver<'_> {
    /// The mesh with quadratic geometry.
    pub fn quadratic(&self, is_curved: bool) -> Mesh<3> {
        let opened = Opened::new(self);
        let mut numbers = vec![NodeId::default(); self.mesh.points.len()];
        let mut nodes = Vec::new();
        for vertex in self.mesh.vertices() {
            numbers[vertex as usize] = NodeId::new(nodes.len());
            let here = self.mesh.point(vertex);
            let places = opened.places(vertex);
            nodes.extend(places.map(|steps| here + self.geometry.periods.shift(steps)));
        }
        let n_vertices = nodes.len();
        let n_cells = self.mesh.n_cells();
        let middles = HashMap::with_capacity(2 * n_cells);
        let mut mesh = Quadratic { improver: self, opened, is_curved, nodes, numbers, middles };
        let mut cells = Vec::with_capacity(Simplex::<3>::N_NODES * n_cells);
        let mut curved = Vec::with_capacity(n_cells);
        let mut facets = Vec::new();
        for (index, cell) in self.ordered_cells().into_iter().enumerate() {
            curved.push(mesh.add_cell(cell, &mut cells));
            facets.extend(mesh.facets_of(cell, CellId::new(index)));
        }
        let boundaries = self.geometry.boundaries.clone();
        let periodic = mesh.pairs();
        let topology = Topology { n_vertices, cells, curved, facets, boundaries, periodic };
        Mesh::new(mesh.nodes, topology)
    }

    /// The cells by their vertices, which follow the lattice: what is added up cell by cell is then close in memory.
    fn ordered_cells(&self) -> Vec<u32> {
        let mut cells: Vec<u32> = self.mesh.cells().collect();
        cells.sort_by_cached_key(|&cell| {
            let mut vertices = self.mesh.cell(cell);
            vertices.sort_unstable();
            vertices
        });
        cells
    }

    /// The boundary of a face: of its surface, or of the part of it that the face is nearest to.
    fn boundary_of(&self, face: Face, tag: u16) -> BoundaryId {
        let surface = &self.geometry.surfaces[usize::from(surface_of(tag))];
        surface.sheet().map_or(surface.boundary, |sheet| {
            let corners = self.mesh.corners(self.mesh.face_vertices(face));
            sheet.nearest(corners.iter().sum::<Point<3>>() / 3.0).side
        })
    }
}

impl Quadratic<'_, '_> {
    /// The node of a vertex as a cell shows it.
    fn number(&self, cell: u32, local: usize) -> NodeId {
        let vertex = self.improver.mesh.cell(cell)[local];
        let place = self.opened.place_in(cell, local, vertex);
        NodeId::new(self.numbers[vertex as usize].index() + place)
    }

    /// Adds the nodes of a cell; whether it is curved.
    fn add_cell(&mut self, cell: u32, cells: &mut Vec<NodeId>) -> bool {
        let improver = self.improver;
        cells.extend((0..4).map(|local| self.number(cell, local)));
        let (vertices, tags) = (improver.mesh.cell(cell), improver.mesh.tags(cell));
        let mut has_curved = false;
        for &[i, j] in Simplex::<3>::EDGES {
            let [i, j] = if vertices[i] < vertices[j] { [i, j] } else { [j, i] };
            let [a, b] = [vertices[i], vertices[j]];
            let on_curved =
                self.is_curved && improver.has_curved(improver.mesh.edge_surfaces(a, b));
            has_curved |= on_curved;
            let is_on_boundary = (0..4).any(|face| face != i && face != j && tags[face] != INNER);
            let steps = self.opened.steps(cell, i);
            let known = self.middles.entry([a, b]).or_default();
            if let Some(known) = known.iter_mut().find(|known| known.steps == steps) {
                known.is_on_boundary |= is_on_boundary;
                cells.push(known.node);
                continue;
            }
            let mut at = improver.mesh.middle([a, b]);
            if on_curved {
                at += improver.offset_of_node(a, b);
            }
            let node = NodeId::new(self.nodes.len());
            self.nodes.push(at + improver.geometry.periods.shift(steps));
            known.push(EdgeNode { steps, is_on_boundary, node });
            cells.push(node);
        }
        has_curved
    }

    /// Periodic pairs of nodes.
    fn pairs(&self) -> Vec<PeriodicPair> {
        let mut pairs = Vec::new();
        if !self.improver.geometry.periods.is_any() {
            return pairs;
        }
        for vertex in self.improver.mesh.vertices() {
            let original = self.numbers[vertex as usize];
            let copies = 1..self.opened.places(vertex).count();
            let copies = copies.map(|place| NodeId::new(original.index() + place));
            pairs.extend(copies.map(|copy| PeriodicPair { copy, original }));
        }
        for of_edge in self.middles.values().filter(|of_edge| of_edge.len() > 1) {
            // On the boundary, where values are given, if the edge is there
            let first = of_edge.iter().min_by_key(|known| (!known.is_on_boundary, known.node));
            let Some(original) = first.map(|known| known.node) else { continue };
            let copies = of_edge.iter().map(|known| known.node).filter(|node| *node != original);
            pairs.extend(copies.map(|copy| PeriodicPair { copy, original }));
        }
        pairs.sort_unstable();
        pairs
    }

    /// The boundary facets of a cell, which has a new number.
    fn facets_of(&self, cell: u32, number: CellId) -> impl Iterator<Item = Facet> + '_ {
        let improver = self.improver;
        let is_periodic = improver.geometry.periods.is_any();
        let tags = improver.mesh.tags(cell);
        (0_u8..4).filter_map(move |side| {
            let own = Simplex::<3>::facet_vertices(usize::from(side));
            let opposite = (0..4).find(|local| !own.contains(local))?;
            let boundary = match tags[opposite] {
                INNER if is_periodic => {
                    BoundaryId::new(self.opened.side(improver, Face { cell, opposite })?)
                }
                INNER => return None,
                tag => improver.boundary_of(Face { cell, opposite }, tag),
            };
            Some(Facet { cell: number, side, boundary })
        })
    }
}
