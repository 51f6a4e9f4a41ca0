//! The body-centred cubic lattice of tetrahedra that the mesh is cut from.

use super::improve::Improver;
use super::tetrahedra::Face;
use super::tetrahedra::boundary_edges::{INNER, tag_of};
use super::tetrahedra::measure::six_volumes;
use super::tetrahedra::surface_set::SurfaceSet;
use crate::Point;
use crate::number::whole;

/// Part of a cube by which the lattice reaches beyond the fluid.
const MARGIN: f64 = 0.6;

/// Fewest cubes along an edge of a box.
const FEWEST_CUBES: usize = 2;

/// The same along a period: no cell is next to its own image, and edges are much shorter than half of it.
const FEWEST_IN_PERIOD: usize = 4;

/// Edge lengths that are tried for the cubes of a box.
const EDGES_TRIED: u32 = 24;

/// The part by which they are shorter than wanted at most.
const MOST_SHORTER: f64 = 0.55;

/// What shorter cubes count against those that are stretched.
const SHORTER: f64 = 0.2;

/// A block of cubes, of which only those tetrahedra are made that lie between two of their centres.
struct Block {
    min: Point<3>,
    /// Edges of a cube, of nearly the same length (m).
    edges: Point<3>,
    n: [usize; 3],
    /// Whether the last cubes along each axis are followed by the first ones.
    is_closed: [bool; 3],
}

impl Block {
    /// Numbers of corners along the axes.
    fn n_corners(&self) -> [usize; 3] {
        std::array::from_fn(|axis| self.n[axis] + usize::from(!self.is_closed[axis]))
    }

    /// Number of a corner.
    fn corner(&self, at: [usize; 3]) -> usize {
        let n = self.n_corners();
        let [i, j, k] = std::array::from_fn(|axis| at[axis] % n[axis]);
        (i * n[1] + j) * n[2] + k
    }

    /// Number of a centre, which come after the corners.
    fn center(&self, at: [usize; 3]) -> usize {
        let n_corners = self.n_corners().into_iter().product::<usize>();
        let [i, j, k] = std::array::from_fn(|axis| at[axis] % self.n[axis]);
        n_corners + (i * self.n[1] + j) * self.n[2] + k
    }

    fn point(&self, at: [usize; 3], offset: f64) -> Point<3> {
        self.min + Point::from(at.map(|i| i as f64 + offset)).component_mul(&self.edges)
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
        let block = Block { min, edges: Point::repeat(edge), n, is_closed: [false; 3] };
        for at in grid(n.map(|n| n + 1)) {
            self.add_vertex(block.point(at, 0.0), SurfaceSet::EMPTY);
        }
        self.fill(&block);
    }

    /// Fills a box with a lattice of cubes of about an edge length (m). Sides are faces of cubes; along
    /// periods the lattice is moved by a part of them, and continues.
    pub fn fill_box_with_lattice(&mut self, edge: f64, shift: f64) {
        let [min, max] = self.geometry.corners;
        let size = max - min;
        let is_closed = std::array::from_fn(|axis| self.geometry.periods.along(axis) > 0.0);
        let edge = common_edge(&size, edge, is_closed);
        let n = std::array::from_fn(|axis| n_cubes(size[axis], edge, is_closed[axis]));
        let edges = Point::<3>::from_fn(|axis, _| size[axis] / n[axis] as f64);
        let min = Point::<3>::from_fn(|axis, _| {
            min[axis] + if is_closed[axis] { shift * edges[axis] } else { 0.0 }
        });
        let block = Block { min, edges, n, is_closed };
        for at in grid(block.n_corners()) {
            let mut surfaces = SurfaceSet::EMPTY;
            for axis in (0..3).filter(|axis| !is_closed[*axis]) {
                for is_max in [false, true] {
                    if at[axis] == if is_max { n[axis] } else { 0 } {
                        surfaces = surfaces.with(side(axis, is_max)).unwrap_or(surfaces);
                    }
                }
            }
            self.add_vertex(block.point(at, 0.0), surfaces);
        }
        self.fill(&block);
        for axis in (0..3).filter(|axis| !is_closed[*axis]) {
            for at in grid(n).filter(|at| at[axis] == 0) {
                let mut opposite = at;
                opposite[axis] = n[axis] - 1;
                self.close(&block, at, axis, false);
                self.close(&block, opposite, axis, true);
            }
        }
    }

