//! Sparse LU with its symbolic part reused while the pattern lasts, and iterative refinement.
//!
//! A few unknowns may be bordered: kept out of the sparse factorisation because their rows or
//! columns are dense, which would fill it. The rigid velocities of a body touch all cells at its
//! surface, and that of a travelling frame the convection of every cell. With A split into the
//! inner block K, the border's columns C, rows R and corner D,
//! (D - R K^-1 C) z = g - R K^-1 f and x = K^-1 (f - C z).

use faer::Par;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::mat::MatMut;
use faer::sparse::linalg::LuError;
use faer::sparse::linalg::lu::{
    LuRef, LuSymbolicParams, NumericLu, SymbolicLu, factorize_symbolic_lu,
};
use faer::sparse::{FaerError, SparseColMatRef, SymbolicSparseColMatRef};
use nalgebra::{DMatrix, DVector};
use thiserror::Error;

use super::Pattern;

/// The matrix has no inverse, or none that double precision can find.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{0}")]
pub struct SingularMatrix(pub String);

/// Most refinement steps of one solve.
const MAX_REFINEMENTS: usize = 3;
/// Residual, relative to |A| |x| + |b|, at which refinement has nothing left to do.
const ROUNDING: f64 = 1e-15;
/// Residual above which a solution is worth nothing.
const USELESS: f64 = 1e-6;
/// The same bits on any number of threads: kernels run on one.
const PARALLELISM: Par = Par::Seq;

/// A sparse LU factorisation (faer's, with its column ordering) with a dense border.
pub struct DirectSolver {
    inner: InnerLu,
    /// Unknowns of the inner block, in order.
    kept: Vec<usize>,
    /// Where each entry of the inner block is stored in the full matrix.
    sources: Vec<usize>,
    inner_values: Vec<f64>,
    border: Option<Border>,
}

impl std::fmt::Debug for DirectSolver {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("DirectSolver").field("n", &self.kept.len()).finish_non_exhaustive()
    }
}

/// The dense part of the factorisation.
struct Border {
    unknowns: Vec<usize>,
    /// K^-1 C, one vector an unknown of the border.
    columns: Vec<Vec<f64>>,
    /// Rows R: (index in the inner block, storage position) of each entry.
    rows: Vec<Vec<(usize, usize)>>,
    /// Storage positions of C: (index in the inner block, storage position).
    column_entries: Vec<Vec<(usize, usize)>>,
    /// Storage positions of D, row by row.
    corner: Vec<Vec<Option<usize>>>,
    schur: Option<nalgebra::LU<f64, nalgebra::Dyn, nalgebra::Dyn>>,
}

/// The sparse factorisation itself.
struct InnerLu {
    pattern: Pattern,
    symbolic: SymbolicLu<usize>,
    numeric: NumericLu<usize, f64>,
    workspace: MemBuffer,
}

fn symbolic_view(pattern: &Pattern) -> SymbolicSparseColMatRef<'_, usize> {
    SymbolicSparseColMatRef::new_checked(
        pattern.n(),
        pattern.n(),
        &pattern.columns,
        None,
        &pattern.rows,
    )
}

impl InnerLu {
    fn analyse(pattern: Pattern) -> Result<Self, SingularMatrix> {
        let symbolic = factorize_symbolic_lu(symbolic_view(&pattern), LuSymbolicParams::default())
            .map_err(|error| SingularMatrix(format!("the analysis failed: {error:?}")))?;
        let factor = symbolic.factorize_numeric_lu_scratch::<f64>(PARALLELISM, Default::default());
        let solve = symbolic.solve_in_place_scratch::<f64>(1, PARALLELISM);
        let workspace = MemBuffer::try_new(factor.or(solve))
            .map_err(|_| SingularMatrix("memory ran out in the analysis".to_owned()))?;
        Ok(Self { pattern, symbolic, numeric: NumericLu::new(), workspace })
    }

