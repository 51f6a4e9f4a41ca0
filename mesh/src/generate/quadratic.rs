//! From triangles to the mesh: one node per edge, on the exact curve along the boundary.

use super::border::Border;
use super::triangulation::{Triangulation, WALL};
use crate::curved::jacobian_coefficients;
use crate::{Facet, Mesh, MeshError};

/// Mesh with quadratic geometry; `periodic` are the boundary edge pairs (copy, original).
///
/// # Errors
/// [`MeshError::FoldedCell`].
pub fn finish(
    triangles: Triangulation,
    border: &Border,
    periodic: &[(u32, u32)],
    is_curved: bool,
) -> Result<Mesh<2>, MeshError> {
    let n_vertices = triangles.points.len();
    let n_cells = triangles.triangles.len();
    let mut nodes = triangles.points.clone();
    let mut cells = Vec::with_capacity(6 * n_cells);
    for corners in &triangles.triangles {
        cells.extend_from_slice(corners);
        cells.extend_from_slice(&[u32::MAX; 3]);
    }
    let mut curved = vec![false; n_cells];
    let mut facets = vec![Facet { cell: 0, side: 0, boundary: 0 }; triangles.edges.len()];
    for cell in 0..n_cells {
        for side in 0..3 {
            if cells[6 * cell + 3 + side] != u32::MAX {
                continue;
            }
            let [a, b] = [0, 1]
                .map(|i| triangles.points[triangles.triangles[cell][(side + i) % 3] as usize]);
            let mut middle = (a + b) * 0.5;
            let node = nodes.len() as u32;
            cells[6 * cell + 3 + side] = node;
            if let Some((other, slot)) = triangles.behind((cell, side)) {
                cells[6 * other + 3 + slot] = node;
            } else {
                let index = (triangles.across[cell][side] & !WALL) as usize;
                let edge = triangles.edges[index];
                let piece = edge.piece as usize;
                facets[index] = Facet {
                    cell: cell as u32,
                    side: side as u8,
                    boundary: border.pieces[piece].boundary,
                };
                if is_curved && !border.is_straight(piece) {
                    let [from, to] = edge.parameters;
                    middle = border.point(piece, border.cut(piece, from, to, 0.5));
                    curved[cell] = true;
                }
            }
            nodes.push(middle);
        }
    }
    let mut mesh = Mesh {
        nodes,
        n_vertices,
        cells,
        curved,
        facets,
        boundaries: border.boundaries.clone(),
        periodic: Vec::new(),
    };
    mesh.periodic = pair_nodes(&mesh, &triangles, periodic);
    for cell in (0..n_cells).filter(|c| mesh.curved[*c]) {
        let nodes = mesh.cell_nodes(cell);
        let lowest = jacobian_coefficients(&nodes).into_iter().fold(f64::INFINITY, f64::min);
        if lowest <= 0.0 {
            let center = (nodes[0] + nodes[1] + nodes[2]) / 3.0;
            return Err(MeshError::FoldedCell {
                cell,
                det_jacobian: lowest,
                x: center.x,
                y: center.y,
            });
        }
    }
    Ok(mesh)
}

/// Periodic pairs of nodes, chains resolved, sorted by copy.
fn pair_nodes(
    mesh: &Mesh<2>,
    triangles: &Triangulation,
    periodic: &[(u32, u32)],
) -> Vec<(u32, u32)> {
    let mut original: Vec<u32> = (0..mesh.n_nodes() as u32).collect();
    let mut copies = Vec::new();
    let middle = |edge: u32| {
        let facet = mesh.facets[edge as usize];
        mesh.cell(facet.cell as usize)[3 + facet.side as usize]
    };
    for (copy, source) in periodic {
        let [a, b] = triangles.edges[*copy as usize].vertices;
        let [c, d] = triangles.edges[*source as usize].vertices;
        for (to, from) in [(a, d), (middle(*copy), middle(*source)), (b, c)] {
            // A corner of a doubly periodic box is a copy twice
            if original[to as usize] == to {
                original[to as usize] = from;
                copies.push(to);
            }
        }
    }
    let root = |mut node: u32| {
        while original[node as usize] != node {
            node = original[node as usize];
        }
        node
    };
    copies.sort_unstable();
    copies.into_iter().map(|copy| (copy, root(copy))).collect()
}
