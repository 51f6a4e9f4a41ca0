//! `Delays`: rows and columns whose pivots subtrees delay to the fronts above, and their slots there.

use std::collections::BTreeMap;

use super::super::segments::Segment;
use super::elimination::DelayedContribution;
use crate::sparse::index::to_u32;

/// A row and a column that a subtree delays, and the slot above that they share.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in super::super) struct Delay {
    /// Slot of the row in the segment of the subtree.
    pub row: u32,
    /// Slot of the column there.
    pub column: u32,
    /// Slot in the last segment.
    pub above: u32,
}

/// Rows and columns that subtrees delay to the fronts above.
#[derive(Debug, Clone, Default)]
pub(in super::super) struct Delays {
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
