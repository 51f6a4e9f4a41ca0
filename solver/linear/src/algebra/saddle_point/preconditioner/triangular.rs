//! `Square`: dense matrices in double precision, and `TriangularBasis`, in which one is the identity.

use super::super::matrix::B;

/// Pivots below this part of the diagonal are rounding.
const ROUNDING: f64 = 1e-14;

/// A square matrix, row by row.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Square {
    n: usize,
    values: Vec<f64>,
}

impl Square {
    /// An n x n matrix of zeros.
    pub fn zeros(n: usize) -> Self {
        Self { n, values: vec![0.0; n * n] }
    }

    fn row(&self, row: usize) -> &[f64] {
        &self.values[row * self.n..(row + 1) * self.n]
    }

    fn row_mut(&mut self, row: usize) -> &mut [f64] {
        &mut self.values[row * self.n..(row + 1) * self.n]
    }

    /// A block, column by column.
    pub fn block(&self, i: usize, j: usize) -> [[f64; B]; B] {
        std::array::from_fn(|b| {
            std::array::from_fn(|a| self.values[(B * i + a) * self.n + B * j + b])
        })
    }

    /// Overwrites a block, given column by column.
    pub fn set_block(&mut self, i: usize, j: usize, block: &[[f64; B]; B]) {
        for (b, column) in block.iter().enumerate() {
            for (a, value) in column.iter().enumerate() {
                self.values[(B * i + a) * self.n + B * j + b] = *value;
            }
        }
    }

    /// A x.
    pub fn times(&self, x: &[f64]) -> Vec<f64> {
        let product = |row: usize| self.row(row).iter().zip(x).map(|(a, x)| a * x).sum();
        (0..self.n).map(product).collect()
    }

    /// A^T x.
    pub fn transposed_times(&self, x: &[f64]) -> Vec<f64> {
        let mut sum = vec![0.0; self.n];
        for (row, x) in x.iter().enumerate() {
            sum.iter_mut().zip(self.row(row)).for_each(|(sum, a)| *sum += a * x);
        }
        sum
    }

    /// T^T A T for an upper triangular T.
    pub fn changed(&self, basis: &Self) -> Self {
        let mut half = Self::zeros(self.n);
        for i in 0..self.n {
            for k in 0..self.n {
                add_row(self.row(i)[k], basis.row(k), k, half.row_mut(i));
            }
        }
        let mut all = Self::zeros(self.n);
        for k in 0..self.n {
            for i in k..self.n {
                add_row(basis.row(k)[i], half.row(k), 0, all.row_mut(i));
            }
        }
        all
    }
}

/// Adds a factor times a row, from a place on.
fn add_row(factor: f64, row: &[f64], from: usize, sum: &mut [f64]) {
    if factor != 0.0 {
        let terms = sum[from..].iter_mut().zip(&row[from..]);
        terms.for_each(|(sum, value)| *sum += factor * value);
    }
}

/// T, T^-1 and the signs s on a diagonal with s T^T S T the identity, for the symmetric part S of a matrix.
///
/// Signs are those of the pivots of S: it is not positive for a rod beyond its buckling, or far from
/// equilibrium in the midst of Newton's method.
#[derive(Debug)]
pub(super) struct TriangularBasis {
    /// T, upper triangular.
    pub basis: Square,
    /// T^-1.
    pub inverse: Square,
    /// s.
    pub signs: Vec<f64>,
}

impl TriangularBasis {
    /// By the factors L s L^T of the symmetric part of a matrix, with rows and columns scaled by its diagonal.
    pub fn of(matrix: &Square) -> Self {
        let n = matrix.n;
        let scales = scales(matrix);
        let Factors { factor, signs } = factors(matrix, &scales);
        let lower = lower_inverse(&factor);
        let (mut basis, mut inverse) = (Square::zeros(n), Square::zeros(n));
        for i in 0..n {
            for j in i..n {
                basis.values[i * n + j] = lower.row(j)[i] / scales[i];
                inverse.values[i * n + j] = factor.row(j)[i] * scales[j];
            }
        }
        Self { basis, inverse, signs }
    }
}

/// Roots of the sizes of the diagonal.
fn scales(matrix: &Square) -> Vec<f64> {
    let size = |row: usize| matrix.row(row)[row].abs();
    (0..matrix.n).map(|row| if size(row) > 0.0 { size(row).sqrt() } else { 1.0 }).collect()
}

/// L s L^T, L lower triangular.
struct Factors {
    factor: Square,
    signs: Vec<f64>,
}

/// The factors of the symmetric part of a matrix over its scales.
fn factors(matrix: &Square, scales: &[f64]) -> Factors {
    let n = matrix.n;
    let (mut factor, mut signs) = (Square::zeros(n), vec![1.0; n]);
    // The row at hand times the signs
    let mut signed = vec![0.0; n];
    for i in 0..n {
        for j in 0..=i {
            let symmetric = 0.5 * (matrix.row(i)[j] + matrix.row(j)[i]);
            let products = signed[..j].iter().zip(&factor.row(j)[..j]);
            let sum: f64 = products.map(|(a, b)| a * b).sum();
            let rest = symmetric / (scales[i] * scales[j]) - sum;
            if i == j {
                signs[i] = if rest < 0.0 { -1.0 } else { 1.0 };
                factor.row_mut(i)[i] = rest.abs().max(ROUNDING).sqrt();
            } else {
                signed[j] = rest / factor.row(j)[j];
                factor.row_mut(i)[j] = signed[j] * signs[j];
            }
        }
    }
    Factors { factor, signs }
}

/// L^-1.
fn lower_inverse(factor: &Square) -> Square {
    let n = factor.n;
    let mut lower = Square::zeros(n);
    for i in 0..n {
        let mut row = vec![0.0; n];
        row[i] = 1.0;
        for k in 0..i {
            let entry = -factor.row(i)[k];
            row[..=k].iter_mut().zip(lower.row(k)).for_each(|(sum, value)| *sum += entry * value);
        }
        let pivot = factor.row(i)[i];
        row.iter_mut().for_each(|value| *value /= pivot);
        lower.row_mut(i).copy_from_slice(&row);
    }
    lower
}
