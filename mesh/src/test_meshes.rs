//! Meshes of a few tetrahedra, straight and curved, for the tests of this crate.

use crate::{Boundary, BoundaryId, BoundaryKind, Mesh, Point};

/// Corner k of the unit cube has the bits of k as its coordinates.
fn cube_corners() -> Vec<Point<3>> {
    let bit = |k: u8, axis: usize| f64::from(k >> axis & 1);
    (0..8).map(|k| Point::<3>::from_fn(|axis, _| bit(k, axis))).collect()
}

/// The unit cube in five tetrahedra: one in the middle, and one at every second corner.
pub fn cube_of_five() -> Mesh<3> {
    let cells = [[0, 3, 5, 6], [1, 0, 3, 5], [2, 0, 3, 6], [4, 0, 5, 6], [7, 3, 5, 6]];
    quadratic(&cube_corners(), &cells)
}

/// The unit cube in twelve tetrahedra that meet in its centre: each has one boundary facet.
pub fn cube_of_twelve() -> Mesh<3> {
    let mut vertices = cube_corners();
    vertices.push(Point::<3>::repeat(0.5));
    let mut cells = Vec::new();
    for axis in 0..3 {
        let (u, v) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
        for base in [0, 1 << axis] {
            cells.push([base, base | u, base | u | v, 8]);
            cells.push([base, base | u | v, base | v, 8]);
        }
    }
    quadratic(&vertices, &cells)
}

/// The cube of twelve with the inner nodes of its boundary edges moved away from its centre, by
/// this part of their distance from it.
pub fn bulged_cube(by: f64) -> Mesh<3> {
    let mut mesh = cube_of_twelve();
    let center = Point::<3>::repeat(0.5);
    let mut is_moved = vec![false; mesh.n_nodes()];
    for facet in &mesh.facets {
        for node in mesh.facet_inner_nodes(facet) {
            is_moved[node] = true;
        }
    }
    for (node, _) in mesh.nodes.iter_mut().zip(is_moved).filter(|(_, is_moved)| *is_moved) {
        *node += (*node - center) * by;
    }
    let n_cells = mesh.n_cells();
    mesh.topology_mut().curved = vec![true; n_cells];
    mesh
}

/// The straight mesh of tetrahedra with these vertices, made positive where they are not, its
/// boundary in one piece.
pub fn quadratic(vertices: &[Point<3>], tetrahedra: &[[usize; 4]]) -> Mesh<3> {
    let positive = |&[a, b, c, d]: &[usize; 4]| {
        let [u, v, w] = [b, c, d].map(|vertex| vertices[vertex] - vertices[a]);
        if u.cross(&v).dot(&w) < 0.0 { [b, a, c, d] } else { [a, b, c, d] }
    };
    let cells: Vec<_> = tetrahedra.iter().map(positive).collect();
    let boundary = Boundary { name: "all".into(), kind: BoundaryKind::Side };
    Mesh::straight(vertices, &cells, vec![boundary], |_| BoundaryId::new(0))
}
