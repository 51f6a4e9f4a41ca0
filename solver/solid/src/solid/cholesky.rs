//! `Cholesky`: sparse factors of symmetric matrices, by faer, in one thread: the same bits each time.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

use super::SolidError;
use super::pattern::Pattern;

/// The order of elimination and the pattern of the factors, for all matrices of a pattern.
#[derive(Debug)]
pub struct Cholesky {
    symbolic: SymbolicCholesky<usize>,
}

/// Factors L L^T of a positive definite matrix.
#[derive(Debug, Clone)]
pub struct Factor {
    values: Vec<f64>,
}

impl Cholesky {
    /// Analyses a pattern.
    ///
    /// # Errors
    /// [`SolidError::Singular`] where memory is short.
    pub fn new(pattern: &Pattern) -> Result<Self, SolidError> {
        let n = pattern.n_unknowns();
        let matrix =
            SymbolicSparseColMatRef::new_checked(n, n, &pattern.starts, None, &pattern.rows);
        let symbolic = factorize_symbolic_cholesky(
            matrix,
            Side::Lower,
            SymmetricOrdering::Amd,
            CholeskySymbolicParams::default(),
        );
        Ok(Self { symbolic: symbolic.map_err(|_| SolidError::Singular)? })
    }

    /// Factors of a matrix by the values of its entries; none where it is not positive definite.
    #[must_use]
    pub fn factorise(&self, pattern: &Pattern, values: &[f64]) -> Option<Factor> {
        let n = pattern.n_unknowns();
        let symbolic =
            SymbolicSparseColMatRef::new_checked(n, n, &pattern.starts, None, &pattern.rows);
        let matrix = SparseColMatRef::new(symbolic, values);
        let mut factor = vec![0.0; self.symbolic.len_val()];
        let scratch =
            self.symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default());
        let mut memory = MemBuffer::new(scratch);
        let done = self.symbolic.factorize_numeric_llt(
            &mut factor,
            matrix,
            Side::Lower,
            Default::default(),
            Par::Seq,
            MemStack::new(&mut memory),
            Default::default(),
        );
        done.ok()?;
        factor.iter().all(|value| value.is_finite()).then_some(Factor { values: factor })
    }

    /// Solves with factors, in place.
    pub fn solve(&self, factor: &Factor, right: &mut [f64]) {
        let n = right.len();
        let scratch = self.symbolic.solve_in_place_scratch::<f64>(1, Par::Seq);
        let mut memory = MemBuffer::new(scratch);
        LltRef::new(&self.symbolic, &factor.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(right, n, 1),
            Par::Seq,
            MemStack::new(&mut memory),
        );
    }
}
