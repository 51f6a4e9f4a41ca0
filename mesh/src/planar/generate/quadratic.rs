//! From triangles to the mesh: one node per edge, on the exact curve along the boundary.

use super::edges::EdgePair;
use super::opened::Opened;
use super::triangulation::{Triangulation, WALL};
use crate::mesh::jacobian_coefficients;
use crate::planar::boundary::BoundaryLoops;
use crate::{BoundaryId, CellId, Facet, Mesh, MeshError, NodeId, PeriodicPair, Simplex, Topology};

/// Mesh with quadratic geometry; `periodic` are the pairs of boundary edges.
///
/// # Errors
/// [`MeshError::FoldedCell`].
pub fn finish(
    triangles: Triangulation,
    border: &BoundaryLoops,
    periodic: &[EdgePair],
    is_curved: bool,
) -> Result<Mesh<2>, MeshError> {
    let opened = Opened::new(&triangles, border);
    let mut nodes = opened.points.clone();
    let n_vertices = nodes.len();
    let n_cells = triangles.triangles.len();
    let unset = NodeId::from(u32::MAX);
    let mut cells = with_inner_nodes(&opened.corners, unset);
    // Where an inner node of a side stands in `cells`
    let slot = |cell: usize, side: usize| {
        Simplex::<2>::N_NODES * cell + Simplex::<2>::edge_nodes(side).start
    };
    let mut curved = vec![false; n_cells];
    let no_facet = Facet { cell: CellId::default(), side: 0, boundary: BoundaryId::default() };
    let mut facets = vec![no_facet; triangles.edges.len()];
    let mut cut_open = opened.pairs();
    for cell in 0..n_cells {
        for side in 0..3 {
            if cells[slot(cell, side)] != unset {
                continue;
            }
            let [a, b] =
                Simplex::<2>::EDGES[side].map(|local| nodes[opened.corners[cell][local] as usize]);
            let mut middle = (a + b) * 0.5;
            let node = NodeId::new(nodes.len());
            cells[slot(cell, side)] = node;
            if let Some((other, other_side)) = triangles.behind((cell, side)) {
                let behind = &mut cells[slot(other, other_side)];
                match opened.side((cell, side), (other, other_side)) {
                    None => *behind = node,
                    Some(boundary) => {
                        facets.push(facet(cell, side, boundary));
                        let pair = PeriodicPair { copy: node, original: *behind };
                        cut_open.extend((*behind != unset).then_some(pair));
                    }
                }
            } else {
                let index = (triangles.across[cell][side] & !WALL) as usize;
                let edge = triangles.edges[index];
                let piece = edge.piece as usize;
                facets[index] = facet(cell, side, border.pieces[piece].boundary);
                if is_curved && !border.is_straight(piece) {
                    let [from, to] = edge.parameters;
                    middle = border.point(piece, border.cut(piece, from, to, 0.5));
                    curved[cell] = true;
                }
            }
            nodes.push(middle);
        }
    }
    let topology = Topology {
        n_vertices,
        cells,
        curved,
        facets,
        boundaries: border.boundaries.clone(),
        periodic: Vec::new(),
    };
    let mut mesh = Mesh::new(nodes, topology);
    cut_open.extend(pair_nodes(&mesh, &triangles, periodic));
    cut_open.sort_unstable();
    mesh.topology_mut().periodic = cut_open;
    check_curved(&mesh)?;
    Ok(mesh)
}

/// Nodes of all cells, the inner ones not set.
fn with_inner_nodes(corners: &[[u32; 3]], unset: NodeId) -> Vec<NodeId> {
    let mut cells = Vec::with_capacity(Simplex::<2>::N_NODES * corners.len());
    for corners in corners {
        cells.extend(corners.map(NodeId::from));
        cells.resize(cells.len() + Simplex::<2>::N_NODES - 3, unset);
    }
    cells
}

fn facet(cell: usize, side: usize, boundary: BoundaryId) -> Facet {
    let side = u8::try_from(side).expect("a triangle has three sides");
    Facet { cell: CellId::new(cell), side, boundary }
}

/// Whether no curved cell is folded.
fn check_curved(mesh: &Mesh<2>) -> Result<(), MeshError> {
    for cell in mesh.cell_ids().filter(|cell| mesh.curved[*cell]) {
        let nodes = mesh.cell_nodes(cell);
        let lowest = jacobian_coefficients(&nodes).into_iter().fold(f64::INFINITY, f64::min);
        if lowest <= 0.0 {
            let center = mesh.cell_center(cell);
            return Err(MeshError::FoldedCell {
                cell,
                det_jacobian: lowest,
                x: center.x,
                y: center.y,
            });
        }
    }
    Ok(())
}

/// Periodic pairs of nodes of straight sides, chains resolved, sorted by copy.
fn pair_nodes(
    mesh: &Mesh<2>,
    triangles: &Triangulation,
    periodic: &[EdgePair],
) -> Vec<PeriodicPair> {
    let mut original: Vec<NodeId> = mesh.node_ids().collect();
    let mut copies = Vec::new();
    let nodes = |edge: u32| {
        let edge = edge as usize;
        let ends = triangles.edges[edge].vertices.map(NodeId::from);
        (ends, mesh.facet_inner_nodes(&mesh.facets[edge]))
    };
    for pair in periodic {
        let (([a, b], to_inner), ([c, d], from_inner)) = (nodes(pair.copy), nodes(pair.original));
        // The copy is travelled backwards
        let inner = to_inner.zip(from_inner.rev());
        for (to, from) in std::iter::once((a, d)).chain(inner).chain([(b, c)]) {
            // A corner of a doubly periodic box is a copy twice
            if original[to] == to {
                original[to] = from;
                copies.push(to);
            }
        }
    }
    let root = |mut node: NodeId| {
        while original[node] != node {
            node = original[node];
        }
        node
    };
    copies.sort_unstable();
    copies.into_iter().map(|copy| PeriodicPair { copy, original: root(copy) }).collect()
}
