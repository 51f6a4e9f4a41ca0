//! Refinement of the lattice by bisection of longest edges.

use std::collections::BinaryHeap;

use super::improve::{Improver, Split};
use super::tetrahedra::measure::{EDGES, middle};
use crate::{MeshError, Point, interrupt};

/// Edges longer than this many wanted lengths are split.
const LONGEST: f64 = 1.7;

/// Edges longer than this part of it are also compared with the length wanted in their middle.
const LOOK_CLOSER: f64 = 0.6;

/// Depth of the middle of an edge in a body, in lengths of the edge, that its curvature may cause: 0.11
/// at a sphere with edges of 0.85 radii.
pub const DIP: f64 = 0.15;

/// Rounding below which two lengths are the same.
const EQUAL: f64 = 1e-9;

/// Most vertices of a lattice.
const MOST_VERTICES: usize = 8_000_000;

/// An edge that is to be split, the longest first, then by its vertices.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct LongEdge {
    /// Positive numbers are ordered as their bits are.
    length_bits: u32,
    ends: [u32; 2],
}

impl Improver<'_> {
    /// Refines the lattice to a part of the sizes wanted.
    ///
    /// Each edge that is too long is split, but the longest edge of its cells before it, and so on,
    /// which keeps the angles of the lattice and ends (@rivara1984). Inside bodies edges may be longer
    /// by their depth.
    ///
    /// # Errors
    /// [`MeshError::TooManyCells`].
    pub fn refine_lattice(&mut self, part: f64) -> Result<(), MeshError> {
        self.longest = part * LONGEST;
        for vertex in 0..self.mesh.points.len() {
            self.mesh.sizes[vertex] += self.depth(self.mesh.points[vertex]);
        }
        let mut heap = BinaryHeap::new();
        let (mut neighbours, mut shell) = (Vec::new(), Vec::new());
        for vertex in 0..self.mesh.end_of_vertices() {
            self.mesh.neighbours(vertex, &mut neighbours);
            let above = neighbours.iter().filter(|other| **other > vertex);
            heap.extend(above.filter_map(|other| self.long_edge([vertex, *other])));
        }
        while let Some(top) = heap.pop() {
            if interrupt::is_requested() {
                return Err(MeshError::Stopped);
            }
            self.mesh.shell(top.ends[0], top.ends[1], &mut shell);
            if shell.is_empty() {
                continue;
            }
            let ends = self.longest_around(top.ends, &mut shell);
            let Some(vertex) = self.bisect(ends, &mut shell) else {
                continue;
            };
            if ends != top.ends {
                heap.push(top);
            }
            self.mesh.neighbours(vertex, &mut neighbours);
            let ends = neighbours.iter().map(|&other| [other.min(vertex), other.max(vertex)]);
            heap.extend(ends.filter_map(|ends| self.long_edge(ends)));
            if self.mesh.points.len() > MOST_VERTICES {
                let smallest = self.mesh.sizes.iter().copied().fold(f64::INFINITY, f64::min);
                let what = "vertices";
                return Err(MeshError::TooManyCells { what, limit: MOST_VERTICES, smallest });
            }
        }
        for vertex in 0..self.mesh.points.len() {
            let point = self.mesh.points[vertex];
            if self.depth(point) > 0.0 {
                self.mesh.sizes[vertex] = self.sizes.at(point);
            }
        }
        Ok(())
    }

    /// Splits an edge in the middle; gives the new vertex.
    fn bisect(&mut self, ends: [u32; 2], shell: &mut Vec<u32>) -> Option<u32> {
        let surfaces = self.mesh.edge_surfaces(ends[0], ends[1]);
        self.mesh.shell(ends[0], ends[1], shell);
        let given = self.given_parts(ends, shell);
        let point = self.given.of(ends).unwrap_or_else(|| self.mesh.middle(ends));
        let vertex = self.split(&Split { ends, point, surfaces, least_quality: 0.0 }, shell)?;
        self.given.add(vertex, &given);
        self.mesh.sizes[vertex as usize] += self.depth(point);
        Some(vertex)
    }

    /// How far a point is outside the fluid (m), by which edges of the lattice may be longer there.
    fn depth(&self, point: Point<3>) -> f64 {
        (-self.geometry.clearance(point, 0.0)).max(0.0)
    }

    /// The length wanted of the edges of the lattice at a point (m).
    fn lattice_size(&self, point: Point<3>) -> f64 {
        self.sizes.at(point) + self.depth(point)
    }

    /// Whether an edge between two points in the fluid (m) goes through a thin body, which would not
    /// cut it. Edges over a convex surface may dip into it.
    fn goes_through_body(&self, a: Point<3>, b: Point<3>) -> bool {
        self.depth(middle(a, b)) > DIP * (a - b).norm()
            && [a, b].iter().all(|end| self.depth(*end) == 0.0)
    }

    /// An edge that is too long.
    fn long_edge(&self, ends: [u32; 2]) -> Option<LongEdge> {
        let [a, b] = self.mesh.corners(ends);
        let [wanted, other] = ends.map(|end| self.mesh.sizes[end as usize]);
        let length = (a - b).norm();
        let most = self.longest * wanted.min(other);
        let is_long = length > most
            || (length > LOOK_CLOSER * most
                && (length > self.longest * self.lattice_size(middle(a, b))
                    || self.goes_through_body(a, b)));
        #[expect(clippy::cast_possible_truncation, reason = "an order needs no more digits")]
        let length_bits = (length as f32).to_bits();
        is_long.then_some(LongEdge { length_bits, ends })
    }

    /// The edge at the end of the path of ever longer edges from one of them, and its cells.
    fn longest_around(&self, from: [u32; 2], shell: &mut Vec<u32>) -> [u32; 2] {
        let length = |[a, b]: [u32; 2]| self.mesh.length(a, b);
        let mut ends = from;
        let mut longest = length(ends);
        loop {
            let before = ends;
            longest *= 1.0 + EQUAL;
            for &cell in shell.iter() {
                let vertices = self.mesh.cell(cell);
                for [i, j] in EDGES {
                    let edge = [vertices[i].min(vertices[j]), vertices[i].max(vertices[j])];
                    let length = length(edge);
                    if length > longest {
                        (longest, ends) = (length, edge);
                    }
                }
            }
            if ends == before {
                return ends;
            }
            self.mesh.shell(ends[0], ends[1], shell);
        }
    }
}
