//! The worst cells, each with every means: swaps, smoothing, collapses, and splits that pay.

use super::collapse::CollapseGoal;
use super::improver::Improver;
use crate::interrupt;
use crate::spatial::generate::tetrahedra::Face;
use crate::spatial::generate::tetrahedra::measure::EDGES;

/// Edges shorter than this many wanted lengths are not split.
const SHORT: f64 = 0.8;

/// Moves of a new vertex before it is decided whether its split paid.
const MOVES: usize = 4;

/// Cells around a new vertex that are better than the worst one by this stay as they are.
const SIMILAR: f64 = 0.02;

/// A cell with its quality when the pass began.
struct PoorCell {
    quality: f64,
    cell: u32,
    vertices: [u32; 4],
}

impl Improver<'_> {
    /// Improves the cells of a quality below `poor`, the worst first; with `split` also by splits of
    /// their edges. Gives the number of those improved.
    pub fn worst_pass(&mut self, poor: f64, longest: f64, split: bool) -> usize {
        let cells: Vec<u32> = self.mesh.cells().collect();
        let mut all = Vec::new();
        for cell in cells {
            if interrupt::is_requested() {
                return 0;
            }
            let quality = self.quality(cell);
            if quality < poor {
                all.push(PoorCell { quality, cell, vertices: self.mesh.cell(cell) });
            }
        }
        all.sort_by(|a, b| a.quality.total_cmp(&b.quality).then(a.cell.cmp(&b.cell)));
        let mut n_improved = 0;
        for PoorCell { cell, vertices, .. } in all {
            if interrupt::is_requested() {
                break;
            }
            let is_poor = self.mesh.is_still(cell, vertices) && self.quality(cell) < poor;
            if is_poor && self.improve_cell(cell, poor, longest, split) {
                n_improved += 1;
            }
        }
        n_improved
    }

    fn improve_cell(&mut self, cell: u32, poor: f64, longest: f64, split: bool) -> bool {
        let vertices = self.mesh.cell(cell);
        if self.swap_cell(cell, longest) {
            return true;
        }
        let mut is_moved = false;
        for vertex in vertices {
            is_moved |= self.smooth(vertex, true);
        }
        if self.quality(cell) >= poor {
            return true;
        }
        let ends = EDGES.into_iter().flat_map(|[i, j]| [[i, j], [j, i]]);
        for [i, j] in ends {
            if self.collapse([vertices[i], vertices[j]], CollapseGoal::Improve, longest) {
                return true;
            }
        }
        !is_moved && split && self.split_cell(vertices)
    }

    /// Swaps an edge or a face of a cell, or peels it off the boundary.
    fn swap_cell(&mut self, cell: u32, longest: f64) -> bool {
        let vertices = self.mesh.cell(cell);
        self.peel(cell)
            || EDGES.into_iter().any(|[i, j]| self.remove_edge([vertices[i], vertices[j]], longest))
            || (0..4).any(|opposite| self.swap_face(Face { cell, opposite }, longest))
    }

    /// Splits the first edge of a cell for which that pays in the end; all else is taken back.
    fn split_cell(&mut self, vertices: [u32; 4]) -> bool {
        EDGES.into_iter().any(|[i, j]| {
            let ends = [vertices[i], vertices[j]];
            self.mesh.start_journal();
            let pays = self.split_pays(ends);
            if pays {
                self.mesh.keep_changes();
            } else {
                self.mesh.undo_changes();
            }
            pays
        })
    }

    /// Splits an edge, moves the new vertex, and swaps what is poor around it; whether its cells are
    /// better than those of the edge were.
    fn split_pays(&mut self, ends: [u32; 2]) -> bool {
        if self.mesh.relative_length(ends[0], ends[1]) < SHORT {
            return false;
        }
        let mut shell = Vec::new();
        self.mesh.shell(ends[0], ends[1], &mut shell);
        let before = self.least_quality(&shell);
        let split = self.split_in_middle(ends, 1e-3);
        if !self.may_split(&split) {
            return false;
        }
        let Some(vertex) = self.split(&split, &shell) else {
            return false;
        };
        for _ in 0..MOVES {
            if !self.smooth(vertex, true) {
                break;
            }
        }
        let around = self.mesh.around(vertex).to_vec();
        if self.least_quality(&around) > before {
            return true;
        }
        for cell in around {
            let vertices = self.mesh.cell(cell);
            if !vertices.contains(&vertex) || self.quality(cell) > before + SIMILAR {
                continue;
            }
            let opposite = EDGES.into_iter().map(|edge| edge.map(|local| vertices[local]));
            for edge in opposite.filter(|edge| !edge.contains(&vertex)) {
                if self.remove_edge(edge, f64::INFINITY) {
                    break;
                }
            }
        }
        let around = self.mesh.around(vertex).to_vec();
        self.least_quality(&around) > before
    }
}
