//! From tetrahedra to the mesh: vertices renumbered, one node per edge, on the exact surfaces along
//! the boundary.

use std::collections::HashMap;

use super::boundary_edges::{INNER, surface_of};
use super::improver::Improver;
use super::surface_set::SurfaceSet;
use super::tetrahedra::Face;
use crate::{BoundaryId, CellId, Facet, Mesh, NodeId, PeriodicPair, Simplex};

impl Improver<'_> {
    /// The mesh with quadratic geometry.
    pub fn quadratic(&self, is_curved: bool) -> Mesh<3> {
        let mut numbers = vec![NodeId::default(); self.mesh.points.len()];
        let mut nodes = Vec::new();
        for vertex in self.mesh.vertices() {
            numbers[vertex as usize] = NodeId::new(nodes.len());
            nodes.push(self.mesh.point(vertex));
        }
        let n_vertices = nodes.len();
        let n_cells = self.mesh.n_cells();
        let mut middles: HashMap<[u32; 2], NodeId> = HashMap::with_capacity(2 * n_cells);
        let mut cells = Vec::with_capacity(Simplex::<3>::N_NODES * n_cells);
        let mut curved = Vec::with_capacity(n_cells);
        let mut facets = Vec::new();
        for (index, cell) in self.mesh.cells().enumerate() {
            let vertices = self.mesh.cell(cell);
            cells.extend(vertices.map(|vertex| numbers[vertex as usize]));
            let mut has_curved = false;
            for ends in Simplex::<3>::EDGES {
                let [a, b] = ends.map(|local| vertices[local]);
                let on_curved = is_curved && self.has_curved(self.mesh.edge_surfaces(a, b));
                has_curved |= on_curved;
                cells.push(*middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                    nodes.push(if on_curved {
                        self.middle_node(a, b)
                    } else {
                        (self.mesh.point(a) + self.mesh.point(b)) * 0.5
                    });
                    NodeId::new(nodes.len() - 1)
                }));
            }
            curved.push(has_curved);
            facets.extend(self.facets_of(cell, CellId::new(index)));
        }
        let boundaries = self.geometry.boundaries.clone();
        let periodic = self.pairs(|a, b| {
            if a == b {
                Some(numbers[a as usize])
            } else {
                middles.get(&[a.min(b), a.max(b)]).copied()
            }
        });
        Mesh { nodes, n_vertices, cells, curved, facets, boundaries, periodic }
    }

    /// Periodic pairs of nodes by the number of the node between two vertices, or at one taken twice.
    fn pairs(&self, number: impl Fn(u32, u32) -> Option<NodeId>) -> Vec<PeriodicPair> {
        let mut pairs = Vec::new();
        let mut add = |a: u32, b: u32, surfaces: SurfaceSet| {
            let (to_a, to_b) = (self.original(a, surfaces), self.original(b, surfaces));
            if let (Some(copy), Some(original)) = (number(a, b), number(to_a, to_b))
                && copy != original
            {
                pairs.push(PeriodicPair { copy, original });
            }
        };
        for cell in self.mesh.cells() {
            for (opposite, tag) in self.mesh.tags(cell).into_iter().enumerate() {
                if tag != INNER && self.is_fixed(SurfaceSet::of(surface_of(tag))) {
                    let [a, b, c] = self.mesh.face_vertices(Face { cell, opposite });
                    for [a, b] in [[a, b], [b, c], [c, a]] {
                        add(a, a, self.mesh.surfaces(a));
                        add(a, b, self.mesh.edge_surfaces(a, b));
                    }
                }
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }

    /// The boundary facets of a cell, which has a new number.
    fn facets_of(&self, cell: u32, number: CellId) -> impl Iterator<Item = Facet> + '_ {
        let tags = self.mesh.tags(cell);
        (0_u8..4).filter_map(move |side| {
            let own = Simplex::<3>::facet_vertices(usize::from(side));
            let opposite = (0..4).find(|local| !own.contains(local))?;
            let tag = tags[opposite];
            (tag != INNER).then(|| Facet { cell: number, side, boundary: self.boundary_of(tag) })
        })
    }

    fn boundary_of(&self, tag: u16) -> BoundaryId {
        self.geometry.surfaces[usize::from(surface_of(tag))].boundary
    }
}
