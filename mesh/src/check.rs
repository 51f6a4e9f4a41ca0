//! Mesh invariants: positive Jacobians, conforming cells, tagged boundary, no orphan node.

use std::collections::HashMap;

use crate::outline::cross;
use crate::{CellId, Mesh, MeshError, NodeId, jacobian_coefficients};

/// Whether a mesh is one: the first broken invariant is named.
///
/// - Every cell is positive everywhere; interior edges are straight.
/// - Two cells share an edge with both ends and the mid node, or the edge is on the boundary.
/// - Every boundary edge is a facet once; the boundary is closed; no cell has two facets.
/// - Every node is used, and periodic pairs hold a copy once, never as an original.
///
/// # Errors
/// [`MeshError::Invariant`].
pub fn check_mesh(mesh: &Mesh<2>) -> Result<(), MeshError> {
    let broken = |what, index| Err(MeshError::Invariant { what, index });
    let mut used = vec![false; mesh.n_nodes()];
    // Ends of an edge in order, to its mid node and the cell with its side
    let mut open: HashMap<[NodeId; 2], (NodeId, CellId, u8)> = HashMap::new();
    for cell in mesh.cell_ids() {
        let local = mesh.cell(cell);
        if local.iter().any(|node| node.index() >= mesh.n_nodes()) {
            return broken("a cell has a node that does not exist", cell.index());
        }
        if local[..3].iter().any(|node| node.index() >= mesh.n_vertices) {
            return broken("a corner of a cell is not a vertex", cell.index());
        }
        let nodes = mesh.cell_nodes(cell);
        let is_positive = if mesh.curved[cell] {
            jacobian_coefficients(&nodes).iter().all(|c| *c > 0.0)
        } else {
            cross(nodes[1] - nodes[0], nodes[2] - nodes[0]) > 0.0
        };
        if !is_positive {
            return broken("a cell has a Jacobian that is not positive", cell.index());
        }
        for node in local {
            used[*node] = true;
        }
        for side in 0..3 {
            let (a, b, middle) = (local[side], local[(side + 1) % 3], local[3 + side]);
            match open.remove(&[b, a]) {
                Some((other, ..)) if other != middle => {
                    return broken(
                        "two cells disagree about the mid node of their edge",
                        cell.index(),
                    );
                }
                Some(_) => {
                    let chord = (nodes[side] + nodes[(side + 1) % 3]) * 0.5;
                    let length = (nodes[side] - nodes[(side + 1) % 3]).norm();
                    if (nodes[3 + side] - chord).norm() > 1e-12 * length {
                        return broken("an interior edge is not straight", cell.index());
                    }
                }
                None => {
                    if open.insert([a, b], (middle, cell, side as u8)).is_some() {
                        return broken("an edge is used twice in the same direction", cell.index());
                    }
                }
            }
        }
    }
    if let Some(orphan) = used.iter().position(|u| !*u) {
        return broken("a node belongs to no cell", orphan);
    }
    check_facets(mesh, open)?;
    check_periodic(mesh)
}

fn check_facets(
    mesh: &Mesh<2>,
    mut open: HashMap<[NodeId; 2], (NodeId, CellId, u8)>,
) -> Result<(), MeshError> {
    let broken = |what, index| Err(MeshError::Invariant { what, index });
    let mut balance = vec![0_i32; mesh.n_vertices];
    let mut facets = vec![0_u8; mesh.n_cells()];
    for facet in &mesh.facets {
        let (cell, side) = (facet.cell, facet.side as usize);
        if facet.boundary.index() >= mesh.boundaries.len() {
            return broken("a facet has a boundary that does not exist", cell.index());
        }
        let local = mesh.cell(cell);
        let ends = [local[side], local[(side + 1) % 3]];
        if open.remove(&ends) != Some((local[3 + side], cell, side as u8)) {
            return broken("a facet is not on the boundary or is listed twice", cell.index());
        }
        balance[ends[0]] += 1;
        balance[ends[1]] -= 1;
        facets[cell] += 1;
    }
    if let Some((_, cell, _)) = open.into_values().min_by_key(|(_, cell, _)| *cell) {
        return broken("a boundary edge is no facet", cell.index());
    }
    if let Some(vertex) = balance.iter().position(|b| *b != 0) {
        return broken("the boundary is not closed", vertex);
    }
    match facets.iter().position(|n| *n > 1) {
        Some(cell) => broken("a cell has two boundary facets", cell),
        None => Ok(()),
    }
}

fn check_periodic(mesh: &Mesh<2>) -> Result<(), MeshError> {
    let broken = |what, index| Err(MeshError::Invariant { what, index });
    let mut is_copy = vec![false; mesh.n_nodes()];
    for pair in &mesh.periodic {
        if std::mem::replace(&mut is_copy[pair.copy], true) {
            return broken("a periodic copy is listed twice", pair.copy.index());
        }
    }
    match mesh.periodic.iter().find(|pair| is_copy[pair.original]) {
        Some(pair) => broken("a periodic original is a copy", pair.original.index()),
        None => Ok(()),
    }
}
