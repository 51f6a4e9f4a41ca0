//! `Cholesky`: sparse factors of symmetric matrices, by faer, in one thread: the same bits each time.
//!
//! Those with pressures are indefinite: [K B; B^T 0]. Their factors L D L^T are of [K B; B^T -C] with a small C, which
//! exist in any order of elimination where K is positive (@vanderbei1995), and a few corrections take C away again.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LdltRef, LltRef, SymbolicCholesky, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

use super::SolidError;
use super::pattern::Pattern;

/// Residual, of the right-hand side, at which conjugate gradients end: far below what gradients are compared to.
const SOLVED: f64 = 1e-11;

/// Iterations of conjugate gradients at most; more cost as much as new factors.
const N_ITERATIONS: usize = 14;

/// C, of the diagonal of B^T K^-1 B as that of K has it: corrections shrink by it, times the squared number of cells
/// across the body.
const REGULARISED: f64 = 1e-6;

/// Corrections at most.
const N_CORRECTIONS: usize = 30;

/// Residual, of the right-hand side, below which corrections end.
const CORRECTED: f64 = 1e-15;

/// What is left of a residual at most where a correction is worth another one.
const WORTH: f64 = 0.5;

/// Residual, of the right-hand side, of a solution that counts.
const ACCURATE: f64 = 1e-9;

/// The same of the products whose sum it is, which in a thin body are much larger: rounding leaves no less.
const ROUNDED: f64 = 1e-13;

/// The order of elimination and the pattern of the factors, for all matrices of a pattern.
#[derive(Debug)]
pub struct Cholesky {
    symbolic: SymbolicCholesky<usize>,
}

/// Factors L L^T of a positive definite matrix, or L D L^T of one with pressures.
#[derive(Debug, Clone)]
pub struct Factor {
    values: Vec<f64>,
    mixed: Option<Mixed>,
}

/// A matrix with pressures whose factors are nearly those at hand.
#[derive(Debug, Clone)]
struct Mixed {
    matrix: Vec<f64>,
    /// What squared residuals are divided by, so that those of places and pressures are one energy.
    scales: Vec<f64>,
}

/// A matrix, and factors of one that is near.
struct Near<'a> {
    pattern: &'a Pattern,
    matrix: &'a [f64],
    factor: &'a Factor,
    scales: &'a [f64],
}

impl Near<'_> {
    /// Norm of a residual, those of places and pressures as one energy.
    fn size(&self, all: &[f64]) -> f64 {
        let squares = all.iter().zip(self.scales).map(|(value, scale)| value * value / scale);
        squares.sum::<f64>().sqrt()
    }
}

/// A solution with the sizes of what is left of its right-hand side, and of the whole.
struct Corrected {
    solution: Vec<f64>,
    left: f64,
    whole: f64,
}

impl Cholesky {
    /// Analyses a pattern. Positive matrices are factorised by supernodes, which faer prefers for larger ones only: of
    /// 693 to 2769 unknowns in space a motion takes 2 to 12 % less so.
    ///
    /// # Errors
    /// [`SolidError::Singular`] where memory is short.
    pub fn new(pattern: &Pattern) -> Result<Self, SolidError> {
        let n = pattern.n_unknowns();
        let matrix =
            SymbolicSparseColMatRef::new_checked(n, n, &pattern.starts, None, &pattern.rows);
        let supernodal_flop_ratio_threshold = if pattern.is_mixed() {
            SupernodalThreshold::AUTO
        } else {
            SupernodalThreshold::FORCE_SUPERNODAL
        };
        let symbolic = factorize_symbolic_cholesky(
            matrix,
            Side::Lower,
            SymmetricOrdering::Amd,
            CholeskySymbolicParams { supernodal_flop_ratio_threshold, ..Default::default() },
        );
        Ok(Self { symbolic: symbolic.map_err(|_| SolidError::Singular)? })
    }

    /// Factors of a matrix by the values of its entries; none where it is not positive definite, or with pressures
    /// where a pivot vanishes.
    #[must_use]
    pub fn factorise(&self, pattern: &Pattern, values: &[f64]) -> Option<Factor> {
        if pattern.is_mixed() {
            return self.factorise_mixed(pattern, values);
        }
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
        let is_finite = factor.iter().all(|value| value.is_finite());
        is_finite.then_some(Factor { values: factor, mixed: None })
    }

    fn factorise_mixed(&self, pattern: &Pattern, values: &[f64]) -> Option<Factor> {
        let n = pattern.n_unknowns();
        let scales = mixed_scales(pattern, values);
        let mut near = values.to_vec();
        for (start, scale) in pattern.starts[..n].iter().zip(&scales).skip(pattern.n_places) {
            near[*start] -= REGULARISED * scale;
        }
        let symbolic =
            SymbolicSparseColMatRef::new_checked(n, n, &pattern.starts, None, &pattern.rows);
        let mut factor = vec![0.0; self.symbolic.len_val()];
        let scratch =
            self.symbolic.factorize_numeric_ldlt_scratch::<f64>(Par::Seq, Default::default());
        let mut memory = MemBuffer::new(scratch);
        let done = self.symbolic.factorize_numeric_ldlt(
            &mut factor,
            SparseColMatRef::new(symbolic, &near),
            Side::Lower,
            Default::default(),
            Par::Seq,
            MemStack::new(&mut memory),
            Default::default(),
        );
        done.ok()?;
        let is_finite = factor.iter().all(|value| value.is_finite());
        let mixed = Some(Mixed { matrix: values.to_vec(), scales });
        is_finite.then_some(Factor { values: factor, mixed })
    }

