//! `Segment`: the part of the vectors of the substitutions that a subtree works on.
//!
//! It holds the unknowns of the subtree in the order of elimination, then copies of those of the border of
//! its root, which belong to the fronts above: so subtrees do not meet, and what they add to the fronts
//! above is added in their order. The last segment holds the unknowns of these fronts, then those whose
//! pivots the subtrees delayed. A slot is an index in a segment.

use std::collections::BTreeMap;
use std::ops::Range;

use super::elimination::DelayedContribution;
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

/// A row and a column that a subtree delays, and the slot above that they share.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Delay {
    /// Slot of the row in the segment of the subtree.
    pub row: u32,
    /// Slot of the column there.
    pub column: u32,
    /// Slot in the last segment.
    pub above: u32,
}

/// Rows and columns that subtrees delay to the fronts above.
#[derive(Debug, Clone, Default)]
pub(super) struct Delays {
    /// Of each subtree.
    pub of_subtrees: Vec<Vec<Delay>>,
    /// Slot above of the position of each row.
    row_slots: BTreeMap<u32, u32>,
    /// Slot above of the position of each column.
    column_slots: BTreeMap<u32, u32>,
}

impl Delays {
    /// Those of the contributions of the roots of subtrees, for all segments.
    pub fn new(segments: &[Segment], contributions: &BTreeMap<usize, DelayedContribution>) -> Self {
        let mut all = Self::default();
        let Some((above, subtrees)) = segments.split_last() else { return all };
        let mut next = to_u32(above.n_slots());
        for segment in subtrees {
            let mut delays = Vec::new();
            let root = segment.fronts.end.checked_sub(1);
            if let Some(root) = root.and_then(|root| contributions.get(&root)) {
                for (&row, &column) in root.delayed_rows.iter().zip(&root.delayed_columns) {
                    let own = |at: u32| to_u32(at as usize - segment.positions.start);
                    delays.push(Delay { row: own(row), column: own(column), above: next });
                    all.row_slots.insert(row, next);
                    all.column_slots.insert(column, next);
                    next += 1;
                }
            }
            all.of_subtrees.push(delays);
        }
        all
    }

    /// Number of slots they take in the last segment.
    pub fn len(&self) -> usize {
        self.row_slots.len()
    }

    /// Slots of the positions of the rows of a front.
    pub fn slots_of_rows(&self, segment: &Segment, rows: &[u32]) -> Vec<u32> {
        slots(segment, rows, &self.row_slots)
    }

    /// Slots of the positions of the columns of a front.
    pub fn slots_of_columns(&self, segment: &Segment, columns: &[u32]) -> Vec<u32> {
        slots(segment, columns, &self.column_slots)
    }
}

fn slots(segment: &Segment, positions: &[u32], delayed: &BTreeMap<u32, u32>) -> Vec<u32> {
    let slot = |position: &u32| segment.slot(*position).or_else(|| delayed.get(position).copied());
    let slots = positions.iter().map(|at| slot(at).expect("a front knows its own unknowns"));
    slots.collect()
}
