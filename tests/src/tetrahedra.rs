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

/// A box of cubes in twelve tetrahedra each, which meet in its centre, with a body in its middle or none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoxOfTetrahedra {
    /// Cubes along each edge of the box, which reaches from -1 to 1 along each axis (m).
    pub cubes: usize,
    /// Whether the cubes nearer to the middle than a third are left out: their surface, with its corners
    /// drawn half the way in to a sphere, is body 0. Then `cubes` is a multiple of three.
    pub has_body: bool,
}

impl BoxOfTetrahedra {
    /// Distance of the sides of the body from its middle (m).
    pub const RADIUS: f64 = 1.0 / 3.0;

    /// The mesh. Its boundaries are the body if there is one, the side `right` at x = 1, and `walls`.
    #[must_use]
    pub fn mesh(self) -> Mesh<3> {
        let n = self.cubes;
        // In halves of the edge of a cube
        let at = |i: usize| i as f64 / n as f64 - 1.0;
        let is_body = |cube: &[usize; 3]| {
            self.has_body && cube.iter().all(|i| at(2 * i + 1).abs() < Self::RADIUS)
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
            let first = cube.map(|i| 2 * i);
            let center = number(first.map(|i| i + 1));
            for (axis, is_far) in (0..3).flat_map(|axis| [(axis, false), (axis, true)]) {
                let corner = |u: usize, v: usize| {
                    let mut corner = first;
                    corner[axis] += 2 * usize::from(is_far);
                    corner[(axis + 1) % 3] += 2 * u;
                    corner[(axis + 2) % 3] += 2 * v;
                    corner
                };
                let [a, b, c, d] =
                    [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(u, v)| number(corner(u, v)));
                // Seen from the centre, the two sides across an axis turn opposite ways
                let halves = if is_far { [[b, a, c], [c, a, d]] } else { [[a, b, c], [a, c, d]] };
                cells.extend(halves.map(|[a, b, c]| [a, b, c, center]));
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
        point * (outside + (1.0 - outside) * 0.5 * (1.0 + size / point.norm()))
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

/// Triples of numbers below n.
fn lattice(n: usize) -> impl Iterator<Item = [usize; 3]> {
    (0..n).flat_map(move |k| (0..n).flat_map(move |j| (0..n).map(move |i| [i, j, k])))
}