    /// Solves with factors, in place; false where the solution is not accurate.
    pub fn solve(&self, pattern: &Pattern, factor: &Factor, right: &mut [f64]) -> bool {
        let Some(Mixed { matrix, scales }) = &factor.mixed else {
            self.apply(factor, right);
            return true;
        };
        let near = Near { pattern, matrix, factor, scales };
        let Corrected { solution, left, whole } = self.corrected(&near, right, N_CORRECTIONS);
        right.copy_from_slice(&solution);
        let is_accurate = left <= ACCURATE * whole;
        is_accurate || {
            let sizes = |all: &[f64]| all.iter().map(|value| value.abs()).collect::<Vec<_>>();
            left <= ROUNDED * near.size(&pattern.times(&sizes(matrix), &sizes(right)))
        }
    }

    /// Solves with factors of a matrix that is near, and corrections by the matrix itself as long as they are worth it.
    fn corrected(&self, near: &Near<'_>, right: &[f64], most: usize) -> Corrected {
        let whole = near.size(right);
        let mut solution = vec![0.0; right.len()];
        let mut residual = right.to_vec();
        let mut left = whole;
        for _ in 0..most {
            if left <= CORRECTED * whole {
                break;
            }
            let mut correction = residual.clone();
            self.apply(near.factor, &mut correction);
            let next: Vec<f64> = solution.iter().zip(&correction).map(|(x, d)| x + d).collect();
            let image = near.pattern.times(near.matrix, &next);
            residual = right.iter().zip(&image).map(|(b, y)| b - y).collect();
            let now = near.size(&residual);
            if now.is_nan() || now >= left {
                break;
            }
            let is_worth = now < WORTH * left;
            (solution, left) = (next, now);
            if !is_worth {
                break;
            }
        }
        Corrected { solution, left, whole }
    }

    /// Applies the inverse that the factors are of, in place.
    fn apply(&self, factor: &Factor, right: &mut [f64]) {
        let n = right.len();
        let scratch = self.symbolic.solve_in_place_scratch::<f64>(1, Par::Seq);
        let mut memory = MemBuffer::new(scratch);
        let stack = MemStack::new(&mut memory);
        let right = MatMut::from_column_major_slice_mut(right, n, 1);
        if factor.mixed.is_some() {
            let factor = LdltRef::new(&self.symbolic, &factor.values);
            factor.solve_in_place_with_conj(Conj::No, right, Par::Seq, stack);
        } else {
            let factor = LltRef::new(&self.symbolic, &factor.values);
            factor.solve_in_place_with_conj(Conj::No, right, Par::Seq, stack);
        }
    }

    /// Solves for a matrix whose factors are nearly those at hand: by conjugate gradients, or with pressures by
    /// corrections. None where that takes longer than new factors.
    #[must_use]
    pub fn solve_near(
        &self,
        pattern: &Pattern,
        values: &[f64],
        factor: &Factor,
        right: &[f64],
    ) -> Option<Vec<f64>> {
        let Some(Mixed { scales, .. }) = &factor.mixed else {
            return self.conjugate_gradients(pattern, values, factor, right);
        };
        let near = Near { pattern, matrix: values, factor, scales };
        let Corrected { solution, left, whole } = self.corrected(&near, right, N_ITERATIONS);
        (left <= SOLVED * whole).then_some(solution)
    }

    /// Conjugate gradients for a positive matrix; none where they take longer than new factors.
    fn conjugate_gradients(
        &self,
        pattern: &Pattern,
        values: &[f64],
        factor: &Factor,
        right: &[f64],
    ) -> Option<Vec<f64>> {
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let add = |to: &mut [f64], factor: f64, from: &[f64]| {
            to.iter_mut().zip(from).for_each(|(a, b)| *a += factor * b);
        };
        let target = SOLVED * dot(right, right).sqrt();
        let mut solution = vec![0.0; right.len()];
        let mut residual = right.to_vec();
        let mut direction = vec![0.0; right.len()];
        let mut last = 1.0;
        for _ in 0..N_ITERATIONS {
            if dot(&residual, &residual).sqrt() <= target {
                return Some(solution);
            }
            let mut solved = residual.clone();
            self.apply(factor, &mut solved);
            let product = dot(&residual, &solved);
            let ratio = product / last;
            for (d, s) in direction.iter_mut().zip(&solved) {
                *d = s + ratio * *d;
            }
            let image = pattern.times(values, &direction);
            let curvature = dot(&direction, &image);
            if !(curvature > 0.0 && product > 0.0) {
                return None;
            }
            add(&mut solution, product / curvature, &direction);
            add(&mut residual, -product / curvature, &image);
            last = product;
        }
        None
    }
}

/// The diagonal of K, and behind it that of B^T K^-1 B as the diagonal of K has it; none of them is 0.
fn mixed_scales(pattern: &Pattern, values: &[f64]) -> Vec<f64> {
    let n = pattern.n_unknowns();
    let mut scales = vec![0.0; n];
    let diagonal = pattern.starts[..pattern.n_places].iter().map(|at| values[*at].abs());
    let largest = diagonal.clone().fold(0.0, f64::max);
    let least = if largest > 0.0 { f64::EPSILON * largest } else { 1.0 };
    for (column, value) in diagonal.enumerate() {
        scales[column] = value.max(least);
        for entry in pattern.starts[column]..pattern.starts[column + 1] {
            let row = pattern.rows[entry];
            if row >= pattern.n_places {
                scales[row] += values[entry] * values[entry] / scales[column];
            }
        }
    }
    let largest = scales[pattern.n_places..].iter().copied().fold(0.0, f64::max);
    let least = if largest > 0.0 { f64::EPSILON * largest } else { 1.0 };
    scales[pattern.n_places..].iter_mut().for_each(|scale| *scale = scale.max(least));
    scales
}
