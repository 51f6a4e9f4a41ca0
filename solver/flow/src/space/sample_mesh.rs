//! Meshes of one or two cells for tests, in the plane and in space.

use alewife_mesh::{Boundary, BoundaryId, BoundaryKind, Mesh, Point};

/// A cell away from the origin, and above the axis.
pub(crate) fn one_simplex<const D: usize>() -> Mesh<D> {
    let cell: Vec<_> = (0..=D).collect();
    mesh_of(&vertices::<D>()[..=D], &[&cell])
}

/// Two cells that share a facet.
pub(crate) fn two_simplices<const D: usize>() -> Mesh<D> {
    let first: Vec<_> = (0..=D).collect();
    // The opposite vertex in place of the first, and two others exchanged to stay positive
    let mut second = first.clone();
    second[0] = D + 1;
    second.swap(1, 2);
    mesh_of(&vertices::<D>(), &[&first, &second])
}

/// The mesh with all nodes that are no vertices moved by up to `bend` (m) along each axis, and all cells
/// curved if that is not zero.
pub(crate) fn bent<const D: usize>(mut mesh: Mesh<D>, bend: f64) -> Mesh<D> {
    let n_vertices = mesh.n_vertices;
    for (index, node) in mesh.nodes.iter_mut().enumerate().skip(n_vertices) {
        *node += Point::from_fn(|axis, _| bend * (3.0 * index as f64 + 5.0 * axis as f64).sin());
    }
    mesh.topology_mut().curved.fill(bend != 0.0);
    mesh
}

/// D + 2 vertices: a simplex, and one behind the facet opposite to its first vertex.
fn vertices<const D: usize>() -> Vec<Point<D>> {
    let unit = |axis: usize| Point::<D>::from_fn(|i, _| if i == axis { 1.2 } else { 0.1 });
    let mut vertices = vec![Point::zeros()];
    vertices.extend((0..D).map(unit));
    vertices.push(Point::from_fn(|axis, _| 1.0 + 0.1 * axis as f64));
    let origin = Point::from_fn(|axis, _| 0.3 + 0.2 * axis as f64);
    vertices.iter().map(|vertex| vertex + origin).collect()
}

fn mesh_of<const D: usize>(vertices: &[Point<D>], cells: &[&[usize]]) -> Mesh<D> {
    let wall = Boundary { name: "wall".to_owned(), kind: BoundaryKind::Side };
    Mesh::straight(vertices, cells, vec![wall], |_| BoundaryId::new(0))
}
