//! Runs of indices in a front: what a child adds to its parent, several values at a time.

use crate::sparse::index::to_u32;

/// Indices that follow each other, such as those of the velocities at a node.
#[derive(Debug, Clone, Copy)]
pub(super) struct Run {
    first: u32,
    length: u32,
}

/// Runs of indices, less `start`.
pub(super) fn runs(indices: &[u32], start: usize) -> Vec<Run> {
    let all = indices.chunk_by(|last, next| last + 1 == *next);
    all.map(|run| Run { first: run[0] - to_u32(start), length: to_u32(run.len()) }).collect()
}

/// Adds values, one run after the other, to those they belong to.
pub(super) fn add_runs(runs: &[Run], mut values: &[f64], target: &mut [f64]) {
    for run in runs {
        let (these, rest) = values.split_at(run.length as usize);
        let target = &mut target[run.first as usize..][..these.len()];
        target.iter_mut().zip(these).for_each(|(target, value)| *target += value);
        values = rest;
    }
}
