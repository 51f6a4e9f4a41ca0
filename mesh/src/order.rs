//! Numbering along a Hilbert curve: what is close in the plane or in space is close in memory.

use crate::number::{index_u32, whole};
use crate::{CellId, Mesh, NodeId, PeriodicPair, Point};

/// Bits of a coordinate along the curve; in space cells may be a millionth of the domain.
const fn bits(dimension: usize) -> u32 {
    if dimension == 2 { 16 } else { 32 }
}

/// Numbers the cells along a Hilbert curve, and vertices and mid nodes as the cells meet them.
pub fn renumber<const D: usize>(mesh: &Mesh<D>) -> Mesh<D> {
    let mut low = Point::<D>::repeat(f64::INFINITY);
    let mut high = Point::<D>::repeat(f64::NEG_INFINITY);
    for node in &mesh.nodes {
        low = low.inf(node);
        high = high.sup(node);
    }
    let scale = f64::from(u32::MAX >> (32 - bits(D))) / (high - low).max();
    let mut order: Vec<(u128, CellId)> = mesh
        .cell_ids()
        .map(|cell| {
            let place = (mesh.cell_center(cell) - low) * scale;
            let place: [u32; D] = std::array::from_fn(|axis| index_u32(whole(place[axis])));
            (along_curve(place), cell)
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
    renumbered.cells =
        order.iter().flat_map(|&(_, cell)| mesh.cell(cell)).map(|&old| new_node[old]).collect();
    renumbered.curved = order.iter().map(|&(_, cell)| mesh.curved[cell]).collect();
    for facet in &mut renumbered.facets {
        facet.cell = new_cell[facet.cell];
    }
    for pair in &mut renumbered.periodic {
        *pair = PeriodicPair { copy: new_node[pair.copy], original: new_node[pair.original] };
    }
    renumbered.periodic.sort_unstable();
    renumbered
}

/// Length along the Hilbert curve through a grid of points (@skilling2004).
fn along_curve<const D: usize>(mut place: [u32; D]) -> u128 {
    let bits = bits(D);
    // From the largest cubes to the smallest: each holds the curve again, turned or mirrored
    for bit in (1..bits).rev() {
        let below = (1 << bit) - 1;
        for axis in 0..D {
            if place[axis] >> bit & 1 == 1 {
                place[0] ^= below;
            } else {
                let exchanged = (place[0] ^ place[axis]) & below;
                place[0] ^= exchanged;
                place[axis] ^= exchanged;
            }
        }
    }
    // What is left is a Gray code
    for axis in 1..D {
        place[axis] ^= place[axis - 1];
    }
    let odd = (1..bits).filter(|bit| place[D - 1] >> bit & 1 == 1);
    let flipped = odd.fold(0, |flipped, bit| flipped ^ ((1 << bit) - 1));
    let digits = (0..bits).rev().flat_map(|bit| place.map(|axis| (axis ^ flipped) >> bit & 1));
    digits.fold(0, |length, digit| length << 1 | u128::from(digit))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Domain, Sizing, generate};

    fn check_curve<const D: usize>(bits: usize) {
        let mut visited: Vec<(u128, [u32; D])> = Vec::new();
        for index in 0..1u32 << (D * bits) {
            let place = std::array::from_fn(|axis| index >> (axis * bits) & ((1 << bits) - 1));
            visited.push((along_curve(place), place));
        }
        visited.sort_unstable();
        for (length, pair) in visited.windows(2).enumerate() {
            let ([(here, from), (next, to)], length) = ([pair[0], pair[1]], length as u128);
            assert_eq!((here, next), (length, length + 1));
            let steps = from.iter().zip(to).map(|(from, to)| from.abs_diff(to));
            assert_eq!(steps.sum::<u32>(), 1);
        }
    }

    #[test]
    fn the_curve_visits_each_point_of_a_square_and_of_a_cube_after_a_neighbour() {
        check_curve::<2>(4);
        check_curve::<3>(3);
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
