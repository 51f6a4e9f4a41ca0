//! Removal of an edge: the cells around it are replaced by the best triangulation of the ring of
//! their other vertices.

use super::face_swap::LEAST_GAIN;
use super::improver::{Improver, Pending};
use super::replace::NewFace;
use crate::Point;
use crate::spatial::generate::tetrahedra::boundary_edges::tag_of;
use crate::spatial::generate::tetrahedra::surface_set::SurfaceSet;

/// Most cells around an edge that is removed.
const MOST_CELLS: usize = 9;

/// Most vertices in the ring: one more than cells at an edge on the boundary.
const MOST_RING: usize = MOST_CELLS + 1;

/// Cosine of the angle between the normals of the two faces that a swap on a surface makes.
const LEAST_COSINE: f64 = 0.5;

/// The vertices around an edge, counter-clockwise seen from its first end.
struct Ring {
    vertices: [u32; MOST_RING],
    len: usize,
    /// Whether it ends at boundary faces.
    is_open: bool,
}

/// A part of the ring that is triangulated, and the vertex that makes a triangle with its ends.
#[derive(Debug, Clone, Copy)]
struct Part {
    quality: f64,
    apex: usize,
}

/// The ring being triangulated, each triangle making a cell with either end of the edge.
struct Cavity<'i, 'a> {
    improver: &'i Improver<'a>,
    ends: [u32; 2],
    ring: &'i Ring,
    pending: Pending,
    /// Quality to be exceeded.
    before: f64,
}

impl Improver<'_> {
    /// Removes an edge where that raises the worst quality of the cells around it and the new edges are
    /// not longer than `longest` wanted lengths. On a surface the edge is swapped for the other
    /// diagonal of its two faces.
    pub fn remove_edge(&mut self, ends: [u32; 2], longest: f64) -> bool {
        let mut shell = Vec::new();
        self.mesh.shell(ends[0], ends[1], &mut shell);
        if !(2..=MOST_CELLS).contains(&shell.len()) {
            return false;
        }
        let surfaces = self.mesh.edge_surfaces(ends[0], ends[1]);
        if surfaces.len() > 1 || self.is_fixed(surfaces) {
            return false;
        }
        let Some(ring) = self.ring(ends, &shell, !surfaces.is_empty()) else {
            return false;
        };
        if ring.len < 3 {
            return false;
        }
        let mut pending = Pending::Nothing;
        let mut faces = Vec::new();
        if ring.is_open {
            let across = [ring.vertices[0], ring.vertices[ring.len - 1]];
            if !self.can_swap_on_surface(ends, across, surfaces, longest) {
                return false;
            }
            let tag = tag_of(surfaces.as_slice()[0]);
            pending = Pending::NewEdge { ends: across, surfaces };
            faces.extend(ends.map(|end| NewFace { vertices: [end, across[0], across[1]], tag }));
        }
        let before = self.least_quality(&shell);
        let cavity = Cavity { improver: self, ends, ring: &ring, pending, before };
        let Some(cells) = cavity.best_cells(longest) else {
            return false;
        };
        self.mesh.replace(&shell, &cells, &faces);
        true
    }

    /// The ring around an edge; `None` where its cells are not one fan.
    fn ring(&self, [a, b]: [u32; 2], shell: &[u32], is_open: bool) -> Option<Ring> {
        // The two other vertices of each cell, in the order that makes (a, b, x, y) positive
        let mut sides = [[0; 2]; MOST_CELLS];
        let n = shell.len();
        for (side, cell) in sides.iter_mut().zip(shell) {
            *side = opposite_edge(self.mesh.cell(*cell), a, b)?;
        }
        let sides = &sides[..n];
        let start = if is_open {
            sides.iter().position(|[from, _]| sides.iter().all(|[_, to]| to != from))?
        } else {
            0
        };
        let mut vertices = [0; MOST_RING];
        let mut next = sides[start];
        for entry in vertices.iter_mut().take(n) {
            *entry = next[0];
            let end = next[1];
            next = sides.iter().copied().find(|[from, _]| *from == end).unwrap_or([end, end]);
        }
        let mut len = n;
        if is_open {
            vertices[n] = next[0];
            len += 1;
        } else if next[0] != vertices[0] {
            return None;
        }
        // Each vertex once, and all sides used
        let ring = &vertices[..len];
        let is_simple = (0..len).all(|i| !ring[..i].contains(&ring[i]));
        is_simple.then_some(Ring { vertices, len, is_open })
    }

    /// Whether the faces at an edge on a surface can be exchanged for those at the edge across.
    fn can_swap_on_surface(
        &self,
        [a, b]: [u32; 2],
        [c, d]: [u32; 2],
        surfaces: SurfaceSet,
        longest: f64,
    ) -> bool {
        let mut cells = Vec::new();
        self.mesh.shell(c, d, &mut cells);
        let is_new = cells.iter().all(|cell| {
            let vertices = self.mesh.cell(*cell);
            vertices.contains(&a) && vertices.contains(&b)
        });
        if !is_new || self.mesh.relative_length(c, d) > longest {
            return false;
        }
        let tag = tag_of(surfaces.as_slice()[0]);
        let [a, b, c, d] = self.mesh.corners([a, b, c, d]);
        let is_good = |corners: &[Point<3>; 3]| {
            self.follows_surface(corners, tag) && self.is_fine_enough(corners, tag)
        };
        // One on each side of the new edge
        let [one, other] = [(d - c).cross(&(a - c)), (b - c).cross(&(d - c))];
        is_good(&[a, c, d])
            && is_good(&[b, c, d])
            && one.dot(&other) >= LEAST_COSINE * one.norm() * other.norm()
    }
}

