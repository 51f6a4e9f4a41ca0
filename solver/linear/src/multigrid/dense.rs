//! Inverses of small dense matrices.

use crate::sparse::single::single;

/// Pivots below this fraction of the largest entry count as zero.
const SINGULAR: f64 = 1e-12;

/// Overwrites an n x n matrix with its inverse, by Gauss-Jordan elimination with pivots from the whole
/// column. Returns false, and leaves numbers without a meaning, when the matrix is singular.
///
/// Rows and columns may be exchanged: the transposed inverse is the inverse of the transposed matrix.
pub(super) fn invert(n: usize, matrix: &mut [f64]) -> bool {
    let floor = SINGULAR * matrix.iter().fold(0.0f64, |most, value| most.max(value.abs()));
    let mut exchanged = Vec::with_capacity(n);
    let mut pivot_row = vec![0.0; n];
    for step in 0..n {
        let size = |row: &usize| matrix[row * n + step].abs();
        let pivot = (step..n).max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(step);
        if size(&pivot) <= floor {
            return false;
        }
        exchanged.push(pivot);
        for column in 0..n {
            matrix.swap(pivot * n + column, step * n + column);
        }
        let inverse = 1.0 / matrix[step * n + step];
        matrix[step * n + step] = 1.0;
        for (kept, value) in pivot_row.iter_mut().zip(&mut matrix[step * n..(step + 1) * n]) {
            *value *= inverse;
            *kept = *value;
        }
        for row in (0..n).filter(|&row| row != step) {
            let line = &mut matrix[row * n..(row + 1) * n];
            let factor = std::mem::replace(&mut line[step], 0.0);
            if factor != 0.0 {
                for (value, kept) in line.iter_mut().zip(&pivot_row) {
                    *value -= factor * kept;
                }
            }
        }
    }
    for (step, pivot) in exchanged.into_iter().enumerate().rev() {
        for row in 0..n {
            matrix.swap(row * n + step, row * n + pivot);
        }
    }
    matrix.iter().all(|value| value.is_finite())
}

/// Multiplies each row and each column by its factor.
fn multiply(factors: &[f64], matrix: &mut [f64]) {
    for (row, factor) in matrix.chunks_exact_mut(factors.len().max(1)).zip(factors) {
        for (value, other) in row.iter_mut().zip(factors) {
            *value *= factor * other;
        }
    }
}

/// The inverse of a dense matrix in single precision, row by row.
#[derive(Debug)]
pub(super) struct DenseInverse {
    n: usize,
    values: Vec<f32>,
}

impl DenseInverse {
    /// The inverse of an n x n matrix, row by row; none of a singular one.
    ///
    /// Rows and columns are scaled by their diagonal first: cells may differ in size by many orders.
    pub fn new(n: usize, mut matrix: Vec<f64>) -> Option<Self> {
        let scale = |index: usize| {
            let diagonal = matrix[index * n + index].abs();
            if diagonal > 0.0 { 1.0 / diagonal.sqrt() } else { 1.0 }
        };
        let scales: Vec<f64> = (0..n).map(scale).collect();
        multiply(&scales, &mut matrix);
        let is_regular = invert(n, &mut matrix);
        multiply(&scales, &mut matrix);
        is_regular.then(|| Self { n, values: matrix.into_iter().map(single).collect() })
    }

    /// Overwrites x with A^-1 b.
    pub fn apply(&self, b: &[f32], x: &mut [f32]) {
        for (x, row) in x.iter_mut().zip(self.values.chunks_exact(self.n.max(1))) {
            *x = row.iter().zip(b).map(|(a, b)| a * b).sum();
        }
    }
}
