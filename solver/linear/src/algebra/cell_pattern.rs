//! Sparsity patterns of cells: runs of unknowns that share all cells are worked on together.

use std::ops::Range;

use alewife_interrupt::is_requested;

use super::cell_unknowns::{CellUnknowns, NO_UNKNOWN};
use crate::sparse::Pattern;
use crate::sparse::index::{to_u8, to_u32};
use crate::sparse::lists::Lists;

/// Unknowns of a run at most.
const LONGEST: usize = 64;

/// Unknowns with consecutive numbers that are alike, such as the velocities at a node.
#[derive(Debug)]
pub(super) struct Runs {
    of_unknown: Vec<u32>,
    /// First unknown of each run, and the end of the last.
    starts: Vec<u32>,
}

impl Runs {
    /// Of n unknowns, of which `is_like_last` says whether one continues with the run of the last.
    fn new(n: usize, is_like_last: impl Fn(usize) -> bool) -> Self {
        let mut runs = Self { of_unknown: Vec::with_capacity(n), starts: Vec::new() };
        for unknown in 0..n {
            let length = runs.starts.last().map_or(LONGEST, |start| unknown - *start as usize);
            if length == LONGEST || !is_like_last(unknown) {
                runs.starts.push(to_u32(unknown));
            }
            runs.of_unknown.push(to_u32(runs.starts.len() - 1));
        }
        runs.starts.push(to_u32(n));
        runs
    }

    /// Number of runs.
    fn n(&self) -> usize {
        self.starts.len() - 1
    }

    /// Place of an unknown among the distinct runs of its cell.
    fn place(&self, unknown: u32, distinct: &[u32]) -> Place {
        let Some(&run) = self.of_unknown.get(unknown as usize) else {
            return Place { run: GIVEN, offset: 0 };
        };
        let index = distinct.iter().take_while(|&&other| other != run).count();
        let offset = unknown - self.starts[run as usize];
        Place { run: to_u8(index), offset: to_u8(offset as usize) }
    }

    fn unknowns(&self, run: u32) -> Range<usize> {
        self.starts[run as usize] as usize..self.starts[run as usize + 1] as usize
    }

    /// Overwrites `distinct` with the runs of some unknowns, each once.
    fn distinct(&self, unknowns: &[u32], distinct: &mut Vec<u32>) {
        distinct.clear();
        for &unknown in unknowns.iter().filter(|&&unknown| unknown != NO_UNKNOWN) {
            let run = self.of_unknown[unknown as usize];
            if !distinct.contains(&run) {
                distinct.push(run);
            }
        }
    }
}

/// Rows of all pairs of unknowns that share a cell and couple; None where the work of this thread is to end.
pub(super) fn build_pattern(
    n: usize,
    unknowns: &CellUnknowns,
    couples: &impl Fn(usize, usize) -> bool,
) -> Option<Pattern> {
    let cells = unknowns.by_cells().inverted(n);
    let runs = Runs::new(n, |unknown| cells.list(unknown) == cells.list(unknown - 1));
    let mut of_cells = Lists::default();
    let mut distinct = Vec::new();
    for cell in unknowns.cells() {
        if is_requested() {
            return None;
        }
        runs.distinct(cell, &mut distinct);
        of_cells.push(distinct.iter().copied());
    }
    let mut pattern = Pattern::default();
    let mut last_near = vec![NO_UNKNOWN; runs.n()];
    let mut near: Vec<u32> = Vec::new();
    let mut columns: Vec<u32> = Vec::new();
    for run in 0..to_u32(runs.n()) {
        if is_requested() {
            return None;
        }
        near.clear();
        for &cell in cells.list(runs.unknowns(run).start) {
            for &other in of_cells.list(cell as usize) {
                if last_near[other as usize] != run {
                    last_near[other as usize] = run;
                    near.push(other);
                }
            }
        }
        near.sort_unstable();
        for row in runs.unknowns(run) {
            columns.clear();
            let all = near.iter().flat_map(|&other| runs.unknowns(other));
            columns.extend(all.filter(|&column| couples(row, column)).map(to_u32));
            pattern.push(&columns);
        }
    }
    pattern.shrink();
    Some(pattern)
}

