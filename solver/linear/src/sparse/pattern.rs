//! `Pattern`: the sparsity pattern of a square matrix, by compressed columns.

use std::ops::Range;

/// Compressed columns of a square sparse matrix; rows sorted within a column.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pattern {
    /// Start of each column in `rows`, and the end of the last: n + 1 numbers.
    pub columns: Vec<usize>,
    /// Row of each stored entry.
    pub rows: Vec<usize>,
}

impl Pattern {
    /// Number of unknowns.
    #[must_use]
    pub fn n(&self) -> usize {
        self.columns.len() - 1
    }

    /// Number of stored entries.
    #[must_use]
    pub fn n_entries(&self) -> usize {
        self.rows.len()
    }

    /// The stored entries of a column.
    #[must_use]
    pub fn entries(&self, column: usize) -> Range<usize> {
        self.columns[column]..self.columns[column + 1]
    }

    /// The rows of the stored entries of a column.
    #[must_use]
    pub fn column(&self, column: usize) -> &[usize] {
        &self.rows[self.entries(column)]
    }

    /// Index of entry (row, column) among the stored ones, if it is one of them.
    #[must_use]
    pub fn entry(&self, row: usize, column: usize) -> Option<usize> {
        let start = self.columns[column];
        self.column(column).binary_search(&row).ok().map(|offset| start + offset)
    }

    /// y += A x for the matrix A with some values.
    pub fn multiply_add(&self, values: &[f64], x: &[f64], y: &mut [f64]) {
        for (column, &factor) in x.iter().enumerate() {
            for entry in self.entries(column) {
                y[self.rows[entry]] += values[entry] * factor;
            }
        }
    }
}
