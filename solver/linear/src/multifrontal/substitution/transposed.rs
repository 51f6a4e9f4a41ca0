//! Solutions of transposed systems with the same factors.
//!
//! A = L U in the order of the pivots, so A^T x = c is U^T z = c and then L^T x = z: a forward substitution through all
//! fronts with the columns of U, by slots of columns, and a backward one with those of L, whose results stand in the slots of
//! rows. A subtree delays columns on the way up and gets rows on the way down.

use rayon::prelude::*;

use super::super::analysis::Analysis;
use super::super::factorisation::Factors;
use super::super::segments::Segment;
use super::solve::Part;
use super::{FrontFactors, LocalValues, Scratch, gather, scatter};

impl Factors {
    /// Solves A^T x = b in place, in the order of the unknowns. The bits are the same on any number of threads.
    ///
    /// # Panics
    /// When there is not one value for each unknown.
    pub fn solve_transposed(&mut self, analysis: &Analysis, x: &mut [f64]) {
        assert_eq!(x.len(), analysis.n(), "a right-hand side has a value for each unknown");
        let mut scratch = std::mem::take(&mut self.scratch);
        self.substitute_transposed(analysis, &mut scratch, x);
        let starts = self.starts_of_side(analysis, 0, 1);
        for (value, slot) in x.iter_mut().zip(&analysis.slots) {
            *value = scratch.x[starts[slot.segment as usize] + slot.index as usize];
        }
        self.scratch = scratch;
    }

    fn substitute_transposed(&self, analysis: &Analysis, scratch: &mut Scratch, rhs: &[f64]) {
        let fill = |segment: &Segment, _: usize, b: &mut [f64]| {
            self.scaled(analysis, rhs, segment, b);
        };
        let mut parts = self.parts(analysis, scratch, 1);
        let Some((above, subtrees)) = parts.split_last_mut() else { return };
        subtrees.par_iter_mut().with_max_len(1).for_each(|part| {
            part.fill(&fill);
            self.forward_transposed(analysis, part);
        });
        above.fill(&fill);
        for part in subtrees.iter() {
            above.add_from(part);
            for delay in part.delays {
                above.b[delay.above as usize] = part.b[delay.column as usize];
            }
        }
        self.forward_transposed(analysis, above);
        self.backward_transposed(analysis, above);
        let copied = &*above;
        subtrees.par_iter_mut().with_max_len(1).for_each(|part| {
            part.copy_from(copied);
            for delay in part.delays {
                part.x[delay.row as usize] = copied.x[delay.above as usize];
            }
            self.backward_transposed(analysis, part);
            self.scale_pressures(analysis, part);
        });
        self.scale_pressures(analysis, above);
    }

    fn forward_transposed(&self, analysis: &Analysis, part: &mut Part<'_>) {
        let mut values = self.local_values(part);
        for index in part.segment.fronts.clone() {
            forward(&self.of_front(analysis, index), part.b, &mut values.own);
        }
    }

    fn backward_transposed(&self, analysis: &Analysis, part: &mut Part<'_>) {
        let mut values = self.local_values(part);
        for index in part.segment.fronts.clone().rev() {
            backward(&self.of_front(analysis, index), part.b, part.x, &mut values);
        }
    }
}

/// b of the pivot columns becomes U11^-T b, from b of the other columns U12^T times that is subtracted.
fn forward(front: &FrontFactors<'_>, b: &mut [f64], local: &mut [f64]) {
    let p = front.pivot_columns.len();
    if p == 0 {
        return;
    }
    let m = p + front.border_rows.len();
    let local = &mut local[..p];
    gather(local, b, front.pivot_columns);
    for (j, column) in front.l.chunks_exact(m).enumerate() {
        local[j] = (local[j] - dot(&column[..j], &local[..j])) / column[j];
    }
    scatter(local, front.pivot_columns, b);
    for (column, &slot) in front.u.chunks_exact(p).zip(front.border_columns) {
        b[slot as usize] -= dot(column, local);
    }
}

/// x of the pivot rows from b of the pivot columns and x of the other rows.
fn backward(front: &FrontFactors<'_>, b: &[f64], x: &mut [f64], values: &mut LocalValues) {
    let (p, q) = (front.pivot_rows.len(), front.border_rows.len());
    if p == 0 {
        return;
    }
    let (local, border) = (&mut values.own[..p], &mut values.border[..q]);
    gather(local, b, front.pivot_columns);
    gather(border, x, front.border_rows);
    for (j, column) in front.l.chunks_exact(p + q).enumerate().rev() {
        let (own, below) = column.split_at(p);
        local[j] -= dot(&own[j + 1..], &local[j + 1..]) + dot(below, border);
    }
    scatter(local, front.pivot_rows, x);
}

fn dot(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(one, other)| one * other).sum()
}
