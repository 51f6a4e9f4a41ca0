//! `CellMaps`: the sparsity pattern of a constrained system, and where each cell's matrix goes in it.

use std::sync::Arc;

use super::cell_pattern::{CellEntries, CellUnknowns, NO_UNKNOWN, build_pattern};
use super::constraints::{AffineConstraints, Term};
use crate::sparse::Pattern;
use crate::sparse::index::{to_u16, to_u32};

/// For each cell, its raw unknowns, and where the entries of its matrix are stored.
///
/// Most cells have raw unknowns that are either free or given. The rows and columns of the free ones
/// are scattered as they are, those of given ones are not stored. In the other cells, at bodies that
/// move freely and at periodic sides, raw unknowns depend on unknowns elsewhere: their matrices are
/// folded, A -> P^T A P, before they are scattered.
#[derive(Debug, Clone)]
pub struct CellMaps {
    pattern: Arc<Pattern>,
    n_local_raw: usize,
    raw: Vec<u32>,
    entries: CellEntries,
    /// The folded cells, in order.
    folded: Vec<FoldedCell>,
    /// Index in `folded` of each cell, if it is one of them.
    folded_index: Vec<u32>,
    largest: usize,
}

/// A cell with raw unknowns that depend on others.
#[derive(Debug, Clone)]
struct FoldedCell {
    n_local: usize,
    /// Index among the cell's unknowns of each entry of the rows of its raw unknowns.
    local: Vec<u16>,
}

/// Marks a cell that is not folded.
const NOT_FOLDED: u32 = u32::MAX;

impl CellUnknowns {
    /// Appends a cell, which is folded where raw unknowns depend on others.
    fn push(&mut self, raw: &[u32], constraints: &AffineConstraints) -> Option<FoldedCell> {
        let start = self.unknowns.len();
        let is_free = |raw: usize| constraints.unknown(raw).is_some();
        let is_given = |raw: usize| constraints.row(raw).is_empty();
        let folded = if raw.iter().all(|&raw| is_free(raw as usize) || is_given(raw as usize)) {
            self.unknowns.extend(
                raw.iter().map(|&raw| constraints.unknown(raw as usize).map_or(NO_UNKNOWN, to_u32)),
            );
            None
        } else {
            let mut local = Vec::new();
            for &raw in raw {
                for &Term { unknown, .. } in constraints.row(raw as usize) {
                    let known = self.unknowns[start..].iter().position(|&other| other == unknown);
                    let index = known.unwrap_or_else(|| {
                        self.unknowns.push(unknown);
                        self.unknowns.len() - 1 - start
                    });
                    local.push(to_u16(index));
                }
            }
            Some(FoldedCell { n_local: self.unknowns.len() - start, local })
        };
        self.offsets.push(self.unknowns.len());
        folded
    }
}

impl CellMaps {
    /// Pattern and maps for cells with `n_local_raw` raw unknowns each, listed in `raw`.
    ///
    /// `couples(i, j)` says whether two free unknowns of a cell have an entry (two pressures do
    /// not), in whatever order they are named. Which unknowns a constraint refers to must not change later; its weights may.
    #[must_use]
    pub fn new(
        n_local_raw: usize,
        raw: Vec<u32>,
        constraints: &AffineConstraints,
        couples: impl Fn(usize, usize) -> bool,
    ) -> Self {
        let mut unknowns = CellUnknowns { offsets: vec![0], unknowns: Vec::new() };
        unknowns.unknowns.reserve(raw.len());
        let mut folded = Vec::new();
        let mut folded_index = Vec::with_capacity(raw.len() / n_local_raw);
        let mut largest = n_local_raw * n_local_raw;
        for (cell, raw) in raw.chunks_exact(n_local_raw).enumerate() {
            let cell_folded = unknowns.push(raw, constraints);
            folded_index.push(cell_folded.as_ref().map_or(NOT_FOLDED, |_| to_u32(folded.len())));
            folded.extend(cell_folded);
            largest = largest.max((unknowns.offsets[cell + 1] - unknowns.offsets[cell]).pow(2));
        }
        let pattern = build_pattern(constraints.n_unknowns(), &unknowns, &couples);
        let entries = CellEntries::new(&pattern, &unknowns);
        let pattern = Arc::new(pattern);
        Self { pattern, n_local_raw, raw, entries, folded, folded_index, largest }
    }

