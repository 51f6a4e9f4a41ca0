//! Meshes of tetrahedra: the smallest that are not one cell, and boxes of any number.

use std::collections::HashMap;

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

/// A box of cubes in six tetrahedra each, with a body in its middle or none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoxOfTetrahedra {
    /// Cubes along each edge of the box, which reaches from -1 to 1 along each axis (m).
    pub cubes: usize,
    /// Whether the cubes nearer to the middle than a third are left out: the vertices around them are
    /// drawn in until their surface is nearly a sphere, body 0. Then `cubes` is a multiple of three.
    pub has_body: bool,
}

impl BoxOfTetrahedra {
    /// Radius of the body (m).
    pub const RADIUS: f64 = 1.0 / 3.0;

    /// The mesh. Its boundaries are the body if there is one, the side `right` at x = 1, and `walls`.
    #[must_use]
    pub fn mesh(self) -> Mesh<3> {
        let n = self.cubes;
        let at = |i: usize| 2.0 * i as f64 / n as f64 - 1.0;
        let is_body = |cube: &[usize; 3]| {
            let middle = |&i: &usize| (at(i) + 1.0 / n as f64).abs();
            self.has_body && cube.iter().all(|i| middle(i) < Self::RADIUS)
        };
        let (mut vertices, mut number_of) = (Vec::new(), HashMap::new());
        let mut number = |corner: [usize; 3]| {
            *number_of.entry(corner).or_insert_with(|| {
                vertices.push(self.drawn_in(Point::<3>::from(corner.map(at))));
                vertices.len() - 1
            })
        };
        let mut cells = Vec::new();
        for cube in lattice(n).filter(|cube| !is_body(cube)) {
            // From one corner to the opposite one along the axes, in each order
            for (order, is_odd) in ORDERS {
                let mut corner = cube;
                let mut cell = [number(corner); 4];
                for (step, axis) in order.into_iter().enumerate() {
                    corner[axis] += 1;
                    cell[step + 1] = number(corner);
                }
                if is_odd {
                    cell.swap(0, 1);
                }
                cells.push(cell);
            }
        }
        self.bounded(&vertices, &cells)
    }

    fn drawn_in(self, point: Point<3>) -> Point<3> {
        let size = point.amax();
        if !self.has_body || size == 0.0 {
            return point;
        }
        let outside = (size - Self::RADIUS) / (1.0 - Self::RADIUS);
        point * (outside + (1.0 - outside) * size / point.norm())
    }

    fn bounded(self, vertices: &[Point<3>], cells: &[[usize; 4]]) -> Mesh<3> {
        let boundary = |name: &str, kind| Boundary { name: name.to_owned(), kind };
        let body = self.has_body.then(|| boundary("body", BoundaryKind::Body(0)));
        let sides = ["right", "walls"].map(|name| boundary(name, BoundaryKind::Side));
        let boundaries: Vec<_> = body.into_iter().chain(sides).collect();
        let n_bodies = boundaries.len() - 2;
        Mesh::straight(vertices, cells, boundaries, |facet| {
            let all = |test: fn(&Point<3>) -> bool| facet.iter().all(|&v| test(&vertices[v]));
            BoundaryId::new(if all(|x| x.amax() < 0.5) {
                0
            } else if all(|x| x[0] > 1.0 - 1e-9) {
                n_bodies
            } else {
                n_bodies + 1
            })
        })
    }
}

/// Orders of the axes, and whether they are odd permutations.
const ORDERS: [([usize; 3], bool); 6] = [
    ([0, 1, 2], false),
    ([1, 2, 0], false),
    ([2, 0, 1], false),
    ([0, 2, 1], true),
    ([2, 1, 0], true),
    ([1, 0, 2], true),
];

/// Triples of numbers below n.
fn lattice(n: usize) -> impl Iterator<Item = [usize; 3]> {
    (0..n).flat_map(move |k| (0..n).flat_map(move |j| (0..n).map(move |i| [i, j, k])))
}
