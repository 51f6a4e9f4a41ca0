//! A mesh of two triangles.

use alewife_mesh::{
    Boundary, BoundaryId, BoundaryKind, CellId, Facet, Mesh, NodeId, Point, Topology,
};

/// The unit square, split from its lower left to its upper right corner.
pub fn two_triangles() -> Mesh<2> {
    let nodes = [
        [0.0, 0.0],
        [1.0, 0.0],
        [1.0, 1.0],
        [0.0, 1.0],
        [0.5, 0.0],
        [1.0, 0.5],
        [0.5, 0.5],
        [0.5, 1.0],
        [0.0, 0.5],
    ];
    let topology = Topology {
        n_vertices: 4,
        cells: [0, 1, 2, 4, 5, 6, 0, 2, 3, 6, 7, 8].map(NodeId::new).to_vec(),
        curved: vec![false, false],
        facets: vec![Facet { cell: CellId::new(0), side: 0, boundary: BoundaryId::new(0) }],
        boundaries: vec![Boundary { name: "bottom".to_owned(), kind: BoundaryKind::Side }],
        periodic: Vec::new(),
    };
    Mesh::new(nodes.map(Point::<2>::from).to_vec(), topology)
}
