//! The order of the passes that make a good mesh of one that was cut.

use super::improver::{Improver, Measure, Straight};

/// Rounds of passes that give edges their lengths.
const REMESH_ROUNDS: usize = 4;

/// Most passes over the worst cells.
const WORST_PASSES: usize = 8;

/// Passes over the worst cells without splits.
const PASSES_WITHOUT_SPLITS: usize = 2;

/// Edges may be this many wanted lengths long after a pass that swaps with curved quality.
const LONGEST: f64 = 1.8;

impl Improver<'_> {
    /// Improves a mesh that was cut: first the lengths of edges, by straight cells, then the shapes of
    /// cells with their curved edges, then the smallest angles.
    pub fn improve(&mut self) {
        let straight = Straight::VolumeLength;
        self.set_measure(Measure { straight, is_curved: false });
        for round in 0..REMESH_ROUNDS {
            self.collapse_pass(if round == 0 { 0.55 } else { 0.65 }, 1.5);
            self.split_pass(1.5);
            self.swap_pass(0.85, 1.6);
            self.swap_pass(0.85, 1.6);
            self.smooth_pass(false, 1.0);
        }
        self.set_measure(Measure { straight, is_curved: true });
        for _ in 0..2 {
            self.swap_pass(0.8, 1.7);
            self.smooth_pass(false, 1.0);
        }
        self.set_measure(Measure { straight: Straight::Sine, is_curved: true });
        for pass in 0..WORST_PASSES {
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
}
