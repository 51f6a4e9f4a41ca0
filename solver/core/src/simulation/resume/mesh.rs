//! `SavedMesh`: the topology of a mesh as plain numbers.

use alewife_mesh::{
    Boundary, BoundaryId, CellId, Facet, Mesh, NodeId, PeriodicPair, Point, Simplex, Topology,
};
use serde::{Deserialize, Serialize};

/// The topology of a mesh.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct SavedMesh {
    /// Number of vertices, which are the first nodes.
    pub n_vertices: usize,
    cells: Vec<u32>,
    curved: Vec<bool>,
    /// Cell, side and boundary of each facet.
    facets: Vec<(u32, u8, u16)>,
    periodic: Vec<(u32, u32)>,
}

impl SavedMesh {
    pub(super) fn of<const D: usize>(mesh: &Mesh<D>) -> Self {
        let facet = |facet: &Facet| (facet.cell.into(), facet.side, facet.boundary.into());
        Self {
            n_vertices: mesh.n_vertices,
            cells: mesh.cells.iter().copied().map(u32::from).collect(),
            curved: mesh.curved.clone(),
            facets: mesh.facets.iter().map(facet).collect(),
            periodic: mesh.periodic.iter().map(|p| (p.copy.into(), p.original.into())).collect(),
        }
    }

    pub(super) fn is_consistent<const D: usize>(
        &self,
        n_nodes: usize,
        n_boundaries: usize,
    ) -> bool {
        let n_cells = self.curved.len();
        let is_node = |node: u32| (node as usize) < n_nodes;
        self.n_vertices <= n_nodes
            && self.cells.len() == Simplex::<D>::N_NODES * n_cells
            && self.cells.iter().all(|node| is_node(*node))
            && self.periodic.iter().all(|(copy, original)| is_node(*copy) && is_node(*original))
            && self.facets.iter().all(|&(cell, side, boundary)| {
                (cell as usize) < n_cells
                    && usize::from(side) < Simplex::<D>::N_VERTICES
                    && usize::from(boundary) < n_boundaries
            })
    }

    pub(super) fn with_nodes<const D: usize>(
        &self,
        nodes: Vec<Point<D>>,
        boundaries: &[Boundary],
    ) -> Mesh<D> {
        let facet = |&(cell, side, boundary): &(u32, u8, u16)| Facet {
            cell: CellId::from(cell),
            side,
            boundary: BoundaryId::from(boundary),
        };
        let pair = |&(copy, original): &(u32, u32)| PeriodicPair {
            copy: NodeId::from(copy),
            original: NodeId::from(original),
        };
        let topology = Topology {
            n_vertices: self.n_vertices,
            cells: self.cells.iter().copied().map(NodeId::from).collect(),
            curved: self.curved.clone(),
            facets: self.facets.iter().map(facet).collect(),
            boundaries: boundaries.to_vec(),
            periodic: self.periodic.iter().map(pair).collect(),
        };
        Mesh::new(nodes, topology)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_points_beyond_the_mesh_is_not_consistent() {
        let right = SavedMesh {
            n_vertices: 3,
            cells: vec![0, 1, 2, 3, 4, 5],
            curved: vec![false],
            facets: vec![(0, 2, 1)],
            periodic: vec![(1, 0)],
        };
        let is_consistent = |mesh: &SavedMesh| mesh.is_consistent::<2>(6, 2);
        assert!(is_consistent(&right));
        for wrong in [
            SavedMesh { facets: vec![(0, 3, 1)], ..right.clone() },
            SavedMesh { facets: vec![(1, 2, 1)], ..right.clone() },
            SavedMesh { facets: vec![(0, 2, 2)], ..right.clone() },
            SavedMesh { periodic: vec![(6, 0)], ..right.clone() },
            SavedMesh { cells: vec![0, 1, 2, 3, 4, 6], ..right.clone() },
            SavedMesh { cells: vec![0, 1, 2], ..right.clone() },
            SavedMesh { n_vertices: 7, ..right.clone() },
        ] {
            assert!(!is_consistent(&wrong), "{wrong:?}");
        }
    }
}
