//! Solutions with factors: forward and backward substitution through all fronts.
//!
//! Subtrees are worked on at the same time, then the fronts above, in which threads share rows. What the
//! subtrees add to those above is added in their order: the bits are the same on any number of threads.

use rayon::prelude::*;

use super::super::analysis::Analysis;
use super::super::factorisation::{Delay, Factors};
use super::super::segments::{Segment, Slot};
use super::shared;
use super::{FrontFactors, LocalValues, Scratch, backward, backward_block, forward, forward_block};

/// Right-hand sides worked on together: the factors are read once for all of them.
const BLOCK: usize = 32;
/// Unknowns whose values a thread takes over at a time.
const CHUNK: usize = 4096;

/// A segment with its part of the vectors, one right-hand side after the other.
pub(super) struct Part<'a> {
    pub segment: &'a Segment,
    pub delays: &'a [Delay],
    pub b: &'a mut [f64],
    pub x: &'a mut [f64],
    n_sides: usize,
}

impl Factors {
    /// Solves A x = b in place for one or several right-hand sides, one after the other in `x`,
    /// each in the order of the unknowns.
    ///
    /// # Panics
    /// When the length of `x` is no multiple of the number of unknowns.
    pub fn solve(&mut self, analysis: &Analysis, x: &mut [f64]) {
        let n = analysis.n();
        if n == 0 {
            assert!(x.is_empty(), "a right-hand side without unknowns is empty");
            return;
        }
        assert_eq!(x.len() % n, 0, "whole right-hand sides");
        let mut scratch = std::mem::take(&mut self.scratch);
        for block in x.chunks_mut(n * BLOCK) {
            let n_sides = block.len() / n;
            let fill = |segment: &Segment, side: usize, b: &mut [f64]| {
                self.scaled(analysis, &block[side * n..(side + 1) * n], segment, b);
            };
            self.substitute(analysis, 0, &mut scratch, n_sides, fill);
            for (side, values) in block.chunks_mut(n).enumerate() {
                let starts = self.starts_of_side(analysis, side, n_sides);
                let slots = analysis.slots.par_chunks(CHUNK);
                values.par_chunks_mut(CHUNK).zip(slots).for_each(|(values, slots)| {
                    for (value, slot) in values.iter_mut().zip(slots) {
                        *value = scratch.x[starts[slot.segment as usize] + slot.index as usize];
                    }
                });
            }
        }
        self.scratch = scratch;
    }

    /// A segment's part of a right-hand side, with pressures in their scale.
    pub(super) fn scaled(
        &self,
        analysis: &Analysis,
        rhs: &[f64],
        segment: &Segment,
        b: &mut [f64],
    ) {
        let unknowns = &analysis.unknown_at[segment.positions.clone()];
        let is_pressure = &analysis.is_pressure_at[segment.positions.clone()];
        for ((value, &unknown), &is_pressure) in b.iter_mut().zip(unknowns).zip(is_pressure) {
            *value = rhs[unknown as usize] * self.scale(is_pressure);
        }
    }

    /// The block of the inverse in the rows and columns of some of the unknowns with dense rows, column
    /// by column: their values for unit right-hand sides in their own equations.
    ///
    /// They are eliminated last, so only the last fronts take part.
    ///
    /// # Panics
    /// When one of them is not among the unknowns with dense rows.
    pub fn inverse_of_dense(&mut self, analysis: &Analysis, unknowns: &[usize]) -> Vec<f64> {
        for unknown in unknowns {
            let is_it = |at: &u32| *at as usize == *unknown;
            assert!(analysis.dense.iter().any(is_it), "an unknown with a dense row");
        }
        let slots: Vec<Slot> = unknowns.iter().map(|&unknown| analysis.slots[unknown]).collect();
        let position = |slot: &Slot| {
            analysis.segments[slot.segment as usize].positions.start + slot.index as usize
        };
        let Some(earliest) = slots.iter().map(position).min() else { return Vec::new() };
        let first = analysis.fronts.partition_point(|front| front.start <= earliest) - 1;
        let mut scratch = std::mem::take(&mut self.scratch);
        let mut inverse = Vec::with_capacity(slots.len().pow(2));
        for block in slots.chunks(BLOCK) {
            let fill = |segment: &Segment, side: usize, b: &mut [f64]| {
                let slot = &block[side];
                b[..segment.positions.len()].fill(0.0);
                if segment.positions.contains(&position(slot)) {
                    b[slot.index as usize] = 1.0;
                }
            };
            self.substitute(analysis, first, &mut scratch, block.len(), fill);
            for side in 0..block.len() {
                let starts = self.starts_of_side(analysis, side, block.len());
                let values = slots
                    .iter()
                    .map(|slot| scratch.x[starts[slot.segment as usize] + slot.index as usize]);
                inverse.extend(values);
            }
        }
        self.scratch = scratch;
        inverse
    }

