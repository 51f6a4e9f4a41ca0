//! `Chebyshev`: a polynomial in D^-1 A that is small on a part of its spectrum, D the diagonal blocks.
//!
//! As a smoother the part is the upper end (@adams2003), which power steps find; as a solver it is the
//! whole spectrum, where its bounds are known.

use rayon::prelude::*;

use super::block_diagonal::BlockDiagonal;
use super::block_matrix::BlockMatrix;
use crate::sparse::single::single;

/// Power steps towards the largest eigenvalue of D^-1 A.
const POWER_STEPS: usize = 15;
/// Numbers that one task works on.
const CHUNK: usize = 8192;
/// What the value after them is multiplied by: it is a bound from below.
const SAFETY: f32 = 1.1;

/// The part of the spectrum of D^-1 A on which the polynomial is small.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Spectrum {
    /// From this fraction of the largest eigenvalue, which is found by power steps, to it.
    UpperEnd(f32),
    /// Between bounds.
    Between(f32, f32),
}

/// Chebyshev iterations for A x = b with the inverse of the diagonal blocks.
#[derive(Debug)]
pub(crate) struct Chebyshev<const B: usize> {
    diagonal: BlockDiagonal<B>,
    lower: f32,
    upper: f32,
    degree: usize,
    residual: Vec<[f32; B]>,
    step: Vec<[f32; B]>,
    image: Vec<[f32; B]>,
}

impl<const B: usize> Chebyshev<B> {
    /// For a square matrix whose last rows are pairs.
    pub fn new(matrix: &BlockMatrix<B>, n_pairs: usize, spectrum: Spectrum, degree: usize) -> Self {
        let n = matrix.n_rows();
        let empty = vec![[0.0; B]; n];
        let diagonal = BlockDiagonal::new(matrix, n_pairs);
        let (lower, upper) = match spectrum {
            Spectrum::UpperEnd(fraction) => {
                let largest = SAFETY * largest_eigenvalue(matrix, &diagonal, n_pairs);
                (largest * fraction, largest)
            }
            Spectrum::Between(lower, upper) => (lower, upper),
        };
        let [residual, step, image] = [empty.clone(), empty.clone(), empty];
        Self { diagonal, lower, upper, degree, residual, step, image }
    }

    /// An upper bound of the eigenvalues of D^-1 A.
    pub fn upper(&self) -> f32 {
        self.upper
    }

    /// The inverse of the diagonal blocks.
    pub(super) fn diagonal(&self) -> &BlockDiagonal<B> {
        &self.diagonal
    }

    /// Overwrites x with an approximation of A^-1 b, starting from zero.
    pub fn solve(&mut self, matrix: &BlockMatrix<B>, b: &[[f32; B]], x: &mut [[f32; B]]) {
        x.fill([0.0; B]);
        self.residual.copy_from_slice(b);
        self.iterate(matrix, x);
    }

    /// Improves x.
    pub fn improve(&mut self, matrix: &BlockMatrix<B>, b: &[[f32; B]], x: &mut [[f32; B]]) {
        self.residual.copy_from_slice(b);
        matrix.multiply_subtract(x, &mut self.residual);
        self.iterate(matrix, x);
    }

    /// The iterations (@saad2003, algorithm 12.1), with the residual at x given.
    fn iterate(&mut self, matrix: &BlockMatrix<B>, x: &mut [[f32; B]]) {
        let center = 0.5 * (self.upper + self.lower);
        let radius = 0.5 * (self.upper - self.lower);
        let ratio = center / radius;
        let mut weight = 1.0 / ratio;
        self.diagonal.apply(&self.residual, &mut self.step);
        update(&mut self.step, x, |_, step| *step /= center);
        for _ in 1..self.degree {
            matrix.multiply_subtract(&self.step, &mut self.residual);
            self.diagonal.apply(&self.residual, &mut self.image);
            let next = 1.0 / (2.0 * ratio - weight);
            let (old, new) = (next * weight, 2.0 * next / radius);
            let image = self.image.as_flattened();
            update(&mut self.step, x, |at, step| *step = old * *step + new * image[at]);
            weight = next;
        }
    }
}

/// Lets `change` have each number of a step with its index, and adds the step to x.
fn update<const B: usize>(
    step: &mut [[f32; B]],
    x: &mut [[f32; B]],
    change: impl Fn(usize, &mut f32) + Sync,
) {
    let steps = step.as_flattened_mut().par_chunks_mut(CHUNK).enumerate();
    steps.zip(x.as_flattened_mut().par_chunks_mut(CHUNK)).for_each(|((chunk, steps), x)| {
        for (index, (step, x)) in steps.iter_mut().zip(x).enumerate() {
            change(chunk * CHUNK + index, step);
            *x += *step;
        }
    });
}

/// The largest eigenvalue of D^-1 A by power steps, from below.
///
/// The eigenvector may live around a pair alone: pairs weigh as much as all others in what the steps
/// start from.
fn largest_eigenvalue<const B: usize>(
    matrix: &BlockMatrix<B>,
    diagonal: &BlockDiagonal<B>,
    n_pairs: usize,
) -> f32 {
    let n = matrix.n_rows();
    let weight = (n as f32).sqrt();
    let start = |row: usize| {
        let weight = if row < n - 2 * n_pairs { 1.0 } else { weight };
        std::array::from_fn(|a| weight * scattered(row * B + a))
    };
    let mut vector: Vec<[f32; B]> = (0..n).map(start).collect();
    let mut image = vec![[0.0; B]; n];
    let mut largest = 0.0;
    for _ in 0..POWER_STEPS {
        let size = norm(&vector);
        if size == 0.0 || !size.is_finite() {
            break;
        }
        vector.iter_mut().flatten().for_each(|value| *value /= size);
        matrix.multiply(&vector, &mut image);
        diagonal.apply(&image, &mut vector);
        largest = norm(&vector);
    }
    // Any bound will do for a matrix that is zero
    if largest > 0.0 && largest.is_finite() { largest } else { 1.0 }
}

fn norm<const B: usize>(vector: &[[f32; B]]) -> f32 {
    let squares = vector.iter().flatten().map(|value| f64::from(value * value));
    single(squares.sum::<f64>().sqrt())
}

/// A number between -1 and 1 that has little to do with those before and after it: what power steps
/// start from has a part along every eigenvector.
fn scattered(index: usize) -> f32 {
    let mixed = (index as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    let high = (mixed ^ (mixed >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9) >> 40;
    high as f32 / (1u32 << 23) as f32 - 1.0
}
