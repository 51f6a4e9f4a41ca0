//! Meshes of given simplices, all their sides straight.

use std::collections::HashMap;

use crate::{Boundary, BoundaryId, CellId, Facet, Mesh, NodeId, Point, Simplex, Topology};

impl<const D: usize> Mesh<D> {
    /// The mesh of simplices between these vertices (m), its sides straight. `cells` has the D + 1
    /// vertices of each, `boundary_of` the boundary of an outer facet by its vertices, ascending.
    ///
    /// Edges get their inner nodes, and outer facets their place in the list, in the order of the cells.
    ///
    /// # Panics
    /// When a cell has not D + 1 of the vertices.
    #[must_use]
    pub fn straight(
        vertices: &[Point<D>],
        cells: &[impl AsRef<[usize]>],
        boundaries: Vec<Boundary>,
        boundary_of: impl Fn(&[usize]) -> BoundaryId,
    ) -> Self {
        let mut nodes = vertices.to_vec();
        let mut middles = HashMap::new();
        let mut cell_nodes = Vec::with_capacity(Simplex::<D>::N_NODES * cells.len());
        // How many cells share each facet
        let mut sharing: HashMap<Vec<usize>, usize> = HashMap::new();
        for cell in cells.iter().map(AsRef::as_ref) {
            assert_eq!(cell.len(), Simplex::<D>::N_VERTICES, "vertices of a simplex");
            cell_nodes.extend(cell.iter().map(|&vertex| NodeId::new(vertex)));
            for ends in Simplex::<D>::EDGES {
                let [a, b] = ends.map(|local| cell[local]);
                cell_nodes.push(*middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                    nodes.push((nodes[a] + nodes[b]) * 0.5);
                    NodeId::new(nodes.len() - 1)
                }));
            }
            (0..=D).for_each(|side| *sharing.entry(facet_of::<D>(cell, side)).or_default() += 1);
        }
        let mut facets = Vec::new();
        for (index, cell) in cells.iter().enumerate() {
            for side in 0..=D {
                let vertices = facet_of::<D>(cell.as_ref(), side);
                if sharing[&vertices] == 1 {
                    let side = u8::try_from(side).expect("a simplex has few facets");
                    let boundary = boundary_of(&vertices);
                    facets.push(Facet { cell: CellId::new(index), side, boundary });
                }
            }
        }
        let topology = Topology {
            n_vertices: vertices.len(),
            cells: cell_nodes,
            curved: vec![false; cells.len()],
            facets,
            boundaries,
            periodic: Vec::new(),
        };
        Self::new(nodes, topology)
    }
}

/// Vertices of a facet of a cell, ascending.
fn facet_of<const D: usize>(cell: &[usize], side: usize) -> Vec<usize> {
    let mut vertices = Simplex::<D>::facet_vertices(side).map(|local| cell[local]).to_vec();
    vertices.sort_unstable();
    vertices
}