    /// The sparsity pattern of the constrained system.
    #[must_use]
    pub fn pattern(&self) -> &Arc<Pattern> {
        &self.pattern
    }

    /// Number of cells.
    #[must_use]
    pub fn n_cells(&self) -> usize {
        self.folded_index.len()
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
        self.folded_index[cell] != NOT_FOLDED
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
        let FoldedCell { n_local, local } = &self.folded[self.folded_index[cell] as usize];
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

    /// Adds a cell's matrix, folded where it has to be, to the stored values.
    pub fn scatter(&self, cell: usize, matrix: &[f64], values: &mut [f64]) {
        self.entries.for_each(cell, |local, entry| values[entry] += matrix[local]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::ConstraintBuilder;

    /// Two one-dimensional cells in a row; the last unknown equals half the first plus one.
    #[test]
    fn scattering_reduced_cells_equals_the_triple_product() {
        let mut builder = ConstraintBuilder::new(3);
        builder.constrain(2, vec![Term { unknown: 0, weight: 0.5 }], 1.0);
        let constraints = builder.build();
        let maps = CellMaps::new(2, vec![0, 1, 1, 2], &constraints, |_, _| true);
        let pattern = maps.pattern();
        // Columns of [[2, -1], [-3, 4]].
        let cell = [2.0, -3.0, -1.0, 4.0];
        let mut values = vec![0.0; pattern.n_entries()];
        let mut folded = vec![0.0; maps.largest_matrix()];
        assert!(!maps.is_folded(0) && maps.is_folded(1));
        maps.scatter(0, &cell, &mut values);
        maps.fold(1, &constraints, &cell, &mut folded);
        maps.scatter(1, &folded, &mut values);
        // Full matrix [[2,-1,0],[-3,6,-1],[0,-3,4]], P = [[1,0],[0,1],[0.5,0]].
        let expected = [[3.0, -2.5], [-3.5, 6.0]];
        for (row, line) in expected.iter().enumerate() {
            for (column, value) in line.iter().enumerate() {
                assert_eq!(values[pattern.entry(row, column).unwrap()], *value);
            }
        }
    }

    /// Velocities with two components in cells that share nodes, pressures and a folded cell.
    #[test]
    fn each_entry_of_a_cell_is_where_its_row_and_column_say() {
        let mut builder = ConstraintBuilder::new(12);
        builder.equate(10, 1);
        builder.fix(4, 1.0);
        let constraints = builder.build();
        let raw: Vec<u32> = vec![0, 2, 1, 3, 8, 2, 6, 3, 7, 9, 4, 6, 5, 10, 11];
        let is_pressure = |unknown: usize| unknown >= 7;
        let couples = |row, column| !(is_pressure(row) && is_pressure(column));
        let maps = CellMaps::new(5, raw.clone(), &constraints, couples);
        for (cell, raw) in raw.chunks_exact(5).enumerate() {
            // Every row of a folded cell has one unknown here
            let unknown = |raw: u32| constraints.row(raw as usize).first().map(|term| term.unknown);
            let mut local: Vec<_> = raw.iter().map(|&raw| unknown(raw)).collect();
            if maps.is_folded(cell) {
                local.retain(Option::is_some);
            }
            let mut expected = Vec::new();
            let pairs = local.iter().flat_map(|column| local.iter().map(move |row| (column, row)));
            for (index, (column, row)) in pairs.enumerate() {
                let entry = column
                    .zip(*row)
                    .and_then(|(column, row)| maps.pattern().entry(row as usize, column as usize));
                expected.extend(entry.map(|entry| (index, entry)));
            }
            let mut entries = Vec::new();
            maps.entries.for_each(cell, |local, entry| entries.push((local, entry)));
            assert_eq!(entries, expected);
        }
    }

    /// Two cells in a row whose last unknown is given.
    #[test]
    fn rows_and_columns_of_given_values_are_not_stored() {
        let mut builder = ConstraintBuilder::new(3);
        builder.fix(2, 5.0);
        let constraints = builder.build();
        let maps = CellMaps::new(2, vec![0, 1, 1, 2], &constraints, |_, _| true);
        let pattern = maps.pattern();
        let cell = [2.0, -3.0, -1.0, 4.0];
        let mut values = vec![0.0; pattern.n_entries()];
        for index in 0..2 {
            assert!(!maps.is_folded(index));
            maps.scatter(index, &cell, &mut values);
        }
        assert_eq!(values, [2.0, -3.0, -1.0, 6.0]);
    }
}
