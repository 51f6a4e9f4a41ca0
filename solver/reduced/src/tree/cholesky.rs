//! Cholesky factors of small dense matrices of any kind of number.

use super::spatial::Number;

/// Pivots smaller than this, of their diagonal entry, are none.
const NO_PIVOT: f64 = 1e-13;

/// Overwrites the lower triangle of a symmetric matrix, by rows, with its factor L.
///
/// # Errors
/// The row whose pivot is not positive.
pub(super) fn factor<T: Number>(matrix: &mut [T], n: usize) -> Result<(), usize> {
    for j in 0..n {
        let (done, rest) = matrix.split_at_mut(j * n);
        let row = &mut rest[..=j];
        for i in 0..j {
            let other = &done[i * n..=i * n + i];
            let mut sum = row[i];
            for k in 0..i {
                sum -= row[k] * other[k];
            }
            row[i] = sum / other[i];
        }
        let diagonal = row[j];
        let mut pivot = diagonal;
        for k in 0..j {
            pivot -= row[k] * row[k];
        }
        // Not a number is no pivot either
        if pivot.re().is_nan() || pivot.re() <= NO_PIVOT * diagonal.re().abs() {
            return Err(j);
        }
        row[j] = pivot.sqrt();
    }
    Ok(())
}

/// Solves with a factor in place.
pub(super) fn solve<T: Number>(factor: &[T], right: &mut [T]) {
    let n = right.len();
    for j in 0..n {
        let mut sum = right[j];
        for k in 0..j {
            sum -= factor[j * n + k] * right[k];
        }
        right[j] = sum / factor[j * n + j];
    }
    for j in (0..n).rev() {
        let mut sum = right[j];
        for k in j + 1..n {
            sum -= factor[k * n + j] * right[k];
        }
        right[j] = sum / factor[j * n + j];
    }
}