/// The vertices of a positive cell other than two of them, so ordered that all four are positive.
fn opposite_edge(cell: [u32; 4], a: u32, b: u32) -> Option<[u32; 2]> {
    let at = |vertex: u32| cell.iter().position(|other| *other == vertex);
    let (i, j) = (at(a)?, at(b)?);
    let mut others = (0..4).filter(|local| *local != i && *local != j);
    let (k, l) = (others.next()?, others.next()?);
    let order = [i, j, k, l];
    let pairs = (0..4).flat_map(|m| (0..m).map(move |n| [n, m]));
    let n_exchanged = pairs.filter(|[n, m]| order[*n] > order[*m]).count();
    Some(if n_exchanged % 2 == 0 { [cell[k], cell[l]] } else { [cell[l], cell[k]] })
}

impl Cavity<'_, '_> {
    /// The cells of the best triangulation of the ring, by dynamic programming over its parts
    /// (@klincsek1980); `None` where none is good enough.
    fn best_cells(&self, longest: f64) -> Option<Vec<[u32; 4]>> {
        let n = self.ring.len;
        let whole = Part { quality: f64::INFINITY, apex: 0 };
        let mut parts = [[whole; MOST_RING]; MOST_RING];
        for width in 2..n {
            for from in 0..n - width {
                let to = from + width;
                let mut best = Part { quality: -1.0, apex: from + 1 };
                for apex in from + 1..to {
                    let sides = parts[from][apex].quality.min(parts[apex][to].quality);
                    let floor = best.quality.max(self.before);
                    if sides > floor {
                        let quality = sides.min(self.quality([from, apex, to], floor));
                        if quality > floor {
                            best = Part { quality, apex };
                        }
                    }
                }
                parts[from][to] = best;
            }
        }
        if parts[0][n - 1].quality <= self.before + LEAST_GAIN {
            return None;
        }
        let mut cells = Vec::with_capacity(2 * (n - 2));
        let mut open = vec![[0, n - 1]];
        while let Some([from, to]) = open.pop() {
            if to < from + 2 {
                continue;
            }
            let [u, v] = [self.ring.vertices[from], self.ring.vertices[to]];
            let is_new = from > 0 || to < n - 1;
            if is_new && self.improver.mesh.relative_length(u, v) > longest {
                return None;
            }
            let apex = parts[from][to].apex;
            cells.extend(self.cells_of([from, apex, to]));
            open.extend([[from, apex], [apex, to]]);
        }
        Some(cells)
    }

    /// The cells between a triangle of the ring and either end of the edge.
    fn cells_of(&self, triangle: [usize; 3]) -> [[u32; 4]; 2] {
        let [u, v, w] = triangle.map(|at| self.ring.vertices[at]);
        [[u, v, w, self.ends[1]], [v, u, w, self.ends[0]]]
    }

    /// The worse quality of the two cells of a triangle; some lower one where the first is not above
    /// a floor.
    fn quality(&self, triangle: [usize; 3], floor: f64) -> f64 {
        let [one, other] = self.cells_of(triangle).map(|vertices| {
            move || {
                let corners = self.improver.mesh.corners(vertices);
                self.improver.quality_of(vertices, &corners, &self.pending)
            }
        });
        let quality = one();
        if quality <= floor { quality } else { quality.min(other()) }
    }
}
