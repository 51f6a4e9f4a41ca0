//! `Triangulation`: triangles with their neighbours.
//!
//! Side s of a triangle joins its corners s and s + 1 (counter-clockwise).

mod moves;

use super::edges::BoundaryEdge;
use crate::Point;
use crate::number::index_u32;
use crate::planar::torus::Torus;
use crate::planar::vector::cross;

/// Bit of a neighbour entry that marks a boundary edge; the other bits are its index.
pub const WALL: u32 = 1 << 31;

/// Corners of a triangle that was removed.
const REMOVED: [u32; 3] = [u32::MAX; 3];

/// A triangle and the local number of a corner or side.
pub type Corner = (usize, usize);

/// Triangles with neighbours.
#[derive(Debug, Clone)]
pub struct Triangulation {
    /// Places of the vertices (m).
    pub points: Vec<Point<2>>,
    /// Edge lengths wanted at the vertices (m), about where they are.
    pub sizes: Vec<f64>,
    /// Corners, counter-clockwise.
    pub triangles: Vec<[u32; 3]>,
    /// Triangle behind each side, or [`WALL`] with the index of a boundary edge.
    pub across: Vec<[u32; 3]>,
    /// Edges of the boundary.
    pub edges: Vec<BoundaryEdge>,
    /// Where it closes on itself.
    pub torus: Torus,
    /// A triangle at each vertex.
    incident: Vec<u32>,
    /// Whether a vertex lies on the boundary.
    fixed: Vec<bool>,
}

/// Mean ratio of a triangle: 1 equilateral, 0 flat, negative inverted.
///
/// 4 √3 area / (sum of squared edges)
///
/// # Source
/// @liu1994, shape measures of simplices.
pub fn mean_ratio(a: Point<2>, b: Point<2>, c: Point<2>) -> f64 {
    let (u, v, w) = (b - a, c - b, a - c);
    let squares = u.norm_squared() + v.norm_squared() + w.norm_squared();
    2.0 * 3.0_f64.sqrt() * cross(u, -w) / squares
}

impl Triangulation {
    /// From corners and neighbours of all triangles.
    pub fn new(
        points: Vec<Point<2>>,
        sizes: Vec<f64>,
        triangles: Vec<[u32; 3]>,
        across: Vec<[u32; 3]>,
        edges: Vec<BoundaryEdge>,
        torus: Torus,
    ) -> Self {
        let mut incident = vec![0; points.len()];
        for (t, corners) in triangles.iter().enumerate() {
            for v in corners {
                incident[*v as usize] = index_u32(t);
            }
        }
        let mut fixed = vec![false; points.len()];
        for edge in &edges {
            for v in edge.vertices {
                fixed[v as usize] = true;
            }
        }
        Self { points, sizes, triangles, across, edges, torus, incident, fixed }
    }

    /// Whether a triangle is still there.
    pub fn is_alive(&self, triangle: usize) -> bool {
        self.triangles[triangle] != REMOVED
    }

    /// Whether a vertex lies on the boundary.
    pub fn is_fixed(&self, vertex: u32) -> bool {
        self.fixed[vertex as usize]
    }

    /// Places of the corners, the first one's own and those of the others beside it.
    pub fn corners(&self, triangle: usize) -> [Point<2>; 3] {
        self.corners_from((triangle, 0))
    }

    /// Places of the corners from one on, its own and those of the others beside it.
    pub fn corners_from(&self, (triangle, first): Corner) -> [Point<2>; 3] {
        let [a, b, c] = [0, 1, 2].map(|i| self.triangles[triangle][(first + i) % 3]);
        let from = self.points[a as usize];
        [from, self.beside(b, from), self.beside(c, from)]
    }

    /// Place of a vertex beside another place.
    #[inline]
    pub fn beside(&self, vertex: u32, other: Point<2>) -> Point<2> {
        self.torus.beside(self.points[vertex as usize], other)
    }

    /// Mean ratio of a triangle.
    pub fn quality(&self, triangle: usize) -> f64 {
        let [a, b, c] = self.corners(triangle);
        mean_ratio(a, b, c)
    }

    /// Number of boundary edges of a triangle.
    pub fn n_walls(&self, triangle: usize) -> usize {
        self.across[triangle].iter().filter(|n| **n & WALL != 0).count()
    }

    /// The same side seen from the triangle behind it, if there is one.
    pub fn behind(&self, (triangle, side): Corner) -> Option<Corner> {
        let other = self.across[triangle][side];
        (other & WALL == 0).then(|| (other as usize, self.slot(other as usize, triangle)))
    }

    fn slot(&self, triangle: usize, neighbour: usize) -> usize {
        let slot = self.across[triangle].iter().position(|n| *n as usize == neighbour);
        slot.expect("neighbours know each other")
    }

    fn local(&self, triangle: usize, vertex: u32) -> usize {
        let local = self.triangles[triangle].iter().position(|v| *v == vertex);
        local.expect("the triangle has the vertex")
    }

    /// Triangles around a vertex with its local number there, counter-clockwise; from boundary to
    /// boundary when the vertex lies on it.
    pub fn star(&self, vertex: u32, star: &mut Vec<Corner>) {
        star.clear();
        let start = self.incident[vertex as usize] as usize;
        let mut at = (start, self.local(start, vertex));
        if self.is_fixed(vertex) {
            while let Some((before, side)) = self.behind(at) {
                at = (before, (side + 1) % 3);
            }
        }
        let first = at.0;
        loop {
            star.push(at);
            let Some((next, side)) = self.behind((at.0, (at.1 + 2) % 3)) else { break };
            if next == first {
                break;
            }
            at = (next, side);
        }
    }

    fn repoint(&mut self, neighbour: u32, from: usize, to: usize) {
        if neighbour & WALL == 0 {
            let slot = self.slot(neighbour as usize, from);
            self.across[neighbour as usize][slot] = index_u32(to);
        }
    }

    /// Whether a vertex still has triangles.
    pub fn is_used(&self, vertex: u32) -> bool {
        self.incident[vertex as usize] != u32::MAX
    }

    /// Drops removed triangles and unused vertices, keeping the order of the rest.
    pub fn compact(&mut self) {
        let mut vertex = vec![u32::MAX; self.points.len()];
        let mut n = 0;
        for (v, new) in vertex.iter_mut().enumerate() {
            if self.incident[v] != u32::MAX {
                *new = index_u32(n);
                self.points[n] = self.points[v];
                self.sizes[n] = self.sizes[v];
                self.fixed[n] = self.fixed[v];
                n += 1;
            }
        }
        self.points.truncate(n);
        self.sizes.truncate(n);
        self.fixed.truncate(n);
        let mut triangle = vec![u32::MAX; self.triangles.len()];
        let mut n = 0;
        for (t, new) in triangle.iter_mut().enumerate() {
            if self.is_alive(t) {
                *new = index_u32(n);
                self.triangles[n] = self.triangles[t].map(|v| vertex[v as usize]);
                self.across[n] = self.across[t];
                n += 1;
            }
        }
        self.triangles.truncate(n);
        self.across.truncate(n);
        for neighbour in self.across.iter_mut().flatten() {
            if *neighbour & WALL == 0 {
                *neighbour = triangle[*neighbour as usize];
            }
        }
        for edge in &mut self.edges {
            edge.vertices = edge.vertices.map(|v| vertex[v as usize]);
        }
        self.incident = vec![0; self.points.len()];
        for (t, corners) in self.triangles.iter().enumerate() {
            for v in corners {
                self.incident[*v as usize] = index_u32(t);
            }
        }
    }
}
