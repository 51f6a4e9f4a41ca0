//! Meshes of a few tetrahedra: the smallest that are not one cell.

use std::collections::BTreeMap;

use alewife_mesh::{
    Boundary, BoundaryId, BoundaryKind, CellId, Facet, Mesh, NodeId, Point, Simplex,
};

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
    let mut nodes: Vec<Point<3>> = VERTICES.iter().map(|at| Point::<3>::from(*at)).collect();
    let mut middles = BTreeMap::new();
    let mut cell_nodes = Vec::new();
    let mut facets: BTreeMap<[usize; 3], Vec<Facet>> = BTreeMap::new();
    for (index, cell) in cells.iter().enumerate() {
        cell_nodes.extend(cell.map(NodeId::new));
        for ends in Simplex::<3>::EDGES {
            let [a, b] = ends.map(|local| cell[local]);
            cell_nodes.push(*middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                nodes.push((nodes[a] + nodes[b]) / 2.0);
                NodeId::new(nodes.len() - 1)
            }));
        }
        for side in 0..4 {
            let local = Simplex::<3>::FACETS[usize::from(side)];
            let mut vertices = [0, 1, 2].map(|corner| cell[local[corner]]);
            vertices.sort_unstable();
            let boundary = BoundaryId::new(usize::from(vertices != ON_BODY));
            let facet = Facet { cell: CellId::new(index), side, boundary };
            facets.entry(vertices).or_default().push(facet);
        }
    }
    let body = Boundary { name: "body".to_owned(), kind: BoundaryKind::Body(0) };
    let outside = Boundary { name: "outside".to_owned(), kind: BoundaryKind::Side };
    Mesh {
        nodes,
        n_vertices: VERTICES.len(),
        cells: cell_nodes,
        curved: vec![false; cells.len()],
        facets: facets.into_values().filter(|sharing| sharing.len() == 1).flatten().collect(),
        boundaries: vec![body, outside],
        periodic: Vec::new(),
    }
}