    fn factorise(&mut self, values: &[f64]) -> Result<(), SingularMatrix> {
        let matrix = SparseColMatRef::new(symbolic_view(&self.pattern), values);
        self.symbolic
            .factorize_numeric_lu(
                &mut self.numeric,
                matrix,
                PARALLELISM,
                MemStack::new(&mut self.workspace),
                Default::default(),
            )
            .map(|_| ())
            .map_err(|error| match error {
                LuError::Generic(FaerError::OutOfMemory) => {
                    SingularMatrix("memory ran out in the factorisation".to_owned())
                }
                other => SingularMatrix(format!("a pivot vanished: {other:?}")),
            })
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

impl DirectSolver {
    /// Orders the columns and finds the fill of a pattern, with the unknowns of `border` kept out.
    ///
    /// # Errors
    /// When memory runs out.
    pub fn analyse(pattern: &Pattern, border: &[usize]) -> Result<Self, SingularMatrix> {
        let mut inner_index: Vec<Option<usize>> = vec![None; pattern.n()];
        let kept: Vec<usize> = (0..pattern.n()).filter(|index| !border.contains(index)).collect();
        for (inner, &index) in kept.iter().enumerate() {
            inner_index[index] = Some(inner);
        }
        let mut inner = Pattern { columns: vec![0], rows: Vec::new() };
        let mut sources = Vec::new();
        for &column in &kept {
            for entry in pattern.columns[column]..pattern.columns[column + 1] {
                if let Some(row) = inner_index[pattern.rows[entry]] {
                    inner.rows.push(row);
                    sources.push(entry);
                }
            }
            inner.columns.push(inner.rows.len());
        }
        let inner_values = vec![0.0; sources.len()];
        let border = (!border.is_empty()).then(|| Border::new(pattern, border, &inner_index));
        Ok(Self { inner: InnerLu::analyse(inner)?, kept, sources, inner_values, border })
    }

    /// Factorises the matrix with these values.
    ///
    /// # Errors
    /// When a pivot vanishes.
    pub fn factorise(&mut self, values: &[f64]) -> Result<(), SingularMatrix> {
        for (inner, &source) in self.inner_values.iter_mut().zip(&self.sources) {
            *inner = values[source];
        }
        self.inner.factorise(&self.inner_values)?;
        match &mut self.border {
            None => Ok(()),
            Some(border) => border.factorise(&mut self.inner, values),
        }
    }

    /// Solves A x = b by the factorisation and iterative refinement, in place.
    ///
    /// Returns the residual: the largest entry of |b - A x| over the largest of |A| |x| + |b|.
    ///
    /// # Errors
    /// When the residual stays large or is not a number.
    pub fn solve(
        &mut self,
        pattern: &Pattern,
        values: &[f64],
        rhs: &mut [f64],
    ) -> Result<f64, SingularMatrix> {
        let target = rhs.to_vec();
        self.apply(values, rhs);
        let mut residual = f64::INFINITY;
        for _ in 0..MAX_REFINEMENTS {
            let (mut defect, scale) = defect(pattern, values, rhs, &target);
            let size = defect.iter().fold(0.0f64, |most, value| most.max(value.abs()));
            let next = if scale > 0.0 { size / scale } else { size };
            if next.is_nan() || rhs.iter().any(|value| !value.is_finite()) {
                return Err(SingularMatrix("the solution is not a number".to_owned()));
            }
            // Refinement that no longer helps has reached rounding.
            if next <= ROUNDING || next > 0.5 * residual {
                residual = residual.min(next);
                break;
            }
            residual = next;
            self.apply(values, &mut defect);
            for (value, correction) in rhs.iter_mut().zip(&defect) {
                *value += correction;
            }
        }
        if residual > USELESS {
            return Err(SingularMatrix(format!(
                "the solution leaves a relative residual of {residual:.1e}"
            )));
        }
        Ok(residual)
    }

    fn apply(&mut self, values: &[f64], rhs: &mut [f64]) {
        let mut inner: Vec<f64> = self.kept.iter().map(|&index| rhs[index]).collect();
        self.inner.apply(&mut inner);
        if let Some(border) = &self.border {
            border.apply(values, rhs, &mut inner);
        }
        for (&index, value) in self.kept.iter().zip(&inner) {
            rhs[index] = *value;
        }
    }
}

impl Border {
    fn new(pattern: &Pattern, unknowns: &[usize], inner_index: &[Option<usize>]) -> Self {
        let mut rows = vec![Vec::new(); unknowns.len()];
        let mut column_entries = vec![Vec::new(); unknowns.len()];
        let mut corner = vec![vec![None; unknowns.len()]; unknowns.len()];
        let place = |index: usize| unknowns.iter().position(|&unknown| unknown == index);
        for column in 0..pattern.n() {
            for entry in pattern.columns[column]..pattern.columns[column + 1] {
                let row = pattern.rows[entry];
                match (inner_index[row], inner_index[column]) {
                    (Some(_), Some(_)) => {}
                    (Some(inner), None) => {
                        let border = place(column).expect("what is not kept is in the border");
                        column_entries[border].push((inner, entry));
                    }
                    (None, Some(inner)) => {
                        let border = place(row).expect("what is not kept is in the border");
                        rows[border].push((inner, entry));
                    }
                    (None, None) => {
                        let border = place(row).expect("what is not kept is in the border");
                        corner[border][place(column).expect("as above")] = Some(entry);
                    }
                }
            }
        }
        Self {
            unknowns: unknowns.to_vec(),
            columns: Vec::new(),
            rows,
            column_entries,
            corner,
            schur: None,
        }
    }

    fn row_dot(&self, row: usize, values: &[f64], inner: &[f64]) -> f64 {
        self.rows[row].iter().map(|&(index, entry)| values[entry] * inner[index]).sum()
    }

    fn factorise(&mut self, inner: &mut InnerLu, values: &[f64]) -> Result<(), SingularMatrix> {
        let n = self.unknowns.len();
        self.columns.clear();
        for entries in &self.column_entries {
            let mut column = vec![0.0; inner.pattern.n()];
            for &(index, entry) in entries {
                column[index] = values[entry];
            }
            inner.apply(&mut column);
            self.columns.push(column);
        }
        let schur = DMatrix::from_fn(n, n, |row, column| {
            self.corner[row][column].map_or(0.0, |entry| values[entry])
                - self.row_dot(row, values, &self.columns[column])
        });
        let factors = schur.lu();
        if !factors.is_invertible() {
            return Err(SingularMatrix(
                "the velocity of a free body is not determined by the equations".to_owned(),
            ));
        }
        self.schur = Some(factors);
        Ok(())
    }

    /// Turns `inner` = K^-1 f into the inner solution and writes z into `rhs`.
    fn apply(&self, values: &[f64], rhs: &mut [f64], inner: &mut [f64]) {
        let defect = DVector::from_fn(self.unknowns.len(), |row, _| {
            rhs[self.unknowns[row]] - self.row_dot(row, values, inner)
        });
        let solution = self.schur.as_ref().and_then(|schur| schur.solve(&defect));
        let solution = solution.expect("the corner was found invertible when it was factorised");
        for (border, &unknown) in self.unknowns.iter().enumerate() {
            rhs[unknown] = solution[border];
            for (value, column) in inner.iter_mut().zip(&self.columns[border]) {
                *value -= column * solution[border];
            }
        }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Solves a small system with and without a border and returns both solutions.
    fn solve(matrix: &DMatrix<f64>, rhs: &[f64], border: &[usize]) -> Vec<f64> {
        let mut pattern = Pattern { columns: vec![0], rows: Vec::new() };
        let mut values = Vec::new();
        for column in 0..matrix.ncols() {
            for row in 0..matrix.nrows() {
                if matrix[(row, column)] != 0.0 {
                    pattern.rows.push(row);
                    values.push(matrix[(row, column)]);
                }
            }
            pattern.columns.push(pattern.rows.len());
        }
        let mut solver = DirectSolver::analyse(&pattern, border).unwrap();
        solver.factorise(&values).unwrap();
        let mut x = rhs.to_vec();
        assert!(solver.solve(&pattern, &values, &mut x).unwrap() < 1e-14);
        x
    }

    #[test]
    fn a_saddle_point_system_is_solved_with_and_without_a_border() {
        #[rustfmt::skip]
        let matrix = DMatrix::from_row_slice(5, 5, &[
            4.0, 1.0, 0.0, 1.0, 2.0,
            1.0, 3.0, 1.0, 0.0, 1.0,
            0.0, 1.0, 5.0, 2.0, 3.0,
            1.0, 0.0, 2.0, 0.0, 1.0,
            0.0, 1.0, 1.0, 0.0, 0.0,
        ]);
        let rhs = [1.0, 2.0, 3.0, 4.0, 5.0];
        let exact = matrix.clone().lu().solve(&DVector::from_row_slice(&rhs)).unwrap();
        for border in [&[][..], &[4], &[0, 4]] {
            for (value, expected) in solve(&matrix, &rhs, border).iter().zip(exact.iter()) {
                assert!((value - expected).abs() < 1e-12);
            }
        }
    }
}
