//! Numbering along a Hilbert curve: what is close in the plane is close in memory.

use crate::number::{index_u32, whole};
use crate::{CellId, Mesh, NodeId, PeriodicPair, Point};

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
    let mut order: Vec<(u64, CellId)> = mesh
        .cell_ids()
        .map(|cell| {
            let place = (mesh.cell_center(cell) - low) * scale;
            (along_curve(index_u32(whole(place[0])), index_u32(whole(place[1]))), cell)
        })
        .collect();
    order.sort_unstable();

    let mut new_cell = vec![CellId::default(); mesh.n_cells()];
    let unset = NodeId::from(u32::MAX);
    let mut new_node = vec![unset; mesh.n_nodes()];
    let (mut next_vertex, mut next_inner) = (0, mesh.n_vertices);
    for (index, &(_, cell)) in order.iter().enumerate() {
        new_cell[cell] = CellId::new(index);
        for &node in mesh.cell(cell) {
            let is_vertex = node.index() < mesh.n_vertices;
            let next = if is_vertex { &mut next_vertex } else { &mut next_inner };
            if new_node[node] == unset {
                new_node[node] = NodeId::new(*next);
                *next += 1;
            }
        }
    }

    let mut renumbered = mesh.clone();
    for (position, &new) in mesh.nodes.iter().zip(&new_node) {
        renumbered.nodes[new] = *position;
    }
    let topology = renumbered.topology_mut();
    topology.cells =
        order.iter().flat_map(|&(_, cell)| mesh.cell(cell)).map(|&old| new_node[old]).collect();
    topology.curved = order.iter().map(|&(_, cell)| mesh.curved[cell]).collect();
    for facet in &mut topology.facets {
        facet.cell = new_cell[facet.cell];
    }
    for pair in &mut topology.periodic {
        *pair = PeriodicPair { copy: new_node[pair.copy], original: new_node[pair.original] };
    }
    topology.periodic.sort_unstable();
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
        let spread = |cell: CellId| {
            let corners = mesh.cell_vertices(cell);
            let [first, last] = [corners.iter().min(), corners.iter().max()]
                .map(|vertex| vertex.expect("three corners").index());
            last - first
        };
        let near = mesh.cell_ids().filter(|&cell| spread(cell) < 200).count();
        assert!(near * 10 > mesh.n_cells() * 9, "{near} of {}", mesh.n_cells());
    }
}
