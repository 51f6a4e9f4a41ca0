//! `Blocks`: vectors of velocities in blocks and of pressures.

use rayon::prelude::*;

use crate::sparse::single::single;

/// Unknowns in a block.
pub(in super::super) const B: usize = 3;

/// Numbers that are summed up on their own, whatever the number of threads.
const CHUNK: usize = 12_288;
/// Sums side by side within them.
const LANES: usize = 16;

/// Where an unknown stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in super::super) enum Place {
    /// In a block of velocities.
    Velocity { row: u32, component: u8 },
    /// Among the pressures.
    Pressure(u32),
}

/// A vector of the unknowns by what they are, in single precision if nothing else is said.
#[derive(Debug, Clone, PartialEq)]
pub(in super::super) struct Blocks<T = f32> {
    /// Velocities of nodes, then of bodies; zero where a component is no unknown.
    pub velocity: Vec<[T; B]>,
    /// Pressures.
    pub pressure: Vec<T>,
}

impl<T: Copy + Default> Blocks<T> {
    /// Zeros, so many blocks and pressures.
    pub fn zeros(n_blocks: usize, n_pressures: usize) -> Self {
        let zero = T::default();
        Self { velocity: vec![[zero; B]; n_blocks], pressure: vec![zero; n_pressures] }
    }

    /// The value of an unknown.
    pub fn at(&self, place: Place) -> T {
        match place {
            Place::Velocity { row, component } => {
                self.velocity[row as usize][usize::from(component)]
            }
            Place::Pressure(index) => self.pressure[index as usize],
        }
    }

    /// The value of an unknown, to be changed.
    pub fn at_mut(&mut self, place: Place) -> &mut T {
        match place {
            Place::Velocity { row, component } => {
                &mut self.velocity[row as usize][usize::from(component)]
            }
            Place::Pressure(index) => &mut self.pressure[index as usize],
        }
    }
}

impl Blocks {
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
        let factor = single(factor);
        self.combine(other, |value, other| value + factor * other);
    }

    /// Overwrites each value by what `of` gives for it and that of another vector.
    pub fn combine(&mut self, other: &Self, of: impl Fn(f32, f32) -> f32 + Sync) {
        let velocity = self.velocity.as_flattened_mut();
        combine(velocity, other.velocity.as_flattened(), &of);
        combine(&mut self.pressure, &other.pressure, &of);
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
pub(in super::super) fn dot(a: &[f32], b: &[f32]) -> f64 {
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

/// Overwrites values by what `of` gives for them and those of others.
fn combine(values: &mut [f32], others: &[f32], of: &(impl Fn(f32, f32) -> f32 + Sync)) {
    values.par_chunks_mut(CHUNK).zip(others.par_chunks(CHUNK)).for_each(|(values, others)| {
        for (value, other) in values.iter_mut().zip(others) {
            *value = of(*value, *other);
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
