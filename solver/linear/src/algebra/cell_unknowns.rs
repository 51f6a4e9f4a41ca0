//! `CellFolds` and `CellUnknowns`: the unknowns of the matrix of each cell of a constrained system.

use rayon::prelude::*;

use super::constraints::{AffineConstraints, Term};
use crate::sparse::index::{to_u16, to_u32};
use crate::sparse::lists::Lists;

/// Marks a row or column of a given value.
pub(super) const NO_UNKNOWN: u32 = u32::MAX;
/// Cells a thread takes at a time.
const CELLS_PER_TASK: usize = 1024;

/// The unknown of each row and column of the matrix of each cell, folded where it has to be.
#[derive(Debug)]
pub struct CellUnknowns {
    /// Number of unknowns of all cells together.
    n: usize,
    /// Start of each cell in `unknowns`, and the end of the last.
    offsets: Vec<usize>,
    /// The unknowns of all cells, `NO_UNKNOWN` for given values.
    unknowns: Vec<u32>,
}

impl CellUnknowns {
    /// Adds unknowns that couple with each other as those of a cell do, without one.
    pub fn push(&mut self, unknowns: &[u32]) {
        self.unknowns.extend(unknowns);
        self.offsets.push(self.unknowns.len());
    }

    /// Number of unknowns of all cells together.
    pub(super) fn n(&self) -> usize {
        self.n
    }

    /// Number of rows of the matrices of all cells.
    pub(super) fn n_rows(&self) -> usize {
        self.unknowns.len()
    }

    /// The unknowns of each cell.
    pub(super) fn cells(&self) -> impl Iterator<Item = &[u32]> {
        self.offsets.windows(2).map(|range| &self.unknowns[range[0]..range[1]])
    }

    /// The unknowns of each cell, given values left out.
    pub(super) fn by_cells(&self) -> Lists {
        let mut lists = Lists::default();
        for cell in self.cells() {
            lists.push(cell.iter().copied().filter(|&unknown| unknown != NO_UNKNOWN));
        }
        lists
    }
}

/// For each cell its raw unknowns, and how its matrix is folded.
///
/// Most cells have raw unknowns that are either free or given. The rows and columns of the free ones
/// are scattered as they are, those of given ones are not stored. In the other cells, at bodies that
/// move freely and at periodic sides, raw unknowns depend on unknowns elsewhere: their matrices are
/// folded, A -> P^T A P, before they are scattered.
#[derive(Debug, Clone)]
pub struct CellFolds {
    n_local_raw: usize,
    raw: Vec<u32>,
    /// How each cell is folded, if it is.
    folded: Vec<Option<Box<FoldedCell>>>,
    largest: usize,
}

/// A cell with raw unknowns that depend on others.
#[derive(Debug, Clone)]
struct FoldedCell {
    n_local: usize,
    /// Index among the cell's unknowns of each entry of the rows of its raw unknowns.
    local: Vec<u16>,
}

/// Overwrites `unknowns` with those of a cell, which is folded where raw unknowns depend on others.
fn folded_cell(
    raw: &[u32],
    constraints: &AffineConstraints,
    unknowns: &mut Vec<u32>,
) -> Option<FoldedCell> {
    unknowns.clear();
    let is_free = |raw: usize| constraints.unknown(raw).is_some();
    let is_given = |raw: usize| constraints.row(raw).is_empty();
    if raw.iter().all(|&raw| is_free(raw as usize) || is_given(raw as usize)) {
        unknowns.extend(
            raw.iter().map(|&raw| constraints.unknown(raw as usize).map_or(NO_UNKNOWN, to_u32)),
        );
        return None;
    }
    let mut local = Vec::new();
    for &raw in raw {
        for &Term { unknown, .. } in constraints.row(raw as usize) {
            let known = unknowns.iter().position(|&other| other == unknown);
            let index = known.unwrap_or_else(|| {
                unknowns.push(unknown);
                unknowns.len() - 1
            });
            local.push(to_u16(index));
        }
    }
    Some(FoldedCell { n_local: unknowns.len(), local })
}