    /// Adds the centres of the cubes, whose corners are there, and the cells between them.
    fn fill(&mut self, block: &Block) {
        let n = block.n;
        for at in grid(n) {
            self.add_vertex(block.point(at, 0.5), SurfaceSet::EMPTY);
        }
        for at in grid(n) {
            for axis in 0..3 {
                let mut next = at;
                next[axis] += 1;
                if next[axis] < n[axis] || block.is_closed[axis] {
                    let ends = [block.center(at), block.center(next)];
                    self.add_between(block, ends, next, axis);
                }
            }
        }
    }

    /// Adds the middle of a face of a cube on a side of the box and the four tetrahedra between it and
    /// the centre of the cube.
    fn close(&mut self, block: &Block, at: [usize; 3], axis: usize, is_max: bool) {
        let surface = side(axis, is_max);
        let mut face = at;
        face[axis] += usize::from(is_max);
        let mut place = block.point(at, 0.5);
        place[axis] = block.point(face, 0.0)[axis];
        let middle = self.add_vertex(place, SurfaceSet::of(surface));
        let center = block.center(at);
        let cells = self.add_between(block, [center, middle as usize], face, axis);
        for cell in cells {
            let vertices = self.mesh.cell(cell);
            let opposite = vertices.iter().position(|vertex| *vertex as usize == center);
            if let Some(opposite) = opposite {
                self.mesh.set_tag(Face { cell, opposite }, tag_of(surface));
            }
        }
    }

    /// The four tetrahedra between the centres of two cubes that are neighbours along an axis, or between
    /// that of one and the middle of a face; `next` is the first corner of the face between them.
    fn add_between(
        &mut self,
        block: &Block,
        ends: [usize; 2],
        next: [usize; 3],
        axis: usize,
    ) -> [u32; 4] {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut ring = [next; 4];
        ring[1][u] += 1;
        ring[2][u] += 1;
        ring[2][v] += 1;
        ring[3][v] += 1;
        std::array::from_fn(|i| {
            let vertices =
                [ends[0], ends[1], block.corner(ring[i]), block.corner(ring[(i + 1) % 4])];
            let mut vertices = vertices.map(crate::number::index_u32);
            if six_volumes(&self.mesh.corners(vertices)) < 0.0 {
                vertices.swap(2, 3);
            }
            self.mesh.add_cell(vertices, [INNER; 4])
        })
    }
}

/// Number of a side of the box.
fn side(axis: usize, is_max: bool) -> u16 {
    [[0, 1], [2, 3], [4, 5]][axis][usize::from(is_max)]
}

/// Number of cubes of about an edge length (m) along one of a box.
fn n_cubes(length: f64, edge: f64, is_period: bool) -> usize {
    let fewest = if is_period { FEWEST_IN_PERIOD } else { FEWEST_CUBES };
    whole((length / edge).round()).max(fewest)
}

/// The edge length up to one that is wanted (m) with which the cubes that fill a box are nearest to cubes.
fn common_edge(size: &Point<3>, wanted: f64, is_period: [bool; 3]) -> f64 {
    let misfit = |edge: f64| {
        let stretch = Point::<3>::from_fn(|axis, _| {
            (size[axis] / (n_cubes(size[axis], edge, is_period[axis]) as f64 * edge)).ln()
        });
        stretch.max() - stretch.min() + SHORTER * (wanted / edge).ln()
    };
    let edges = (0..EDGES_TRIED)
        .map(|i| wanted * (1.0 - MOST_SHORTER * f64::from(i) / f64::from(EDGES_TRIED)));
    edges.min_by(|a, b| misfit(*a).total_cmp(&misfit(*b))).unwrap_or(wanted)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubes_that_fill_a_box_are_nearly_cubes() {
        for size in [[1.0, 1.0, 1.0], [1.0, 2.0, 3.3], [0.41, 0.41, 2.5], [1.0, 1.37, 9.1]] {
            let size = Point::from(size);
            let edge = common_edge(&size, 0.4, [false; 3]);
            let edges = size.map(|length| length / n_cubes(length, edge, false) as f64);
            assert!(edges.max() / edges.min() < 1.35, "{edges}");
            assert!(edges.max() < 0.55, "{edges}");
        }
    }
}
