//! Meshes of a few tetrahedra: the smallest that are not one cell.

use alewife_mesh::{Boundary, BoundaryId, BoundaryKind, Mesh, Point};

/// Positions of the vertices of a double pyramid over the triangle 1, 2, 3 (m).
const VERTICES: [[f64; 3]; 5] =
    [[0.3, 0.5, 0.2], [1.4, 0.6, 0.1], [0.2, 1.5, 0.4], [0.4, 0.7, 1.3], [1.3, 1.4, 1.2]];

/// Vertices of the outer facet that lies on the body, ascending.
const ON_BODY: [usize; 3] = [0, 1, 2];

/// Two tetrahedra that share a facet. One outer facet lies on body 0, the others on the side `outside`.
#[must_use]
pub fn two_tetrahedra() -> Mesh<3> {
    mesh_of(&[[0, 1, 2, 3], [4, 2, 1, 3]])
}

/// Three tetrahedra around an edge, which fill the region of [`two_tetrahedra`].
#[must_use]
pub fn three_tetrahedra() -> Mesh<3> {
    mesh_of(&[[0, 1, 2, 4], [0, 2, 3, 4], [0, 3, 1, 4]])
}

fn mesh_of(cells: &[[usize; 4]]) -> Mesh<3> {
    let body = Boundary { name: "body".to_owned(), kind: BoundaryKind::Body(0) };
    let outside = Boundary { name: "outside".to_owned(), kind: BoundaryKind::Side };
    Mesh::straight(&VERTICES.map(Point::<3>::from), cells, vec![body, outside], |vertices| {
        BoundaryId::new(usize::from(vertices != ON_BODY))
    })
}