    /// The substitutions in the fronts from `first` on; `fill` gives a segment its own unknowns' part of the
    /// right-hand side of that number.
    fn substitute(
        &self,
        analysis: &Analysis,
        first: usize,
        scratch: &mut Scratch,
        n_sides: usize,
        fill: impl Fn(&Segment, usize, &mut [f64]) + Sync,
    ) {
        let mut parts = self.parts(analysis, scratch, n_sides);
        let Some((above, subtrees)) = parts.split_last_mut() else { return };
        let takes_part = |part: &&mut Part<'_>| part.segment.fronts.end > first;
        let subtrees: Vec<&mut Part<'_>> = subtrees.iter_mut().filter(takes_part).collect();
        let mut subtrees = subtrees;
        subtrees.par_iter_mut().with_max_len(1).for_each(|part| {
            part.fill(&fill);
            self.forward(analysis, part, first, false);
        });
        above.fill(&fill);
        for part in &subtrees {
            above.add_from(part);
        }
        // One thread alone comes to the same bits
        let is_shared = rayon::current_num_threads() > 1;
        self.forward(analysis, above, first, is_shared);
        self.backward(analysis, above, first, is_shared);
        let copied = &*above;
        // The last first: their factors are still in the cache
        subtrees.par_iter_mut().rev().with_max_len(1).for_each(|part| {
            part.copy_from(copied);
            self.backward(analysis, part, first, false);
            self.scale_pressures(analysis, part);
        });
        self.scale_pressures(analysis, above);
    }

    /// The vectors, cut into segments.
    pub(super) fn parts<'a>(
        &'a self,
        analysis: &'a Analysis,
        scratch: &'a mut Scratch,
        n_sides: usize,
    ) -> Vec<Part<'a>> {
        let starts = self.starts(analysis, n_sides);
        let n = starts.last().map_or(0, |end| *end);
        scratch.b.resize(n, 0.0);
        scratch.x.resize(n, 0.0);
        let (mut b, mut x) = (&mut *scratch.b, &mut *scratch.x);
        let mut parts = Vec::with_capacity(analysis.segments.len());
        for (index, segment) in analysis.segments.iter().enumerate() {
            let size = starts[index + 1] - starts[index];
            let own = |vector: &mut &'a mut [f64]| {
                vector.split_off_mut(..size).expect("the vectors have all segments")
            };
            let delays = self.delays.of_subtrees.get(index).map_or(&[][..], Vec::as_slice);
            parts.push(Part { segment, delays, b: own(&mut b), x: own(&mut x), n_sides });
        }
        parts
    }

    /// Where each segment begins in the vectors, and the end of the last.
    fn starts(&self, analysis: &Analysis, n_sides: usize) -> Vec<usize> {
        let n_segments = analysis.segments.len();
        let size = |index: usize| {
            let n_delayed = if index + 1 == n_segments { self.delays.len() } else { 0 };
            (analysis.segments[index].n_slots() + n_delayed) * n_sides
        };
        let mut starts = vec![0];
        for index in 0..n_segments {
            starts.push(starts[index] + size(index));
        }
        starts
    }

    /// Where each segment has the values of one right-hand side.
    pub(super) fn starts_of_side(
        &self,
        analysis: &Analysis,
        side: usize,
        n_sides: usize,
    ) -> Vec<usize> {
        let starts = self.starts(analysis, n_sides);
        let of_side = starts.windows(2).map(|ends| ends[0] + (ends[1] - ends[0]) / n_sides * side);
        of_side.collect()
    }

    /// Gives the pressures of a segment their own scale again.
    pub(super) fn scale_pressures(&self, analysis: &Analysis, part: &mut Part<'_>) {
        let n_slots = part.n_slots().max(1);
        let is_pressure = &analysis.is_pressure_at[part.segment.positions.clone()];
        for x in part.x.chunks_mut(n_slots) {
            for (value, &is_pressure) in x.iter_mut().zip(is_pressure) {
                *value *= self.scale(is_pressure);
            }
        }
    }

    /// Forward substitution in a segment, in the fronts from `first` on.
    fn forward(&self, analysis: &Analysis, part: &mut Part<'_>, first: usize, is_shared: bool) {
        let mut values = self.local_values(part);
        let fronts = part.segment.fronts.start.max(first)..part.segment.fronts.end;
        let (b, n_sides) = (&mut *part.b, part.n_sides);
        match (n_sides, is_shared) {
            (1, false) => {
                let fronts = fronts.map(|index| self.of_front(analysis, index));
                self.arch.dispatch(Forward { fronts, b, values: &mut values });
            }
            (1, true) => fronts.for_each(|index| {
                shared::forward(self.arch, &self.of_front(analysis, index), b, &mut values.own);
            }),
            _ => fronts.for_each(|index| {
                forward_block(&self.of_front(analysis, index), b, &mut values.own, n_sides);
            }),
        }
    }

    /// Backward substitution in a segment, in the fronts from `first` on.
    fn backward(&self, analysis: &Analysis, part: &mut Part<'_>, first: usize, is_shared: bool) {
        let mut values = self.local_values(part);
        let fronts = part.segment.fronts.start.max(first)..part.segment.fronts.end;
        let (b, x, n_sides) = (&*part.b, &mut *part.x, part.n_sides);
        match (n_sides, is_shared) {
            (1, false) => {
                let fronts = fronts.rev().map(|index| self.of_front(analysis, index));
                self.arch.dispatch(Backward { fronts, b, x, values: &mut values });
            }
            (1, true) => fronts.rev().for_each(|index| {
                shared::backward(self.arch, &self.of_front(analysis, index), b, x, &mut values);
            }),
            _ => fronts.rev().for_each(|index| {
                backward_block(&self.of_front(analysis, index), b, x, &mut values, n_sides);
            }),
        }
    }

    pub(super) fn of_front<'a>(&'a self, analysis: &'a Analysis, index: usize) -> FrontFactors<'a> {
        if let Some(own) = self.delayed.get(&index) {
            let (pivot_rows, border_rows) = own.rows.split_at(own.n_pivots);
            let (pivot_columns, border_columns) = own.columns.split_at(own.n_pivots);
            return FrontFactors {
                l: &own.l,
                u: &own.u,
                pivot_rows,
                border_rows,
                pivot_columns,
                border_columns,
            };
        }
        let front = &analysis.fronts[index];
        let values = &self.values[front.values..front.values + front.n_values()];
        let (l, u) = values.split_at(front.m() * front.k);
        let border = analysis.border_slots_of(front);
        FrontFactors {
            l,
            u,
            pivot_rows: &self.pivot_rows[front.positions()],
            border_rows: border,
            pivot_columns: &analysis.pivot_slots[front.slots()],
            border_columns: border,
        }
    }

    pub(super) fn local_values(&self, part: &Part<'_>) -> LocalValues {
        let delayed = self.delayed.range(part.segment.fronts.clone());
        let orders = delayed.map(|(_, own)| own.rows.len());
        LocalValues::new(orders.fold(part.segment.largest_front, usize::max), part.n_sides)
    }

    fn scale(&self, is_pressure: bool) -> f64 {
        if is_pressure { self.pressure_scale } else { 1.0 }
    }
}

