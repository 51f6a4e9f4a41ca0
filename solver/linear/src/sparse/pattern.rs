//! `Pattern`: the sparsity pattern of a square matrix, by compressed columns.

use std::ops::Range;

use super::index::to_u32;

/// Compressed columns of a square sparse matrix; rows sorted within a column.
///
/// Columns that follow each other and have entries in the same rows, as those of the velocities at one node,
/// share one list of rows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pattern {
    /// Start of the stored entries of each column, and the end of the last: n + 1 numbers.
    starts: Vec<usize>,
    /// Start of the rows of each column in `rows`.
    lists: Vec<usize>,
    /// Lists of rows.
    rows: Vec<u32>,
}

impl Default for Pattern {
    fn default() -> Self {
        Self { starts: vec![0], lists: Vec::new(), rows: Vec::new() }
    }
}

impl Pattern {
    /// Of the rows of the stored entries of each column, which ascend.
    #[must_use]
    pub fn from_columns<C: IntoIterator<Item = usize>>(
        columns: impl IntoIterator<Item = C>,
    ) -> Self {
        let mut pattern = Self::default();
        let mut rows = Vec::new();
        for column in columns {
            rows.clear();
            rows.extend(column.into_iter().map(to_u32));
            pattern.push(&rows);
        }
        pattern.shrink();
        pattern
    }

    /// Appends a column with entries in these rows, which ascend.
    pub(crate) fn push(&mut self, rows: &[u32]) {
        let is_like_last = self.n() > 0 && self.column(self.n() - 1) == rows;
        let end = self.n_entries() + rows.len();
        if is_like_last {
            self.lists.extend(self.lists.last().copied());
        } else {
            self.lists.push(self.rows.len());
            self.rows.extend_from_slice(rows);
        }
        self.starts.push(end);
    }

    /// Gives back the memory that no more columns will take.
    pub(crate) fn shrink(&mut self) {
        self.rows.shrink_to_fit();
    }

    /// Number of unknowns.
    #[must_use]
    pub fn n(&self) -> usize {
        self.lists.len()
    }

    /// Number of stored entries.
    #[must_use]
    pub fn n_entries(&self) -> usize {
        self.starts[self.n()]
    }

    /// Start of the stored entries of each column, and the end of the last: n + 1 numbers.
    #[must_use]
    pub fn starts(&self) -> &[usize] {
        &self.starts
    }

    /// The stored entries of a column.
    #[must_use]
    pub fn entries(&self, column: usize) -> Range<usize> {
        self.starts[column]..self.starts[column + 1]
    }

    /// The rows of the stored entries of a column.
    #[must_use]
    pub fn column(&self, column: usize) -> &[u32] {
        let start = self.lists[column];
        &self.rows[start..start + self.entries(column).len()]
    }

    /// The rows of all stored entries, column by column.
    #[must_use]
    pub fn rows(&self) -> Vec<usize> {
        let columns = (0..self.n()).flat_map(|column| self.column(column));
        columns.map(|&row| row as usize).collect()
    }

    /// Whether a column has entries in the same rows as the one before.
    #[must_use]
    pub fn is_like_last(&self, column: usize) -> bool {
        column > 0
            && self.lists[column] == self.lists[column - 1]
            && self.entries(column).len() == self.entries(column - 1).len()
    }

    /// Index of entry (row, column) among the stored ones, if it is one of them.
    #[must_use]
    pub fn entry(&self, row: usize, column: usize) -> Option<usize> {
        let row = u32::try_from(row).ok()?;
        let start = self.starts[column];
        self.column(column).binary_search(&row).ok().map(|offset| start + offset)
    }

    /// y += A x for the matrix A with some values.
    pub fn multiply_add(&self, values: &[f64], x: &[f64], y: &mut [f64]) {
        for (column, &factor) in x.iter().enumerate() {
            for (&row, value) in self.column(column).iter().zip(&values[self.entries(column)]) {
                y[row as usize] += value * factor;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_that_are_alike_share_their_rows() {
        let columns = [vec![0, 2], vec![0, 2], vec![], vec![0, 2], vec![1]];
        let pattern = Pattern::from_columns(columns.clone());
        for (column, rows) in columns.iter().enumerate() {
            assert!(pattern.column(column).iter().map(|&row| row as usize).eq(rows.clone()));
        }
        assert_eq!(pattern.starts(), [0, 2, 4, 4, 6, 7]);
        assert_eq!(pattern.rows(), [0, 2, 0, 2, 0, 2, 1]);
        assert_eq!(pattern.rows.len(), 5);
        let alike: Vec<bool> = (0..5).map(|column| pattern.is_like_last(column)).collect();
        assert_eq!(alike, [false, true, false, false, false]);
        assert_eq!((pattern.entry(2, 3), pattern.entry(1, 3)), (Some(5), None));
    }
}
