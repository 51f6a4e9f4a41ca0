//! `SparseMatrix`: values on a sparsity pattern, with a revision for each state of them.

use std::sync::Arc;

use rayon::prelude::*;

use super::pattern::Pattern;

/// Rows of a product that a thread takes at a time.
const ROWS_PER_TASK: usize = 1024;
/// Sums side by side in a row.
const LANES: usize = 4;

/// A state of the values of one matrix: equal revisions mean equal values.
#[derive(Debug, Clone)]
pub struct Revision {
    /// The same for all revisions of one matrix, another one for every other matrix.
    matrix: Arc<()>,
    /// How often the values were handed out to be changed.
    number: u64,
}

impl Default for Revision {
    /// Of another matrix than all so far.
    fn default() -> Self {
        Self { matrix: Arc::new(()), number: 0 }
    }
}

impl Revision {
    /// The next state of the same matrix.
    pub(crate) fn advance(&mut self) {
        self.number += 1;
    }
}

impl PartialEq for Revision {
    fn eq(&self, other: &Self) -> bool {
        self.number == other.number && Arc::ptr_eq(&self.matrix, &other.matrix)
    }
}

/// A square sparse matrix by compressed rows.
#[derive(Debug)]
pub struct SparseMatrix {
    pattern: Arc<Pattern>,
    values: Vec<f64>,
    revision: Revision,
}

impl SparseMatrix {
    /// A matrix with the value of each stored entry, in the order of the pattern.
    ///
    /// # Panics
    /// When the number of values is not that of the pattern's entries.
    #[must_use]
    pub fn new(pattern: impl Into<Arc<Pattern>>, values: Vec<f64>) -> Self {
        let pattern = pattern.into();
        assert_eq!(values.len(), pattern.n_entries(), "a value for each entry of the pattern");
        Self { pattern, values, revision: Revision::default() }
    }

    /// A matrix whose stored entries are all zero.
    #[must_use]
    pub fn zeros(pattern: impl Into<Arc<Pattern>>) -> Self {
        let pattern = pattern.into();
        let values = vec![0.0; pattern.n_entries()];
        Self::new(pattern, values)
    }

    /// Another matrix with the same values.
    #[must_use]
    pub fn copied(&self) -> Self {
        Self::new(Arc::clone(&self.pattern), self.values.clone())
    }

    /// Which entries are stored.
    #[must_use]
    pub fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    /// The same, shared.
    #[must_use]
    pub fn shared_pattern(&self) -> Arc<Pattern> {
        Arc::clone(&self.pattern)
    }

    /// Number of unknowns.
    #[must_use]
    pub fn n(&self) -> usize {
        self.pattern.n()
    }

    /// The values of the stored entries.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The values of the stored entries, to be changed: the matrix gets another revision.
    #[must_use]
    pub fn values_mut(&mut self) -> &mut [f64] {
        self.revision.advance();
        &mut self.values
    }

