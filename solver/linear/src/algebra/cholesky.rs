//! Sparse Cholesky factorisation of symmetric positive definite matrices, factorised once, solved often.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltError, LltRegularization};
use faer::mat::MatMut;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, Par, Side};

use thiserror::Error;

use crate::sparse::SparseMatrix;

/// Why there are no Cholesky factors, or no solution with them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum CholeskyError {
    /// A pivot is zero, negative or not a number.
    #[error("the matrix is not positive definite: elimination fails at its pivot {pivot}")]
    NotPositiveDefinite {
        /// Index in the order of elimination.
        pivot: usize,
    },
    /// Memory ran out.
    #[error("memory ran out for the Cholesky factors of a matrix")]
    OutOfMemory,
}

/// The same bits on any number of threads: kernels run on one.
const PARALLELISM: Par = Par::Seq;

/// A = L L^T with the unknowns ordered by approximate minimum degree.
pub struct Cholesky {
    symbolic: SymbolicCholesky<usize>,
    factor: Vec<f64>,
}

impl std::fmt::Debug for Cholesky {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("Cholesky").field("n", &self.n()).finish_non_exhaustive()
    }
}

impl Cholesky {
    /// Factorises a symmetric matrix, of which the lower triangle is read.
    ///
    /// # Errors
    /// When the matrix is not positive definite, or memory runs out.
    pub fn factorise(matrix: &SparseMatrix) -> Result<Self, CholeskyError> {
        let (n, pattern) = (matrix.n(), matrix.pattern());
        // The rows of a symmetric matrix are its columns
        let rows = pattern.columns();
        let view = SymbolicSparseColMatRef::new_checked(n, n, pattern.starts(), None, &rows);
        let symbolic = factorize_symbolic_cholesky(
            view,
            Side::Lower,
            SymmetricOrdering::Amd,
            CholeskySymbolicParams::default(),
        )
        .map_err(|_| CholeskyError::OutOfMemory)?;
        let mut factor = vec![0.0; symbolic.len_val()];
        let need = symbolic.factorize_numeric_llt_scratch::<f64>(PARALLELISM, Default::default());
        let mut workspace = MemBuffer::try_new(need).map_err(|_| CholeskyError::OutOfMemory)?;
        symbolic
            .factorize_numeric_llt::<f64>(
                &mut factor,
                SparseColMatRef::new(view, matrix.values()),
                Side::Lower,
                LltRegularization::default(),
                PARALLELISM,
                MemStack::new(&mut workspace),
                Default::default(),
            )
            .map_err(|LltError::NonPositivePivot { index }| CholeskyError::NotPositiveDefinite {
                pivot: index,
            })?;
        Ok(Self { symbolic, factor })
    }

    /// Number of unknowns.
    #[must_use]
    pub fn n(&self) -> usize {
        self.symbolic.nrows()
    }

    /// Entries of the factor.
    #[must_use]
    pub fn n_entries(&self) -> usize {
        self.factor.len()
    }

    /// Overwrites right-hand sides, one after the other in `rhs`, with their solutions.
    ///
    /// # Errors
    /// When memory runs out.
    pub fn solve(&self, rhs: &mut [f64]) -> Result<(), CholeskyError> {
        let n = self.n();
        if n == 0 {
            return Ok(());
        }
        let count = rhs.len() / n;
        let need = self.symbolic.solve_in_place_scratch::<f64>(count, PARALLELISM);
        let mut workspace = MemBuffer::try_new(need).map_err(|_| CholeskyError::OutOfMemory)?;
        LltRef::new(&self.symbolic, &self.factor).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(&mut rhs[..n * count], n, count),
            PARALLELISM,
            MemStack::new(&mut workspace),
        );
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sparse::Pattern;

    /// The matrix of -u'' on n points with `shift` on its diagonal.
    fn chain(n: usize, shift: f64) -> SparseMatrix {
        let columns = |row: usize| row.saturating_sub(1)..(row + 2).min(n);
        let value = |row, column| if row == column { 2.0 + shift } else { -1.0 };
        let of_row = |row| columns(row).map(move |column| value(row, column));
        let values = (0..n).flat_map(of_row).collect();
        SparseMatrix::new(Pattern::from_rows((0..n).map(columns)), values)
    }

    #[test]
    fn several_right_hand_sides_are_solved_at_once() {
        let matrix = chain(40, 0.0);
        let cholesky = Cholesky::factorise(&matrix).unwrap();
        let exact: Vec<f64> = (0..80).map(|i| f64::from(i).sin()).collect();
        let mut sides = vec![0.0; 80];
        for (x, b) in exact.chunks(40).zip(sides.chunks_mut(40)) {
            matrix.multiply(x, b);
        }
        cholesky.solve(&mut sides).unwrap();
        for (found, wanted) in sides.iter().zip(&exact) {
            assert!((found - wanted).abs() < 1e-12);
        }
    }

    #[test]
    fn a_matrix_that_is_not_positive_definite_is_refused() {
        let error = Cholesky::factorise(&chain(20, -1.0)).err();
        assert!(matches!(error, Some(CholeskyError::NotPositiveDefinite { .. })), "{error:?}");
    }
}
