//! `Chebyshev`: a polynomial in D^-1 A that is small on a part of its spectrum, D the diagonal blocks.
//!
//! As a smoother the part is the upper end (@adams2003), which Lanczos' method finds; as a solver it is the
//! whole spectrum, where its bounds are known.

use rayon::prelude::*;

use super::block_diagonal::BlockDiagonal;
use super::block_matrix::BlockMatrix;
use crate::sparse::single::single;

/// Products by which the largest eigenvalue of D^-1 A is found.
const LANCZOS_STEPS: usize = 12;
/// Halvings of the interval in which it is then.
const BISECTIONS: usize = 30;
/// Numbers that one task works on.
const CHUNK: usize = 8192;
/// What the value after them is multiplied by: it is a bound from below.
const SAFETY: f32 = 1.1;

/// The part of the spectrum of D^-1 A on which the polynomial is small.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Spectrum {
    /// From this fraction of the largest eigenvalue, which is found by Lanczos' method, to it.
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

/// The largest eigenvalue of D^-1 A, from below, by the steps of Lanczos in the scalar product of D (@saad2003,
/// section 6.6); of a matrix that is not symmetric that of its symmetric part, and of the skew one the size.
///
/// A few flat cells may have it, which power steps come near to only after three times as many products.
/// It may live around a pair alone: pairs weigh as much as all others in what the steps start from, in which
/// every other unknown has the same energy.
fn largest_eigenvalue<const B: usize>(
    matrix: &BlockMatrix<B>,
    diagonal: &BlockDiagonal<B>,
    n_pairs: usize,
) -> f32 {
    let n = matrix.n_rows();
    let weight = (n as f32).sqrt();
    let start = |row: usize| {
        let weight = if row < n - 2 * n_pairs { 1.0 } else { weight };
        let inverse = diagonal.entries(row);
        std::array::from_fn(|a| {
            let inverse = if inverse[a] > 0.0 { inverse[a] } else { 1.0 };
            weight * scattered(row * B + a) / inverse.sqrt()
        })
    };
    // Vectors of norm one, of this step and the one before, and D times them
    let mut image: Vec<[f32; B]> = (0..n).map(start).collect();
    let [mut image_before, mut vector, mut before] = [(); 3].map(|()| vec![[0.0; B]; n]);
    let mut product = before.clone();
    let mut tridiagonal = Tridiagonal::default();
    for _ in 0..LANCZOS_STEPS {
        diagonal.apply(&image, &mut vector);
        let size = dot(&image, &vector).max(0.0).sqrt();
        if !single(1.0 / size).is_normal() {
            break;
        }
        scale(1.0 / size, &mut image);
        scale(1.0 / size, &mut vector);
        matrix.multiply(&vector, &mut product);
        let [own, earlier] = [dot(&product, &vector), dot(&product, &before)];
        tridiagonal.diagonal.push(own);
        tridiagonal.off.push(0.5 * (size + earlier.abs()));
        subtract(own, &image, &mut product);
        subtract(earlier, &image_before, &mut product);
        std::mem::swap(&mut before, &mut vector);
        std::mem::swap(&mut image_before, &mut image);
        std::mem::swap(&mut image, &mut product);
    }
    let largest = single(tridiagonal.largest_eigenvalue());
    // Any bound will do for a matrix that is zero
    if largest > 0.0 && largest.is_finite() { largest } else { 1.0 }
}

/// Multiplies all numbers by a factor.
fn scale<const B: usize>(factor: f64, vector: &mut [[f32; B]]) {
    let factor = single(factor);
    let chunks = vector.as_flattened_mut().par_chunks_mut(CHUNK);
    chunks.for_each(|chunk| chunk.iter_mut().for_each(|value| *value *= factor));
}

/// Subtracts a factor times other numbers.
fn subtract<const B: usize>(factor: f64, others: &[[f32; B]], vector: &mut [[f32; B]]) {
    let factor = single(factor);
    let chunks = vector.as_flattened_mut().par_chunks_mut(CHUNK);
    chunks.zip(others.as_flattened().par_chunks(CHUNK)).for_each(|(chunk, others)| {
        chunk.iter_mut().zip(others).for_each(|(value, other)| *value -= factor * other);
    });
}

/// Scalar product, with sums over pieces of a fixed size.
fn dot<const B: usize>(a: &[[f32; B]], b: &[[f32; B]]) -> f64 {
    let chunk = |(a, b): (&[f32], &[f32])| {
        a.iter().zip(b).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum::<f64>()
    };
    let chunks = a.as_flattened().par_chunks(CHUNK).zip(b.as_flattened().par_chunks(CHUNK));
    let sums: Vec<f64> = chunks.map(chunk).collect();
    sums.into_iter().sum()
}

/// A symmetric tridiagonal matrix: of each row the entry on the diagonal and the one before it, the first being
/// none.
#[derive(Debug, Default)]
struct Tridiagonal {
    diagonal: Vec<f64>,
    off: Vec<f64>,
}

impl Tridiagonal {
    /// The largest eigenvalue, by bisection: above it all pivots are positive; zero
    /// without any.
    fn largest_eigenvalue(&self) -> f64 {
        let Self { diagonal, off } = self;
        let is_above = |value: f64| {
            let mut pivot = f64::INFINITY;
            diagonal.iter().zip(off).all(|(entry, off)| {
                pivot = value - entry - off * off / pivot;
                pivot > 0.0
            })
        };
        let reach = |row: usize| {
            let off = |row: usize| off.get(row).map_or(0.0, |off| off.abs());
            diagonal[row] + off(row) + off(row + 1)
        };
        let rows = 0..diagonal.len();
        let mut lower = diagonal.iter().copied().fold(0.0, f64::max);
        let mut upper = rows.map(reach).fold(lower, f64::max);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (lower + upper);
            if is_above(middle) { upper = middle } else { lower = middle }
        }
        upper
    }
}

/// A number between -1 and 1 that has little to do with those before and after it: what the steps
/// start from has a part along every eigenvector.
fn scattered(index: usize) -> f32 {
    let mixed = (index as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    let high = (mixed ^ (mixed >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9) >> 40;
    high as f32 / (1u32 << 23) as f32 - 1.0
}
