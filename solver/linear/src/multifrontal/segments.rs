//! `Segment`: the part of the vectors of the substitutions that a subtree works on.
//!
//! It holds the unknowns of the subtree in the order of elimination, then copies of those of the border of
//! its root, which belong to the fronts above: so subtrees do not meet, and what they add to the fronts
//! above is added in their order. The last segment holds the unknowns of these fronts, then those whose
//! pivots the subtrees delayed (`Delays`). A slot is an index in a segment.

use std::ops::Range;

use super::front::{Front, Subtree};
use crate::sparse::index::to_u32;

/// Fronts that are worked on one after the other, and the slots of their unknowns.
#[derive(Debug, Clone)]
pub(super) struct Segment {
    pub fronts: Range<usize>,
    /// Positions of the unknowns eliminated in them, which have the first slots.
    pub positions: Range<usize>,
    /// Positions of the unknowns copied, ascending, which have the next slots.
    pub copies: Vec<u32>,
    /// Order of the largest front that the analysis foresees.
    pub largest_front: usize,
}

impl Segment {
    /// Of a subtree, or of the fronts above, which have nothing to copy.
    pub fn new(subtree: &Subtree, fronts: &[Front], border: &[u32]) -> Self {
        let range = subtree.fronts.clone();
        let (Some(first), Some(root)) =
            (fronts[range.clone()].first(), fronts[range.clone()].last())
        else {
            return Self { fronts: range, positions: 0..0, copies: Vec::new(), largest_front: 0 };
        };
        let positions = first.start..root.start + root.k;
        let largest_front = fronts[range.clone()].iter().map(Front::m).fold(0, usize::max);
        let copies = border[root.border()].to_vec();
        Self { fronts: range, positions, copies, largest_front }
    }

    /// Number of slots that the analysis foresees.
    pub fn n_slots(&self) -> usize {
        self.positions.len() + self.copies.len()
    }

    /// The slot of a position, if it is one of these.
    pub fn slot(&self, position: u32) -> Option<u32> {
        let at = position as usize;
        if self.positions.contains(&at) {
            return Some(to_u32(at - self.positions.start));
        }
        let copy = self.copies.binary_search(&position).ok()?;
        Some(to_u32(self.positions.len() + copy))
    }
}

/// Where an unknown stands.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Slot {
    pub segment: u32,
    pub index: u32,
}