impl CellFolds {
    /// For cells with `n_local_raw` raw unknowns each, listed in `raw`.
    ///
    /// Which unknowns a constraint refers to must not change later; its weights may.
    #[must_use]
    pub fn new(n_local_raw: usize, raw: Vec<u32>, constraints: &AffineConstraints) -> Self {
        let folded: Vec<Option<Box<FoldedCell>>> = raw
            .par_chunks_exact(n_local_raw)
            .with_min_len(CELLS_PER_TASK)
            .map_init(Vec::new, |unknowns, raw| {
                folded_cell(raw, constraints, unknowns).map(Box::new)
            })
            .collect();
        let sizes = folded.iter().flatten().map(|cell| cell.n_local);
        let largest = sizes.fold(n_local_raw, usize::max);
        Self { n_local_raw, raw, folded, largest: largest * largest }
    }

    /// The unknowns of the matrix of each cell.
    #[must_use]
    pub fn unknowns(&self, constraints: &AffineConstraints) -> CellUnknowns {
        let parts = self.raw.par_chunks(CELLS_PER_TASK * self.n_local_raw).map(|raw| {
            let mut part = CellUnknowns {
                n: constraints.n_unknowns(),
                offsets: vec![0],
                unknowns: Vec::with_capacity(raw.len()),
            };
            let mut unknowns = Vec::new();
            for raw in raw.chunks_exact(self.n_local_raw) {
                folded_cell(raw, constraints, &mut unknowns);
                part.unknowns.extend(&unknowns);
                part.offsets.push(part.unknowns.len());
            }
            part
        });
        let parts: Vec<CellUnknowns> = parts.collect();
        let mut all = CellUnknowns {
            n: constraints.n_unknowns(),
            offsets: vec![0],
            unknowns: Vec::with_capacity(parts.iter().map(CellUnknowns::n_rows).sum()),
        };
        for part in &parts {
            let before = all.unknowns.len();
            all.offsets.extend(part.offsets[1..].iter().map(|offset| offset + before));
            all.unknowns.extend(&part.unknowns);
        }
        all
    }

    /// Number of cells.
    #[must_use]
    pub fn n_cells(&self) -> usize {
        self.folded.len()
    }

    /// Raw unknowns of a cell.
    #[must_use]
    pub fn raw_unknowns(&self, cell: usize) -> &[u32] {
        &self.raw[cell * self.n_local_raw..(cell + 1) * self.n_local_raw]
    }

    /// Entries of the largest matrix of a cell, raw or folded.
    #[must_use]
    pub fn largest_matrix(&self) -> usize {
        self.largest
    }

    /// Whether the matrix of a cell has to be folded before it is scattered.
    #[must_use]
    pub fn is_folded(&self, cell: usize) -> bool {
        self.folded[cell].is_some()
    }

    /// P^T A P of a folded cell: `matrix` is its raw matrix, column by column; the beginning of
    /// `folded` is overwritten.
    ///
    /// # Panics
    /// When the cell is not a folded one.
    pub fn fold(
        &self,
        cell: usize,
        constraints: &AffineConstraints,
        matrix: &[f64],
        folded: &mut [f64],
    ) {
        let folded_cell = self.folded[cell].as_deref();
        let FoldedCell { n_local, local } = folded_cell.expect("the cell is a folded one");
        let folded = &mut folded[..n_local * n_local];
        folded.fill(0.0);
        let raw = self.raw_unknowns(cell);
        let mut column_local = local.as_slice();
        for (&raw_column, column) in raw.iter().zip(matrix.chunks_exact(self.n_local_raw)) {
            let column_terms = constraints.row(raw_column as usize);
            let (column_indices, rest) = column_local.split_at(column_terms.len());
            column_local = rest;
            let mut row_local = local.as_slice();
            for (&raw_row, value) in raw.iter().zip(column) {
                let row_terms = constraints.row(raw_row as usize);
                let (row_indices, rest) = row_local.split_at(row_terms.len());
                row_local = rest;
                for (&column, column_term) in column_indices.iter().zip(column_terms) {
                    let value = value * column_term.weight;
                    for (&row, row_term) in row_indices.iter().zip(row_terms) {
                        folded[usize::from(column) * n_local + usize::from(row)] +=
                            row_term.weight * value;
                    }
                }
            }
        }
    }
}
