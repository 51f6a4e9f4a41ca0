//! The topology of a mesh as plain numbers, for states that are saved: positions of nodes and names of boundaries are
//! known from elsewhere.

use alewife_mesh::{BoundaryId, CellId, Facet, Mesh, NodeId, PeriodicPair, Simplex, Topology};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// The topology of a mesh.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct SavedMesh {
    /// Number of vertices, which are the first nodes.
    n_vertices: usize,
    cells: Vec<u32>,
    curved: Vec<bool>,
    /// Cell, side and boundary of each facet.
    facets: Vec<(u32, u8, u16)>,
    periodic: Vec<(u32, u32)>,
}

/// Writes the topology of a mesh.
///
/// # Errors
/// Those of the format.
pub(super) fn serialize<S: Serializer, const D: usize>(
    mesh: &Mesh<D>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let facet = |facet: &Facet| (facet.cell.into(), facet.side, facet.boundary.into());
    let saved = SavedMesh {
        n_vertices: mesh.n_vertices,
        cells: mesh.cells.iter().copied().map(u32::from).collect(),
        curved: mesh.curved.clone(),
        facets: mesh.facets.iter().map(facet).collect(),
        periodic: mesh.periodic.iter().map(|p| (p.copy.into(), p.original.into())).collect(),
    };
    saved.serialize(serializer)
}

/// Reads a mesh that has neither positions of nodes nor boundaries.
///
/// # Errors
/// Those of the format.
pub(super) fn deserialize<'de, De: Deserializer<'de>, const D: usize>(
    deserializer: De,
) -> Result<Mesh<D>, De::Error> {
    let saved = SavedMesh::deserialize(deserializer)?;
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
        n_vertices: saved.n_vertices,
        cells: saved.cells.iter().copied().map(NodeId::from).collect(),
        curved: saved.curved,
        facets: saved.facets.iter().map(facet).collect(),
        boundaries: Vec::new(),
        periodic: saved.periodic.iter().map(pair).collect(),
    };
    Ok(Mesh::new(Vec::new(), topology))
}

/// Whether a topology that was read fits to so many nodes and boundaries.
#[must_use]
pub fn is_consistent<const D: usize>(
    mesh: &Topology<D>,
    n_nodes: usize,
    n_boundaries: usize,
) -> bool {
    let n_cells = mesh.curved.len();
    let is_node = |node: NodeId| node.index() < n_nodes;
    mesh.n_vertices <= n_nodes
        && mesh.cells.len() == Simplex::<D>::N_NODES * n_cells
        && mesh.cells.iter().all(|node| is_node(*node))
        && mesh.periodic.iter().all(|pair| is_node(pair.copy) && is_node(pair.original))
        && mesh.facets.iter().all(|facet| {
            facet.cell.index() < n_cells
                && usize::from(facet.side) < Simplex::<D>::N_VERTICES
                && facet.boundary.index() < n_boundaries
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_points_beyond_the_mesh_is_not_consistent() {
        let node = NodeId::from;
        let facet = |cell: u32, side: u8, boundary: u16| Facet {
            cell: CellId::from(cell),
            side,
            boundary: BoundaryId::from(boundary),
        };
        let right = Topology::<2> {
            n_vertices: 3,
            cells: (0..6).map(node).collect(),
            curved: vec![false],
            facets: vec![facet(0, 2, 1)],
            boundaries: Vec::new(),
            periodic: vec![PeriodicPair { copy: node(1), original: node(0) }],
        };
        let is_consistent = |topology: &Topology<2>| is_consistent(topology, 6, 2);
        assert!(is_consistent(&right));
        let beyond = [0, 1, 2, 3, 4, 6].map(node).to_vec();
        for wrong in [
            Topology { facets: vec![facet(0, 3, 1)], ..right.clone() },
            Topology { facets: vec![facet(1, 2, 1)], ..right.clone() },
            Topology { facets: vec![facet(0, 2, 2)], ..right.clone() },
            Topology {
                periodic: vec![PeriodicPair { copy: node(6), original: node(0) }],
                ..right.clone()
            },
            Topology { cells: beyond, ..right.clone() },
            Topology { cells: (0..3).map(node).collect(), ..right.clone() },
            Topology { n_vertices: 7, ..right.clone() },
        ] {
            assert!(!is_consistent(&wrong), "{wrong:?}");
        }
    }
}
