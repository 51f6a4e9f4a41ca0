//! Numbering along a Hilbert curve: what is close in the plane is close in memory.

use crate::{Mesh, Point};

/// Bits of a coordinate along the curve.
const BITS: u32 = 16;

/// Numbers the cells along a Hilbert curve, and vertices and mid nodes as the cells meet them.
pub fn renumber(mesh: &Mesh<2>) -> Mesh<2> {
    let mut low = Point::<2>::repeat(f64::INFINITY);
    let mut high = Point::<2>::repeat(f64::NEG_INFINITY);
    for node in &mesh.nodes {
        low = low.inf(node);
        high = high.sup(node);
    }
    let scale = f64::from((1u32 << BITS) - 1) / (high - low).max();
    let mut order: Vec<(u64, u32)> = (0..mesh.n_cells())
        .map(|cell| {
            let nodes = mesh.cell_nodes(cell);
            let place = ((nodes[0] + nodes[1] + nodes[2]) / 3.0 - low) * scale;
            (along_curve(place[0] as u32, place[1] as u32), cell as u32)
        })
        .collect();
    order.sort_unstable();

    let mut new_cell = vec![0; mesh.n_cells()];
    let mut new_node = vec![u32::MAX; mesh.n_nodes()];
    let (mut next_vertex, mut next_middle) = (0, mesh.n_vertices as u32);
    for (index, &(_, cell)) in order.iter().enumerate() {
        new_cell[cell as usize] = index as u32;
        for (local, &node) in mesh.cell(cell as usize).iter().enumerate() {
            let next = if local < 3 { &mut next_vertex } else { &mut next_middle };
            if new_node[node as usize] == u32::MAX {
                new_node[node as usize] = *next;
                *next += 1;
            }
        }
    }

    let mut renumbered = mesh.clone();
    for (old, &new) in new_node.iter().enumerate() {
        renumbered.nodes[new as usize] = mesh.nodes[old];
    }
    for (cell, nodes) in order.iter().zip(renumbered.cells.chunks_exact_mut(6)) {
        for (node, &old) in nodes.iter_mut().zip(mesh.cell(cell.1 as usize)) {
            *node = new_node[old as usize];
        }
    }
    renumbered.curved = order.iter().map(|&(_, cell)| mesh.curved[cell as usize]).collect();
    for facet in &mut renumbered.facets {
        facet.cell = new_cell[facet.cell as usize];
    }
    for pair in &mut renumbered.periodic {
        *pair = (new_node[pair.0 as usize], new_node[pair.1 as usize]);
    }
    renumbered.periodic.sort_unstable();
    renumbered
}

/// Length along the Hilbert curve through a grid of 2^BITS by 2^BITS points.
fn along_curve(mut x: u32, mut y: u32) -> u64 {
    let mut length = 0;
    for bit in (0..BITS).rev() {
        let (right, upper) = (x >> bit & 1, y >> bit & 1);
        length = length << 2 | u64::from((3 * right) ^ upper);
        // Each quarter holds the curve again, turned.
        if upper == 0 {
            if right == 1 {
                (x, y) = (!x, !y);
            }
            (x, y) = (y, x);
        }
    }
    length
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Domain, Sizing, generate};

    #[test]
    fn the_curve_visits_each_point_of_a_square_after_a_neighbour() {
        let n = 16;
        let mut visited: Vec<_> = (0..n * n)
            .map(|index| (index % n, index / n))
            .map(|(x, y)| (along_curve(x, y), x, y))
            .collect();
        visited.sort_unstable();
        for (length, pair) in visited.windows(2).enumerate() {
            let ((here, x, y), (next, x1, y1)) = (pair[0], pair[1]);
            assert_eq!((here, next), (length as u64, length as u64 + 1));
            assert_eq!(x.abs_diff(x1) + y.abs_diff(y1), 1);
        }
    }

    #[test]
    fn the_nodes_of_neighbouring_cells_have_close_numbers() {
        let domain = Domain::Disc { center: Point::<2>::zeros(), radius: 1.0 };
        let mesh = generate(&domain, &[], &Sizing::graded(0.02, 0.2, 0.02)).expect("a mesh");
        assert_eq!(mesh, renumber(&mesh));
        let spread = |cell: usize| {
            let corners = &mesh.cell(cell)[..3];
            corners.iter().max().expect("three corners") - corners.iter().min().expect("three")
        };
        let near = (0..mesh.n_cells()).filter(|&cell| spread(cell) < 200).count();
        assert!(near * 10 > mesh.n_cells() * 9, "{near} of {}", mesh.n_cells());
    }
}
