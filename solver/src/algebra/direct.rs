//! Sparse LU with its symbolic part reused while the pattern lasts, and iterative refinement.

use faer::Par;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::mat::MatMut;
use faer::sparse::linalg::lu::{
    LuRef, LuSymbolicParams, NumericLu, SymbolicLu, factorize_symbolic_lu,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use thiserror::Error;

use super::Pattern;

/// The matrix has no inverse, or none that double precision can find.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{0}")]
pub struct SingularMatrix(pub String);

/// A sparse LU factorisation (faer's, with its column ordering).
pub struct DirectSolver {
    symbolic: SymbolicLu<usize>,
    numeric: NumericLu<usize, f64>,
    workspace: MemBuffer,
}

impl std::fmt::Debug for DirectSolver {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("DirectSolver").finish_non_exhaustive()
    }
}

/// The same bits on any number of threads: kernels run on one.
const PARALLELISM: Par = Par::Seq;

fn symbolic_view(pattern: &Pattern) -> SymbolicSparseColMatRef<'_, usize> {
    SymbolicSparseColMatRef::new_checked(
        pattern.n(),
        pattern.n(),
        &pattern.columns,
        None,
        &pattern.rows,
    )
}

impl DirectSolver {
    /// Orders the columns and finds the fill of a pattern.
    ///
    /// # Errors
    /// When memory runs out.
    pub fn analyse(pattern: &Pattern) -> Result<Self, SingularMatrix> {
        let symbolic = factorize_symbolic_lu(symbolic_view(pattern), LuSymbolicParams::default())
            .map_err(|error| SingularMatrix(format!("the analysis failed: {error:?}")))?;
        let factor = symbolic.factorize_numeric_lu_scratch::<f64>(PARALLELISM, Default::default());
        let solve = symbolic.solve_in_place_scratch::<f64>(1, PARALLELISM);
        let workspace = MemBuffer::try_new(factor.or(solve))
            .map_err(|_| SingularMatrix("memory ran out in the analysis".to_owned()))?;
        Ok(Self { symbolic, numeric: NumericLu::new(), workspace })
    }

    /// Factorises the matrix with these values.
    ///
    /// # Errors
    /// When a pivot vanishes.
    pub fn factorise(&mut self, pattern: &Pattern, values: &[f64]) -> Result<(), SingularMatrix> {
        let matrix = SparseColMatRef::new(symbolic_view(pattern), values);
        self.symbolic
            .factorize_numeric_lu(
                &mut self.numeric,
                matrix,
                PARALLELISM,
                MemStack::new(&mut self.workspace),
                Default::default(),
            )
            .map(|_| ())
            .map_err(|error| SingularMatrix(format!("a pivot vanished: {error:?}")))
    }

    /// Solves A x = b with up to two steps of iterative refinement, in place.
    ///
    /// Returns the residual, largest entry of |b - A x| over largest of |A| |x| + |b|.
    ///
    /// # Errors
    /// When the residual stays above 1e-6 or is not a number.
    pub fn solve(
        &mut self,
        pattern: &Pattern,
        values: &[f64],
        rhs: &mut [f64],
    ) -> Result<f64, SingularMatrix> {
        let target = rhs.to_vec();
        self.apply(rhs);
        let mut residual = f64::INFINITY;
        for _ in 0..3 {
            let (mut defect, scale) = defect(pattern, values, rhs, &target);
            let size = defect.iter().fold(0.0f64, |most, value| most.max(value.abs()));
            let next = if scale > 0.0 { size / scale } else { size };
            if next.is_nan() {
                return Err(SingularMatrix("the solution is not a number".to_owned()));
            }
            // Refinement that no longer helps has reached rounding.
            if next <= 1e-15 || next > 0.5 * residual {
                residual = residual.min(next);
                break;
            }
            residual = next;
            self.apply(&mut defect);
            for (value, correction) in rhs.iter_mut().zip(&defect) {
                *value += correction;
            }
        }
        if residual > 1e-6 {
            return Err(SingularMatrix(format!(
                "the solution leaves a relative residual of {residual:.1e}"
            )));
        }
        Ok(residual)
    }

    fn apply(&mut self, rhs: &mut [f64]) {
        let n = rhs.len();
        LuRef::new_unchecked(&self.symbolic, &self.numeric).solve_in_place_with_conj(
            faer::Conj::No,
            MatMut::from_column_major_slice_mut(rhs, n, 1),
            PARALLELISM,
            MemStack::new(&mut self.workspace),
        );
    }
}

/// b - A x, and the largest entry of |A| |x| + |b|.
fn defect(pattern: &Pattern, values: &[f64], x: &[f64], b: &[f64]) -> (Vec<f64>, f64) {
    let mut rest = b.to_vec();
    let mut scale: Vec<f64> = b.iter().map(|value| value.abs()).collect();
    for (column, &factor) in x.iter().enumerate() {
        for entry in pattern.columns[column]..pattern.columns[column + 1] {
            let product = values[entry] * factor;
            rest[pattern.rows[entry]] -= product;
            scale[pattern.rows[entry]] += product.abs();
        }
    }
    (rest, scale.into_iter().fold(0.0, f64::max))
}
