//! `Blocks`: vectors of velocities in blocks and of pressures, in single precision.

use rayon::prelude::*;

use crate::sparse::single::single;

/// Unknowns in a block.
pub(super) const B: usize = 3;

/// Numbers that are summed up on their own, whatever the number of threads.
const CHUNK: usize = 12_288;
/// Sums side by side within them.
const LANES: usize = 16;

/// A vector of the unknowns by what they are.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Blocks {
    /// Velocities of nodes, then of bodies; zero where a component is no unknown.
    pub velocity: Vec<[f32; B]>,
    /// Pressures.
    pub pressure: Vec<f32>,
}

impl Blocks {
    /// Zeros, so many blocks and pressures.
    pub fn zeros(n_blocks: usize, n_pressures: usize) -> Self {
        Self { velocity: vec![[0.0; B]; n_blocks], pressure: vec![0.0; n_pressures] }
    }

    /// Zeros, as many as in this vector.
    pub fn zeros_alike(&self) -> Self {
        Self::zeros(self.velocity.len(), self.pressure.len())
    }

    /// Scalar product.
    pub fn dot(&self, other: &Self) -> f64 {
        let velocities = dot(self.velocity.as_flattened(), other.velocity.as_flattened());
        velocities + dot(&self.pressure, &other.pressure)
    }

    /// Euclidean norm.
    pub fn norm(&self) -> f64 {
        self.dot(self).sqrt()
    }

    /// Adds `factor` times another vector.
    pub fn add(&mut self, factor: f64, other: &Self) {
        add(single(factor), other.velocity.as_flattened(), self.velocity.as_flattened_mut());
        add(single(factor), &other.pressure, &mut self.pressure);
    }

    /// Multiplies by a factor.
    pub fn scale(&mut self, factor: f64) {
        let factor = single(factor);
        for values in [self.velocity.as_flattened_mut(), &mut self.pressure] {
            let chunks = values.par_chunks_mut(CHUNK);
            chunks.for_each(|chunk| chunk.iter_mut().for_each(|value| *value *= factor));
        }
    }
}

/// Scalar product, its chunks in double precision.
fn dot(a: &[f32], b: &[f32]) -> f64 {
    let chunk = |(a, b): (&[f32], &[f32])| {
        let mut sums = [0.0f32; LANES];
        let (a_lanes, b_lanes) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
        let rest = a_lanes.remainder().iter().zip(b_lanes.remainder());
        let rest: f32 = rest.map(|(a, b)| a * b).sum();
        for (a, b) in a_lanes.zip(b_lanes) {
            for lane in 0..LANES {
                sums[lane] += a[lane] * b[lane];
            }
        }
        sums.iter().map(|sum| f64::from(*sum)).sum::<f64>() + f64::from(rest)
    };
    let sums: Vec<f64> = a.par_chunks(CHUNK).zip(b.par_chunks(CHUNK)).map(chunk).collect();
    sums.into_iter().sum()
}

/// target += factor * from.
fn add(factor: f32, from: &[f32], target: &mut [f32]) {
    target.par_chunks_mut(CHUNK).zip(from.par_chunks(CHUNK)).for_each(|(target, from)| {
        for (target, value) in target.iter_mut().zip(from) {
            *target += factor * value;
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vector(n: usize, phase: f32) -> Blocks {
        let value = |index: usize| (index as f32 * 0.37 + phase).sin();
        Blocks {
            velocity: (0..n).map(|row| std::array::from_fn(|a| value(row * B + a))).collect(),
            pressure: (0..n / 3).map(value).collect(),
        }
    }

    #[test]
    fn sums_over_chunks_are_those_of_all_numbers() {
        let [a, b] = [0.0, 1.0].map(|phase| vector(20_000, phase));
        let pairs = a.velocity.iter().flatten().zip(b.velocity.iter().flatten());
        let expected: f64 = pairs
            .chain(a.pressure.iter().zip(&b.pressure))
            .map(|(a, b)| f64::from(*a) * f64::from(*b))
            .sum();
        assert!((a.dot(&b) - expected).abs() < 1e-6 * a.norm() * b.norm());
        let mut sum = a.clone();
        sum.add(-a.dot(&b) / b.dot(&b), &b);
        assert!(sum.dot(&b).abs() < 1e-5 * a.norm() * b.norm());
        sum.scale(0.5);
        assert!((a.dot(&sum) - 0.5 * (a.dot(&a) - a.dot(&b).powi(2) / b.dot(&b))).abs() < 1e-2);
    }
}
