//! `Pattern`: the sparsity pattern of a square matrix, by compressed rows.

use std::ops::Range;

use super::index::to_u32;

/// Compressed rows of a square sparse matrix; columns sorted within a row.
///
/// Rows that follow each other and have entries in the same columns, as those of the velocities at one node,
/// share one list of columns.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pattern {
    /// Start of the stored entries of each row, and the end of the last: n + 1 numbers.
    starts: Vec<usize>,
    /// Start of the columns of each row in `columns`.
    lists: Vec<usize>,
    /// Lists of columns.
    columns: Vec<u32>,
}

impl Default for Pattern {
    fn default() -> Self {
        Self { starts: vec![0], lists: Vec::new(), columns: Vec::new() }
    }
}

impl Pattern {
    /// Of the columns of the stored entries of each row, which ascend.
    #[must_use]
    pub fn from_rows<R: IntoIterator<Item = usize>>(rows: impl IntoIterator<Item = R>) -> Self {
        let mut pattern = Self::default();
        let mut columns = Vec::new();
        for row in rows {
            columns.clear();
            columns.extend(row.into_iter().map(to_u32));
            pattern.push(&columns);
        }
        pattern.shrink();
        pattern
    }

    /// Appends a row with entries in these columns, which ascend.
    pub(crate) fn push(&mut self, columns: &[u32]) {
        let is_like_last = self.n() > 0 && self.row(self.n() - 1) == columns;
        let end = self.n_entries() + columns.len();
        if is_like_last {
            self.lists.extend(self.lists.last().copied());
        } else {
            self.lists.push(self.columns.len());
            self.columns.extend_from_slice(columns);
        }
        self.starts.push(end);
    }

    /// Gives back the memory that no more rows will take.
    pub(crate) fn shrink(&mut self) {
        self.columns.shrink_to_fit();
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

    /// Start of the stored entries of each row, and the end of the last: n + 1 numbers.
    #[must_use]
    pub fn starts(&self) -> &[usize] {
        &self.starts
    }

    /// The stored entries of a row.
    #[must_use]
    pub fn entries(&self, row: usize) -> Range<usize> {
        self.starts[row]..self.starts[row + 1]
    }

    /// The columns of the stored entries of a row.
    #[must_use]
    pub fn row(&self, row: usize) -> &[u32] {
        let start = self.lists[row];
        &self.columns[start..start + self.entries(row).len()]
    }

    /// The columns of all stored entries, row by row.
    #[must_use]
    pub fn columns(&self) -> Vec<usize> {
        let rows = (0..self.n()).flat_map(|row| self.row(row));
        rows.map(|&column| column as usize).collect()
    }

    /// Whether a row has entries in the same columns as the one before.
    #[must_use]
    pub fn is_like_last(&self, row: usize) -> bool {
        row > 0
            && self.lists[row] == self.lists[row - 1]
            && self.entries(row).len() == self.entries(row - 1).len()
    }

    /// Index of entry (row, column) among the stored ones, if it is one of them.
    #[must_use]
    pub fn entry(&self, row: usize, column: usize) -> Option<usize> {
        let column = u32::try_from(column).ok()?;
        let start = self.starts[row];
        self.row(row).binary_search(&column).ok().map(|offset| start + offset)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_that_are_alike_share_their_columns() {
        let rows = [vec![0, 2], vec![0, 2], vec![], vec![0, 2], vec![1]];
        let pattern = Pattern::from_rows(rows.clone());
        for (row, columns) in rows.iter().enumerate() {
            assert!(pattern.row(row).iter().map(|&column| column as usize).eq(columns.clone()));
        }
        assert_eq!(pattern.starts(), [0, 2, 4, 4, 6, 7]);
        assert_eq!(pattern.columns(), [0, 2, 0, 2, 0, 2, 1]);
        assert_eq!(pattern.columns.len(), 5);
        let alike: Vec<bool> = (0..5).map(|row| pattern.is_like_last(row)).collect();
        assert_eq!(alike, [false, true, false, false, false]);
        assert_eq!((pattern.entry(3, 2), pattern.entry(3, 1)), (Some(5), None));
    }
}
