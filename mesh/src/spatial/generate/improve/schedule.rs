//! The order of the passes that make a good mesh of one that was cut (@freitag1997).

use std::ops::Range;

use super::improver::{Improver, Measure, Straight};
use crate::interrupt;
use crate::spatial::generate::tetrahedra::boundary_edges::INNER;

/// Rounds of passes that give edges their lengths.
const REMESH_ROUNDS: usize = 4;

/// Most passes over the worst cells.
const WORST_PASSES: usize = 8;

/// The same once no cell has two boundary faces.
const LAST_PASSES: usize = 4;

/// Most rounds of splits of faces off their surface with such passes.
const LAST_ROUNDS: usize = 3;

/// Passes over the worst cells without splits.
const PASSES_WITHOUT_SPLITS: usize = 2;

/// Edges may be this many wanted lengths long after a pass that swaps with curved quality.
const LONGEST: f64 = 1.8;

impl Improver<'_> {
    /// Improves a mesh that was cut: first the lengths of edges, by straight cells, then the shapes of
    /// cells with their curved edges, then the smallest angles.
    pub fn improve(&mut self) {
        self.set_measure(Measure::straight(Straight::VolumeLength));
        for round in 0..REMESH_ROUNDS {
            self.collapse_pass(if round == 0 { 0.55 } else { 0.65 }, 1.5);
            self.split_pass(1.5);
            self.swap_pass(0.85, 1.6);
            self.swap_pass(0.85, 1.6);
            self.smooth_pass(false, 1.0);
        }
        let is_bent = self.asked.bent_shapes;
        self.set_measure(measure_of(is_bent, Straight::VolumeLength));
        for _ in 0..2 {
            self.split_pass(LONGEST);
            self.swap_pass(0.8, 1.7);
            self.smooth_pass(false, 1.0);
        }
        self.set_measure(measure_of(is_bent, Straight::Sine));
        self.cure_worst_cells(0..WORST_PASSES);
        if !self.asked.free_nodes {
            return;
        }
        self.split_cells_with_two_faces();
        self.split_pass(LONGEST);
        self.set_measure(Measure { avoids_two_faces: true, ..measure_of(is_bent, Straight::Sine) });
        for _ in 0..LAST_ROUNDS {
            let n_split = self.split_faces_off_surface();
            self.cure_worst_cells(0..LAST_PASSES);
            if n_split == 0 {
                break;
            }
        }
    }

    /// Passes over the worst cells until none helps.
    fn cure_worst_cells(&mut self, passes: Range<usize>) {
        for pass in passes {
            let can_split = pass >= PASSES_WITHOUT_SPLITS;
            let poor = if can_split { 0.5 } else { 0.6 };
            let n_improved = self.worst_pass(poor, LONGEST, can_split);
            self.swap_pass(poor, LONGEST);
            self.smooth_pass(true, poor);
            if n_improved == 0 {
                break;
            }
        }
    }

    /// Splits the free edge of each cell with two boundary faces, which has one free velocity.
    fn split_cells_with_two_faces(&mut self) {
        let cells: Vec<u32> = self.mesh.cells().collect();
        let mut shell = Vec::new();
        for cell in cells {
            if interrupt::is_requested() {
                return;
            }
            let (vertices, tags) = (self.mesh.cell(cell), self.mesh.tags(cell));
            let mut ends = (0..4).filter(|local| tags[*local] != INNER).map(|i| vertices[i]);
            let (Some(a), Some(b), None) = (ends.next(), ends.next(), ends.next()) else {
                continue;
            };
            if self.mesh.edge_surfaces(a, b).is_empty() {
                self.mesh.shell(a, b, &mut shell);
                let split = self.split_in_middle([a, b], 0.0);
                self.split(&split, &shell);
            }
        }
    }
}

/// What cells are measured by, once their edges have their lengths.
fn measure_of(is_curved: bool, straight: Straight) -> Measure {
    if is_curved { Measure::curved(straight) } else { Measure::straight(straight) }
}
