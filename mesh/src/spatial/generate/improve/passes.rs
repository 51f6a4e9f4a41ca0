//! Passes over the whole mesh: collapses, splits, swaps and smoothing.

use super::collapse::CollapseGoal;
use super::improver::Improver;
use crate::interrupt;
use crate::spatial::generate::tetrahedra::Face;

/// Part of the worst quality to which a collapse may lower it.
const COLLAPSE_LOSS: f64 = 0.6;

/// Edges shorter than this many wanted lengths are not split for the curvature of the surface.
const SHORT: f64 = 0.5;

/// Most cells around a vertex that swaps are tried at: flat cells of a bad cut are swapped for more of them without
/// end, and vertices of good meshes have a tenth of these.
const MOST_AROUND: usize = 400;

/// An edge with its length over that wanted.
#[derive(Debug, Clone, Copy)]
struct RatedEdge {
    length: f64,
    ends: [u32; 2],
}

impl Improver<'_> {
    /// Collapses edges shorter than `shortest` wanted lengths where none becomes longer than `longest`.
    pub fn collapse_pass(&mut self, shortest: f64, longest: f64) -> usize {
        let mut n_collapsed = 0;
        let mut neighbours = Vec::new();
        let mut short: Vec<RatedEdge> = Vec::new();
        for vertex in 0..self.mesh.end_of_vertices() {
            if interrupt::is_requested() {
                break;
            }
            if self.mesh.around(vertex).is_empty() {
                continue;
            }
            self.mesh.neighbours(vertex, &mut neighbours);
            short.clear();
            let rated = neighbours.iter().map(|&other| RatedEdge {
                length: self.mesh.relative_length(vertex, other),
                ends: [vertex, other],
            });
            short.extend(rated.filter(|edge| edge.length < shortest));
            short.sort_by(|a, b| a.length.total_cmp(&b.length).then(a.ends.cmp(&b.ends)));
            let goal = CollapseGoal::Coarsen(COLLAPSE_LOSS);
            let is_collapsed = short.iter().any(|edge| self.collapse(edge.ends, goal, longest));
            n_collapsed += usize::from(is_collapsed);
        }
        n_collapsed
    }

    /// Splits edges longer than `longest` wanted lengths, and edges too long for the curvature of
    /// their surface, the longest first.
    pub fn split_pass(&mut self, longest: f64) -> usize {
        let mut long = Vec::new();
        let mut neighbours = Vec::new();
        for vertex in 0..self.mesh.end_of_vertices() {
            if interrupt::is_requested() {
                return 0;
            }
            if self.mesh.around(vertex).is_empty() {
                continue;
            }
            self.mesh.neighbours(vertex, &mut neighbours);
            for &other in neighbours.iter().filter(|other| **other > vertex) {
                let length = self.mesh.relative_length(vertex, other);
                if length > longest || (length > SHORT && self.bends(vertex, other)) {
                    long.push(RatedEdge { length, ends: [vertex, other] });
                }
            }
        }
        long.sort_by(|a, b| b.length.total_cmp(&a.length).then(a.ends.cmp(&b.ends)));
        let edges = long.into_iter().take_while(|_| !interrupt::is_requested());
        edges.filter(|edge| self.split_in_two(edge.ends)).count()
    }

    /// Whether an edge on a surface is too long for its curvature.
    fn bends(&self, a: u32, b: u32) -> bool {
        let surfaces = self.mesh.edge_surfaces(a, b);
        let [a, b] = self.mesh.corners([a, b]);
        !self.is_short_enough(a, b, surfaces)
    }

    /// Swaps faces and edges of cells with a quality up to `poor`, where something has changed since
    /// the last such pass.
    pub fn swap_pass(&mut self, poor: f64, longest: f64) -> usize {
        let since = self.last_swaps;
        self.last_swaps = self.mesh.tick();
        let mut n_swapped = 0;
        let (mut neighbours, mut shell) = (Vec::new(), Vec::new());
        for vertex in 0..self.mesh.end_of_vertices() {
            if interrupt::is_requested() {
                break;
            }
            let n_around = self.mesh.around(vertex).len();
            if !(1..=MOST_AROUND).contains(&n_around) || !self.mesh.has_changed_since(vertex, since)
            {
                continue;
            }
            n_swapped += self.swap_faces_at(vertex, since, poor, longest);
            self.mesh.neighbours(vertex, &mut neighbours);
            // Each edge once, from its end with the smaller number
            neighbours
                .retain(|&other| other > vertex || !self.mesh.has_changed_since(other, since));
            for &other in &neighbours {
                self.mesh.shell(vertex, other, &mut shell);
                let is_poor = !shell.is_empty() && self.least_quality(&shell) <= poor;
                if is_poor && self.remove_edge([vertex, other], longest) {
                    n_swapped += 1;
                }
            }
        }
        n_swapped
    }

    /// Peels poor cells around a vertex off the boundary, or swaps one of their faces.
    fn swap_faces_at(&mut self, vertex: u32, since: u32, poor: f64, longest: f64) -> usize {
        let mut n_swapped = 0;
        for at in (0..self.mesh.around(vertex).len()).rev() {
            let Some(&cell) = self.mesh.around(vertex).get(at) else {
                continue;
            };
            // Each cell once, from its vertex with the smallest number
            let is_seen = self
                .mesh
                .cell(cell)
                .iter()
                .any(|&other| other < vertex && self.mesh.has_changed_since(other, since));
            if is_seen || self.quality(cell) > poor {
                continue;
            }
            let is_swapped = self.peel(cell)
                || (0..4).any(|opposite| self.swap_face(Face { cell, opposite }, longest));
            n_swapped += usize::from(is_swapped);
        }
        n_swapped
    }

    /// Smooths vertices with cells of a quality up to `poor`, where something has changed since the
    /// last such pass.
    pub fn smooth_pass(&mut self, climb: bool, poor: f64) -> usize {
        let since = self.last_smoothing;
        self.last_smoothing = self.mesh.tick();
        let mut n_moved = 0;
        for vertex in 0..self.mesh.end_of_vertices() {
            if interrupt::is_requested() {
                break;
            }
            if self.mesh.around(vertex).is_empty() || !self.mesh.has_changed_since(vertex, since) {
                continue;
            }
            let is_poor = poor >= 1.0 || {
                let around = self.mesh.around(vertex).to_vec();
                self.least_quality(&around) <= poor
            };
            n_moved += usize::from(is_poor && self.smooth(vertex, climb));
        }
        n_moved
    }
}
