//! `EntryMap`: which entries of the matrix each front takes, and where in its values they go.

use super::super::buckets::Buckets;
use super::super::front::Front;
use crate::sparse::Pattern;
use crate::sparse::index::to_u32;

/// The entries of the matrix, front by front.
#[derive(Debug, Clone)]
pub(in super::super) struct EntryMap {
    /// Entries of the matrix.
    pub sources: Vec<u32>,
    /// Where in the values of the front each goes.
    pub targets: Vec<u32>,
}

/// The order of elimination.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Positions<'a> {
    /// Position of each unknown.
    pub of_unknown: &'a [u32],
    /// Whether the unknown at each position is a pressure.
    pub is_pressure: &'a [bool],
}

impl EntryMap {
    /// Gives each entry of a pattern to the front in which the first of its unknowns is eliminated,
    /// and sets the ranges of the entries of all fronts.
    pub fn new(
        pattern: &Pattern,
        positions: Positions<'_>,
        fronts: &mut [Front],
        border: &[u32],
    ) -> Self {
        let n = pattern.n();
        let mut front_of = vec![0u32; n];
        for (index, front) in (0..to_u32(fronts.len())).zip(fronts.iter()) {
            front_of[front.positions()].fill(index);
        }
        // Two buckets a front: entries among velocities, entries of pressures.
        let mut buckets = Vec::with_capacity(pattern.n_entries());
        let mut rows = Vec::with_capacity(pattern.n_entries());
        for (row, &own) in positions.of_unknown.iter().enumerate() {
            for &column in pattern.row(row) {
                let column = positions.of_unknown[column as usize];
                let has_pressure =
                    positions.is_pressure[column as usize] || positions.is_pressure[own as usize];
                buckets.push(2 * front_of[column.min(own) as usize] + u32::from(has_pressure));
                rows.push(to_u32(row));
            }
        }
        let Buckets { starts, members: sources } = Buckets::new(&buckets, 2 * fronts.len());
        for (index, front) in fronts.iter_mut().enumerate() {
            front.entries = starts[2 * index]..starts[2 * index + 2];
            front.first_pressure_entry = starts[2 * index + 1];
        }
        // Index in the front of each position.
        let mut local = vec![0u32; n];
        let mut targets = Vec::with_capacity(sources.len());
        for front in fronts.iter() {
            let own = local[front.positions()].iter_mut();
            own.zip(0..).for_each(|(index, own)| *index = own);
            for (&position, index) in border[front.border()].iter().zip(to_u32(front.k)..) {
                local[position as usize] = index;
            }
            for &entry in &sources[front.entries.clone()] {
                let row = rows[entry as usize] as usize;
                let column = pattern.row(row)[entry as usize - pattern.starts()[row]];
                let column = positions.of_unknown[column as usize];
                let row = positions.of_unknown[row];
                let (row, column) = (local[row as usize] as usize, local[column as usize] as usize);
                targets.push(to_u32(if column < front.k {
                    row + column * front.m()
                } else {
                    front.m() * front.k + row + (column - front.k) * front.k
                }));
            }
        }
        Self { sources, targets }
    }
}