/// Where the matrices of cells go: for each two runs of unknowns of a cell the first entry that they have.
#[derive(Debug, Clone)]
pub(super) struct CellEntries {
    /// Start of each cell in `places`, and the end of the last.
    place_offsets: Vec<usize>,
    /// Of each row and column of the matrix of each cell.
    places: Vec<Place>,
    /// Start of each cell in `lengths`, and the end of the last.
    run_offsets: Vec<usize>,
    /// Length of the rows of each run of each cell.
    lengths: Vec<u32>,
    /// Start of each cell in `first`.
    first_offsets: Vec<usize>,
    /// For each two runs of a cell the entry of the first row of one in the first column of the
    /// other, row by row; `NOT_STORED` for pairs that do not couple.
    first: Vec<u32>,
}

/// Where a row or column stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Place {
    /// Its run, among those of the cell; `GIVEN` for a given value.
    run: u8,
    /// Its number in the run.
    offset: u8,
}

/// Marks a row or column of a given value.
const GIVEN: u8 = u8::MAX;
/// Marks two runs that do not couple.
const NOT_STORED: u32 = u32::MAX;

impl CellEntries {
    /// In a pattern with the transposed of each of its entries; None where the work of this thread is to end.
    pub fn new(pattern: &Pattern, unknowns: &CellUnknowns) -> Option<Self> {
        let runs = Runs::new(pattern.n(), |unknown| pattern.is_like_last(unknown));
        let mut all = Self {
            place_offsets: vec![0],
            places: Vec::with_capacity(unknowns.n_rows()),
            run_offsets: vec![0],
            lengths: Vec::new(),
            first_offsets: Vec::with_capacity(unknowns.cells().count()),
            first: Vec::new(),
        };
        let mut distinct = Vec::new();
        for cell in unknowns.cells() {
            if is_requested() {
                return None;
            }
            runs.distinct(cell, &mut distinct);
            all.places.extend(cell.iter().map(|&unknown| runs.place(unknown, &distinct)));
            all.place_offsets.push(all.places.len());
            all.first_offsets.push(all.first.len());
            for &run in &distinct {
                let row = runs.unknowns(run).start;
                all.lengths.push(to_u32(pattern.row(row).len()));
                all.first.extend(distinct.iter().map(|&other| {
                    let entry = pattern.entry(row, runs.unknowns(other).start);
                    entry.map_or(NOT_STORED, to_u32)
                }));
            }
            all.run_offsets.push(all.lengths.len());
        }
        all.lengths.shrink_to_fit();
        all.first.shrink_to_fit();
        Some(all)
    }

    /// Calls `visit` with the place of each stored entry in the matrix of a cell, which is column by column,
    /// and its index among the entries of the pattern.
    #[inline(always)]
    pub fn for_each(&self, cell: usize, mut visit: impl FnMut(usize, usize)) {
        let places = &self.places[self.place_offsets[cell]..self.place_offsets[cell + 1]];
        let lengths = &self.lengths[self.run_offsets[cell]..self.run_offsets[cell + 1]];
        let first = &self.first[self.first_offsets[cell]..][..lengths.len() * lengths.len()];
        let n = places.len();
        for (row, place) in places.iter().enumerate().filter(|(_, place)| place.run != GIVEN) {
            let run = usize::from(place.run);
            let shift = u32::from(place.offset) * lengths[run];
            let first = &first[run * lengths.len()..][..lengths.len()];
            for (column, place) in places.iter().enumerate() {
                let Some(&first) = first.get(usize::from(place.run)) else { continue };
                if first != NOT_STORED {
                    let entry = first + shift + u32::from(place.offset);
                    visit(column * n + row, entry as usize);
                }
            }
        }
    }
}