impl Part<'_> {
    /// Slots of one right-hand side.
    fn n_slots(&self) -> usize {
        self.b.len() / self.n_sides
    }

    /// Overwrites the right-hand sides of the own unknowns by what `fill` gives, those of the others by zero.
    pub(super) fn fill(&mut self, fill: &impl Fn(&Segment, usize, &mut [f64])) {
        let (n_slots, n_own) = (self.n_slots(), self.segment.positions.len());
        for (side, b) in self.b.chunks_mut(n_slots.max(1)).enumerate() {
            fill(self.segment, side, b);
            b[n_own..].fill(0.0);
        }
    }

    /// Adds what a subtree has for the right-hand sides of the unknowns above it.
    pub(super) fn add_from(&mut self, subtree: &Part<'_>) {
        let start = self.segment.positions.start;
        let (n_above, n_own) = (self.n_slots().max(1), subtree.segment.positions.len());
        let of_subtree = subtree.b.chunks(subtree.n_slots().max(1));
        for (b, of_subtree) in self.b.chunks_mut(n_above).zip(of_subtree) {
            for (&position, value) in subtree.segment.copies.iter().zip(&of_subtree[n_own..]) {
                b[position as usize - start] += value;
            }
            for delay in subtree.delays {
                b[delay.above as usize] = of_subtree[delay.row as usize];
            }
        }
    }

    /// Copies the solutions of the unknowns above.
    pub(super) fn copy_from(&mut self, above: &Part<'_>) {
        let start = above.segment.positions.start;
        let (n_slots, n_own) = (self.n_slots().max(1), self.segment.positions.len());
        let of_above = above.x.chunks(above.n_slots().max(1));
        for (x, above) in self.x.chunks_mut(n_slots).zip(of_above) {
            for (&position, value) in self.segment.copies.iter().zip(&mut x[n_own..]) {
                *value = above[position as usize - start];
            }
            for delay in self.delays {
                x[delay.column as usize] = above[delay.above as usize];
            }
        }
    }
}

/// The substitutions for one right-hand side: types of our own, so that they are compiled for the
/// processor's vectors.
struct Forward<'a, I> {
    fronts: I,
    b: &'a mut [f64],
    values: &'a mut LocalValues,
}

impl<'a, I: Iterator<Item = FrontFactors<'a>>> pulp::WithSimd for Forward<'_, I> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _simd: S) {
        let Self { fronts, b, values } = self;
        for front in fronts {
            forward(&front, b, &mut values.own);
        }
    }
}

struct Backward<'a, I> {
    fronts: I,
    b: &'a [f64],
    x: &'a mut [f64],
    values: &'a mut LocalValues,
}

impl<'a, I: Iterator<Item = FrontFactors<'a>>> pulp::WithSimd for Backward<'_, I> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _simd: S) {
        let Self { fronts, b, x, values } = self;
        for front in fronts {
            backward(&front, b, x, &mut values.own);
        }
    }
}
