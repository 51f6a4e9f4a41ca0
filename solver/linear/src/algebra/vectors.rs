//! Sums and products of long vectors, in parallel, with the same bits on any number of threads.

use rayon::prelude::*;

/// Numbers that are summed up on their own, whatever the number of threads.
const CHUNK: usize = 8192;
/// Sums side by side within them.
const LANES: usize = 8;

/// Scalar product.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    if a.len() <= CHUNK {
        return dot_of_chunk(a, b);
    }
    let chunks = a.par_chunks(CHUNK).zip(b.par_chunks(CHUNK));
    let sums: Vec<f64> = chunks.map(|(a, b)| dot_of_chunk(a, b)).collect();
    sums.into_iter().sum()
}

fn dot_of_chunk(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    let (a_lanes, b_lanes) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    let rest: f64 = a_lanes.remainder().iter().zip(b_lanes.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in a_lanes.zip(b_lanes) {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    sums.iter().sum::<f64>() + rest
}

/// Euclidean norm.
pub(super) fn norm(vector: &[f64]) -> f64 {
    dot(vector, vector).sqrt()
}

/// target += factor * from.
pub(super) fn add(factor: f64, from: &[f64], target: &mut [f64]) {
    combine(target, from, |value, from| value + factor * from);
}

/// Overwrites each value by what `of` gives for it and that of another vector.
pub(super) fn combine(target: &mut [f64], from: &[f64], of: impl Fn(f64, f64) -> f64 + Sync) {
    let work = |target: &mut [f64], from: &[f64]| {
        target.iter_mut().zip(from).for_each(|(value, from)| *value = of(*value, *from));
    };
    if target.len() <= CHUNK {
        return work(target, from);
    }
    let chunks = target.par_chunks_mut(CHUNK).zip(from.par_chunks(CHUNK));
    chunks.for_each(|(target, from)| work(target, from));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_over_chunks_are_those_of_all_numbers() {
        for n in [0, 5, CHUNK, 3 * CHUNK + 13] {
            let a: Vec<f64> = (0..n).map(|index| (index as f64 * 0.37).sin()).collect();
            let mut b: Vec<f64> = (0..n).map(|index| (index as f64 * 0.11).cos()).collect();
            let expected: f64 = a.iter().zip(&b).map(|(a, b)| a * b).sum();
            assert!((dot(&a, &b) - expected).abs() < 1e-10);
            add(2.0, &a, &mut b);
            let more = 2.0 * a.iter().map(|a| a * a).sum::<f64>();
            assert!((dot(&a, &b) - expected - more).abs() < 1e-10 * more.max(1.0));
        }
    }
}
