//! Sparsity patterns of cells: runs of unknowns that share all cells are worked on together.

use std::ops::Range;

use crate::sparse::Pattern;
use crate::sparse::index::to_u32;

/// Marks a row or column of a given value.
pub(super) const NO_UNKNOWN: u32 = u32::MAX;

/// The unknown of each row and column of the matrix of each cell, `NO_UNKNOWN` for a given value.
#[derive(Debug)]
pub(super) struct CellUnknowns {
    /// Start of each cell in `unknowns`, and the end of the last.
    pub offsets: Vec<usize>,
    /// The unknowns of all cells.
    pub unknowns: Vec<u32>,
}

impl CellUnknowns {
    /// The unknowns of each cell.
    pub fn cells(&self) -> impl Iterator<Item = &[u32]> {
        self.offsets.windows(2).map(|range| &self.unknowns[range[0]..range[1]])
    }

    /// The cells of each of n unknowns, each once for each time it has the unknown.
    fn cells_of_unknowns(&self, n: usize) -> Lists {
        let mut starts = vec![0; n + 1];
        let free = |cell: &[u32]| cell.iter().filter(|&&one| one != NO_UNKNOWN).count();
        for &unknown in self.unknowns.iter().filter(|&&unknown| unknown != NO_UNKNOWN) {
            starts[unknown as usize + 1] += 1;
        }
        for unknown in 0..n {
            starts[unknown + 1] += starts[unknown];
        }
        let mut next = starts.clone();
        let mut items = vec![0; self.cells().map(free).sum()];
        for (cell, unknowns) in self.cells().enumerate() {
            for &unknown in unknowns.iter().filter(|&&unknown| unknown != NO_UNKNOWN) {
                items[next[unknown as usize]] = to_u32(cell);
                next[unknown as usize] += 1;
            }
        }
        Lists { starts, items }
    }
}

/// Lists one after the other.
#[derive(Debug)]
struct Lists {
    starts: Vec<usize>,
    items: Vec<u32>,
}

impl Lists {
    fn list(&self, index: usize) -> &[u32] {
        &self.items[self.starts[index]..self.starts[index + 1]]
    }
}

/// Unknowns with consecutive numbers that are alike, such as the velocities at a node.
#[derive(Debug)]
pub(super) struct Runs {
    of_unknown: Vec<u32>,
    /// First unknown of each run, and the end of the last.
    starts: Vec<u32>,
}

impl Runs {
    /// Of n unknowns, of which `is_like_last` says whether one goes on with the run of the last.
    fn new(n: usize, is_like_last: impl Fn(usize) -> bool) -> Self {
        let mut runs = Self { of_unknown: Vec::with_capacity(n), starts: Vec::new() };
        for unknown in 0..n {
            if unknown == 0 || !is_like_last(unknown) {
                runs.starts.push(to_u32(unknown));
            }
            runs.of_unknown.push(to_u32(runs.starts.len() - 1));
        }
        runs.starts.push(to_u32(n));
        runs
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

/// Columns of all pairs of unknowns that share a cell and couple.
pub(super) fn build_pattern(
    n: usize,
    unknowns: &CellUnknowns,
    couples: &impl Fn(usize, usize) -> bool,
) -> Pattern {
    let cells = unknowns.cells_of_unknowns(n);
    let runs = Runs::new(n, |unknown| cells.list(unknown) == cells.list(unknown - 1));
    let mut of_cells = Lists { starts: vec![0], items: Vec::new() };
    let mut distinct = Vec::new();
    for cell in unknowns.cells() {
        runs.distinct(cell, &mut distinct);
        of_cells.items.extend(&distinct);
        of_cells.starts.push(of_cells.items.len());
    }
    let mut pattern = Pattern { columns: Vec::with_capacity(n + 1), rows: Vec::new() };
    pattern.columns.push(0);
    let mut last_near = vec![NO_UNKNOWN; runs.starts.len() - 1];
    let mut near: Vec<u32> = Vec::new();
    for run in 0..to_u32(runs.starts.len() - 1) {
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
        for column in runs.unknowns(run) {
            let rows = near.iter().flat_map(|&other| runs.unknowns(other));
            pattern.rows.extend(rows.filter(|&row| couples(row, column)));
            pattern.columns.push(pattern.rows.len());
        }
    }
    pattern.rows.shrink_to_fit();
    pattern
}

/// The stored entries of the matrices of cells, found by runs.
#[derive(Debug)]
pub(super) struct EntryFinder<'a> {
    pattern: &'a Pattern,
    /// Unknowns with entries in the same rows.
    runs: Runs,
    distinct: Vec<u32>,
    /// Place of each run among those of the cell at hand.
    place: Vec<u32>,
    /// For each two runs of the cell the first entry of the one in the first column of the other.
    first: Vec<Option<u32>>,
}

impl<'a> EntryFinder<'a> {
    /// In a pattern with the transposed of each of its entries.
    pub fn new(pattern: &'a Pattern) -> Self {
        let runs = Runs::new(pattern.n(), |unknown| {
            pattern.column(unknown) == pattern.column(unknown - 1)
        });
        let place = vec![0; runs.starts.len() - 1];
        Self { pattern, runs, distinct: Vec::new(), place, first: Vec::new() }
    }

    /// Calls `visit` with each entry of the matrix of a cell, column by column; none where there is none.
    pub fn for_each_entry(&mut self, cell: &[u32], mut visit: impl FnMut(Option<u32>)) {
        let Self { pattern, runs, distinct, place, first } = self;
        runs.distinct(cell, distinct);
        first.clear();
        for (index, &run) in distinct.iter().enumerate() {
            place[run as usize] = to_u32(index);
            let column = runs.unknowns(run).start;
            first.extend(
                distinct
                    .iter()
                    .map(|&other| pattern.entry(runs.unknowns(other).start, column).map(to_u32)),
            );
        }
        let n_runs = distinct.len();
        for &column in cell {
            if column == NO_UNKNOWN {
                cell.iter().for_each(|_| visit(None));
                continue;
            }
            let run = runs.of_unknown[column as usize];
            let shift =
                pattern.columns[column as usize] - pattern.columns[runs.unknowns(run).start];
            let first = &first[place[run as usize] as usize * n_runs..][..n_runs];
            for &row in cell {
                let entry = (row != NO_UNKNOWN).then(|| runs.of_unknown[row as usize]);
                let entry = entry.and_then(|run| {
                    let offset = row as usize - runs.unknowns(run).start;
                    first[place[run as usize] as usize].map(|entry| entry + to_u32(shift + offset))
                });
                visit(entry);
            }
        }
    }
}
