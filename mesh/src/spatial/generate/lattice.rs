//! The body-centred cubic lattice of tetrahedra that the mesh is cut from.

use super::improver::Improver;
use super::measure::six_volumes;
use super::surface_set::SurfaceSet;
use crate::Point;
use crate::number::whole;

/// Part of a cube by which the lattice reaches beyond the fluid.
const MARGIN: f64 = 0.6;

/// A block of cubes, of which only those tetrahedra are made that lie between two of their centres.
struct Block {
    min: Point<3>,
    edge: f64,
    n: [usize; 3],
}

impl Block {
    /// Number of a corner.
    fn corner(&self, [i, j, k]: [usize; 3]) -> usize {
        (i * (self.n[1] + 1) + j) * (self.n[2] + 1) + k
    }

    /// Number of a centre, which come after the corners.
    fn center(&self, [i, j, k]: [usize; 3]) -> usize {
        let n_corners = self.n.iter().map(|n| n + 1).product::<usize>();
        n_corners + (i * self.n[1] + j) * self.n[2] + k
    }

    fn point(&self, at: [usize; 3], offset: f64) -> Point<3> {
        self.min + Point::from(at.map(|i| i as f64 + offset)) * self.edge
    }
}

/// All places of a grid, the last index fastest.
fn grid(n: [usize; 3]) -> impl Iterator<Item = [usize; 3]> {
    (0..n[0]).flat_map(move |i| (0..n[1]).flat_map(move |j| (0..n[2]).map(move |k| [i, j, k])))
}

impl Improver<'_> {
    /// Fills the mesh with a lattice of cubes of an edge length (m) that holds the fluid, moved by a
    /// part of that length so that no plane of it is one of the domain.
    ///
    /// A tetrahedron has the centres of two neighbouring cubes and an edge of the face between them:
    /// all are equal, with dihedral angles of 60 and 90 degrees.
    pub fn fill_with_lattice(&mut self, edge: f64, shift: f64) {
        let [low, high] = self.geometry.corners;
        let min = low.add_scalar(-edge * (MARGIN + shift));
        let n: [usize; 3] = std::array::from_fn(|axis| {
            whole(((high[axis] + MARGIN * edge - min[axis]) / edge).ceil()) + 1
        });
        let block = Block { min, edge, n };
        for at in grid(n.map(|n| n + 1)) {
            self.add_vertex(block.point(at, 0.0), SurfaceSet::EMPTY);
        }
        for at in grid(n) {
            self.add_vertex(block.point(at, 0.5), SurfaceSet::EMPTY);
        }
        for at in grid(n) {
            for axis in 0..3 {
                let mut next = at;
                next[axis] += 1;
                if next[axis] < n[axis] {
                    self.add_between(&block, at, next, axis);
                }
            }
        }
    }

    /// The four tetrahedra between the centres of two cubes that are neighbours along an axis.
    fn add_between(&mut self, block: &Block, at: [usize; 3], next: [usize; 3], axis: usize) {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut ring = [next; 4];
        ring[1][u] += 1;
        ring[2][u] += 1;
        ring[2][v] += 1;
        ring[3][v] += 1;
        for i in 0..4 {
            let vertices = [
                block.center(at),
                block.center(next),
                block.corner(ring[i]),
                block.corner(ring[(i + 1) % 4]),
            ];
            let mut vertices = vertices.map(crate::number::index_u32);
            if six_volumes(&self.mesh.corners(vertices)) < 0.0 {
                vertices.swap(2, 3);
            }
            self.mesh.add_cell(vertices, [0; 4]);
        }
    }
}