    /// Adds to an entry, if it is stored.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        if let Some(entry) = self.pattern.entry(row, column) {
            self.values_mut()[entry] += value;
        }
    }

    /// The state of the values.
    #[must_use]
    pub fn revision(&self) -> &Revision {
        &self.revision
    }

    /// y = A x.
    ///
    /// # Panics
    /// When a vector has another length.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        assert_eq!([x.len(), y.len()], [self.n(); 2], "a value for each unknown");
        y.par_chunks_mut(ROWS_PER_TASK).enumerate().for_each(|(task, y)| {
            let (first, mut done) = (task * ROWS_PER_TASK, 0);
            while done < y.len() {
                let row = first + done;
                if done + 1 < y.len() && self.pattern.is_like_last(row + 1) {
                    [y[done], y[done + 1]] = self.products_of_two(row, x);
                    done += 2;
                } else {
                    y[done] = self.sum_of_terms(row, x, |term| term);
                    done += 1;
                }
            }
        });
    }

    /// |A| |x|: the sum of the absolute values of the terms of each row of A x.
    #[must_use]
    pub fn absolute_product(&self, x: &[f64]) -> Vec<f64> {
        let mut sums = vec![0.0; self.n()];
        sums.par_chunks_mut(ROWS_PER_TASK).enumerate().for_each(|(task, sums)| {
            for (row, sum) in (task * ROWS_PER_TASK..).zip(sums) {
                *sum = self.sum_of_terms(row, x, f64::abs);
            }
        });
        sums
    }

    /// The residual of A x = b.
    #[must_use]
    pub fn residual(&self, x: &[f64], b: &[f64]) -> Residual {
        let mut defect = b.to_vec();
        let mut size = vec![0.0; b.len()];
        let sizes = size.par_chunks_mut(ROWS_PER_TASK);
        defect.par_chunks_mut(ROWS_PER_TASK).zip(sizes).enumerate().for_each(
            |(task, (defect, size))| {
                // Both sums of a row while its entries are at hand
                for (row, (defect, size)) in
                    (task * ROWS_PER_TASK..).zip(defect.iter_mut().zip(size))
                {
                    *size = self.sum_of_terms(row, x, f64::abs) + defect.abs();
                    *defect -= self.sum_of_terms(row, x, |term| term);
                }
            },
        );
        Residual { defect, size }
    }

    /// The residual of A^T x = b.
    #[must_use]
    pub fn transposed_residual(&self, x: &[f64], b: &[f64]) -> Residual {
        let mut defect = b.to_vec();
        let mut size: Vec<f64> = b.iter().map(|value| value.abs()).collect();
        for (row, x) in x.iter().enumerate() {
            let entries = self.values[self.pattern.entries(row)].iter();
            for (value, &column) in entries.zip(self.pattern.row(row)) {
                let term = value * x;
                defect[column as usize] -= term;
                size[column as usize] += term.abs();
            }
        }
        Residual { defect, size }
    }

    /// A row of A x and the next, which has entries in the same columns, as the velocities at a node: each
    /// value of x is read once. The bits are those of [`Self::sum_of_terms`].
    #[inline(always)]
    fn products_of_two(&self, row: usize, x: &[f64]) -> [f64; 2] {
        let columns = self.pattern.row(row);
        let one = &self.values[self.pattern.entries(row)][..columns.len()];
        let other = &self.values[self.pattern.entries(row + 1)][..columns.len()];
        let mut sums = [[0.0; LANES]; 2];
        let n_lanes = columns.len() / LANES * LANES;
        for start in (0..n_lanes).step_by(LANES) {
            for lane in 0..LANES {
                let value = x[columns[start + lane] as usize];
                sums[0][lane] += one[start + lane] * value;
                sums[1][lane] += other[start + lane] * value;
            }
        }
        let mut rest = [0.0; 2];
        for index in n_lanes..columns.len() {
            let value = x[columns[index] as usize];
            rest[0] += one[index] * value;
            rest[1] += other[index] * value;
        }
        [sums[0].iter().sum::<f64>() + rest[0], sums[1].iter().sum::<f64>() + rest[1]]
    }

    /// The sum of what `of` makes of each term of a row of A x.
    #[inline(always)]
    fn sum_of_terms(&self, row: usize, x: &[f64], of: impl Fn(f64) -> f64) -> f64 {
        let term = |column: u32, value: f64| of(value * x[column as usize]);
        let columns = self.pattern.row(row).chunks_exact(LANES);
        let values = self.values[self.pattern.entries(row)].chunks_exact(LANES);
        let rest = columns.remainder().iter().zip(values.remainder());
        let rest: f64 = rest.map(|(&column, &value)| term(column, value)).sum();
        let mut sums = [0.0; LANES];
        for (columns, values) in columns.zip(values) {
            for lane in 0..LANES {
                sums[lane] += term(columns[lane], values[lane]);
            }
        }
        sums.iter().sum::<f64>() + rest
    }
}

/// What a trial solution x of A x = b leaves.
#[derive(Debug, Clone, PartialEq)]
pub struct Residual {
    /// b - A x.
    pub defect: Vec<f64>,
    /// |A| |x| + |b|: the sum of the absolute values of the terms of each row.
    pub size: Vec<f64>,
}

impl Residual {
    /// Largest entry of the defect over the largest of the sums of absolute terms; NaN where an entry
    /// is.
    #[must_use]
    pub fn relative(&self) -> f64 {
        if self.defect.iter().any(|value| value.is_nan()) {
            return f64::NAN;
        }
        let largest =
            |values: &[f64]| values.iter().fold(0.0f64, |most, value| most.max(value.abs()));
        let (defect, size) = (largest(&self.defect), largest(&self.size));
        if size > 0.0 { defect / size } else { defect }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// [[2, 1], [0, 4]].
    fn matrix() -> SparseMatrix {
        SparseMatrix::new(Pattern::from_rows([vec![0, 1], vec![1]]), vec![2.0, 1.0, 4.0])
    }

    #[test]
    fn a_change_gives_a_revision_of_its_own() {
        let mut one = matrix();
        let first = one.revision().clone();
        assert_eq!(first, *one.revision());
        one.values_mut()[0] = 3.0;
        assert_ne!(first, *one.revision());
    }

    #[test]
    fn equal_numbers_of_changes_do_not_make_matrices_equal() {
        assert_ne!(matrix().revision(), matrix().revision());
    }

    #[test]
    fn products_and_residuals_are_those_of_the_dense_matrix() {
        let matrix = matrix();
        let x = [1.0, -3.0];
        let mut y = vec![10.0, 0.0];
        matrix.multiply(&x, &mut y);
        assert_eq!(y, [-1.0, -12.0]);
        assert_eq!(matrix.absolute_product(&x), [5.0, 12.0]);
        // Two rows with the same columns are worked on together
        let alike = Pattern::from_rows([vec![0, 1], vec![0, 1]]);
        SparseMatrix::new(alike, vec![2.0, 1.0, 5.0, 4.0]).multiply(&x, &mut y);
        assert_eq!(y, [-1.0, -7.0]);
        let residual = matrix.residual(&x, &[0.0, -8.0]);
        assert_eq!(residual.defect, [1.0, 4.0]);
        assert_eq!(residual.size, [5.0, 20.0]);
        assert_eq!(residual.relative(), 0.2);
        assert!(matrix.residual(&[f64::NAN, 0.0], &[0.0; 2]).relative().is_nan());
    }
}
