//! Whether triangles are the surface of one solid: closed, oriented, of one shell, not through itself.

use std::collections::BTreeSet;

use super::edges::{Groups, edges_of};
use super::{SurfaceFault, TriangleMesh};
use crate::{Bounds, BoxTree, Point};

/// Area over the square of the longest edge below which a triangle has none.
const FLAT: f64 = 1e-10;

/// Part of the size of two triangles by which they may be in each other and only touch.
const TOUCHING: f64 = 1e-9;

impl TriangleMesh {
    /// Whether the triangles enclose a solid.
    ///
    /// # Errors
    /// The first of the faults found, with their number and a place.
    pub fn check(&self) -> Result<(), SurfaceFault> {
        let first = |found: Vec<Point<3>>, fault: fn(usize, [f64; 3]) -> SurfaceFault| {
            let n = found.len();
            found.first().map_or(Ok(()), |at| Err(fault(n, (*at).into())))
        };
        first(self.flat_triangles(), |n, at| SurfaceFault::Flat { n, at })?;
        let edges = edges_of(self);
        let middle =
            |[a, b]: [u32; 2]| (self.vertices[a as usize] + self.vertices[b as usize]) * 0.5;
        let at_edges = |of: &dyn Fn(usize, usize) -> bool| -> Vec<Point<3>> {
            let found = edges.iter().filter(|(_, beside)| {
                let forward = beside.iter().filter(|one| one.is_forward).count();
                of(beside.len(), forward)
            });
            found.map(|(ends, _)| middle(*ends)).collect()
        };
        first(at_edges(&|n, _| n > 2), |n, at| SurfaceFault::Branched { n, at })?;
        first(at_edges(&|n, _| n == 1), |n, at| SurfaceFault::Open { n, at })?;
        first(at_edges(&|n, forward| n == 2 && forward != 1), |n, at| SurfaceFault::Flipped {
            n,
            at,
        })?;
        first(self.pinched_vertices(), |n, at| SurfaceFault::Branched { n, at })?;
        let shells = self.shells();
        if let [_, second, ..] = shells[..] {
            let at = self.corners(second)[0].into();
            return Err(SurfaceFault::Shells { n: shells.len(), at });
        }
        let volume = self.volume();
        if volume.is_nan() || volume <= 0.0 {
            return Err(SurfaceFault::InsideOut { volume });
        }
        self.crossing().map_or(Ok(()), Err)
    }

    /// Middles of triangles without area.
    fn flat_triangles(&self) -> Vec<Point<3>> {
        let all = 0..self.triangles.len();
        let is_flat = |triangle: &usize| self.is_flat(*triangle);
        all.filter(is_flat)
            .map(|triangle| self.corners(triangle).iter().sum::<Point<3>>() / 3.0)
            .collect()
    }

    /// Whether a triangle has no area.
    pub(super) fn is_flat(&self, triangle: usize) -> bool {
        let [a, b, c] = self.corners(triangle);
        let longest = (a - b).norm().max((b - c).norm()).max((c - a).norm());
        let area = self.area_vector(triangle).norm();
        area.is_nan() || area <= FLAT * longest * longest
    }

    /// Vertices around which triangles make more than one fan.
    fn pinched_vertices(&self) -> Vec<Point<3>> {
        // The corners of triangles, joined where they are at a common edge
        let mut groups = Groups::new(3 * self.triangles.len());
        let corner = |triangle: usize, vertex: u32| {
            let local = self.triangles[triangle].iter().position(|own| *own == vertex);
            3 * triangle + local.unwrap_or_default()
        };
        for (ends, beside) in edges_of(self) {
            for pair in beside.windows(2) {
                for vertex in ends {
                    let [one, other] = [0, 1].map(|i| corner(pair[i].triangle, vertex));
                    groups.join(one, other);
                }
            }
        }
        let mut fans = vec![usize::MAX; self.vertices.len()];
        let mut pinched = BTreeSet::new();
        for (triangle, vertices) in self.triangles.iter().enumerate() {
            for (local, vertex) in vertices.iter().enumerate() {
                let fan = groups.root(3 * triangle + local);
                let known = &mut fans[*vertex as usize];
                if *known == usize::MAX {
                    *known = fan;
                } else if *known != fan {
                    pinched.insert(*vertex);
                }
            }
        }
        pinched.into_iter().map(|vertex| self.vertices[vertex as usize]).collect()
    }

    /// A triangle of each of the shells that hang together by edges, the first ones.
    pub(super) fn shells(&self) -> Vec<usize> {
        let mut groups = Groups::new(self.triangles.len());
        for beside in edges_of(self).values() {
            for pair in beside.windows(2) {
                groups.join(pair[0].triangle, pair[1].triangle);
            }
        }
        (0..self.triangles.len()).filter(|triangle| groups.root(*triangle) == *triangle).collect()
    }

    /// Two triangles that go through each other.
    fn crossing(&self) -> Option<SurfaceFault> {
        let n = self.triangles.len();
        let bounds: Vec<Bounds<3>> =
            (0..n).map(|triangle| Bounds::around(&self.corners(triangle))).collect();
        let tree = BoxTree::new(&bounds);
        let meet = |one: &Bounds<3>, other: &Bounds<3>| {
            (0..3).all(|axis| one.min[axis] <= other.max[axis] && other.min[axis] <= one.max[axis])
        };
        for first in 0..n {
            let own = &bounds[first];
            let reach = 0.5 * (own.max - own.min).norm();
            let mut found = None;
            tree.visit_near((own.min + own.max) * 0.5, reach, |second, _| {
                if second > first && meet(own, &bounds[second]) {
                    let at = self.through_each_other(first, second);
                    found = at.map(|at| SurfaceFault::Crossing { first, second, at: at.into() });
                }
                found.is_some()
            });
            if found.is_some() {
                return found;
            }
        }
        None
    }

    /// Where an edge of one of two triangles goes through the other one, vertices of both left out.
    fn through_each_other(&self, first: usize, second: usize) -> Option<Point<3>> {
        let edge_through = |one: usize, other: usize| {
            let [a, b, c] = self.triangles[one];
            let others = self.triangles[other];
            let edges = [[a, b], [b, c], [c, a]].into_iter();
            let apart = edges.filter(|ends| !ends.iter().any(|end| others.contains(end)));
            let mut through = apart.filter_map(|ends| {
                let ends = ends.map(|end| self.vertices[end as usize]);
                segment_through(ends, self.corners(other))
            });
            through.next()
        };
        edge_through(first, second).or_else(|| edge_through(second, first))
    }
}

/// Where a segment goes through a triangle.
fn segment_through([from, to]: [Point<3>; 2], [a, b, c]: [Point<3>; 3]) -> Option<Point<3>> {
    let normal = (b - a).cross(&(c - a));
    let size = normal.norm() * (to - from).norm();
    let (start, end) = (normal.dot(&(from - a)), normal.dot(&(to - a)));
    // Ends that touch, and segments along the triangle, do not go through it
    if start * end >= 0.0 || start.abs().min(end.abs()) <= TOUCHING * size {
        return None;
    }
    let at = from + (to - from) * (start / (start - end));
    let over = |p: Point<3>, q: Point<3>| (q - p).cross(&(at - p)).dot(&normal);
    let margin = TOUCHING * normal.norm_squared();
    [over(a, b), over(b, c), over(c, a)].iter().all(|part| *part > margin).then_some(at)
}
