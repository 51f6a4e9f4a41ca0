//! Solutions with factors: forward and backward substitution through all fronts.

use std::ops::Range;

use super::analysis::Analysis;
use super::factors::Factors;
use super::front::Front;
use super::substitution::{
    FrontFactors, Scratch, backward, backward_block, forward, forward_block,
};

/// Right-hand sides worked on together: the factors are read once for all of them.
const BLOCK: usize = 32;

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
        let fronts = 0..analysis.fronts.len();
        for block in x.chunks_mut(n * BLOCK) {
            let n_sides = block.len() / n;
            scratch.fit(n, self.largest_front(analysis, 0), n_sides);
            for (side, b) in block.chunks(n).zip(scratch.b.chunks_mut(n)) {
                for ((value, &unknown), &is_pressure) in
                    b.iter_mut().zip(&analysis.unknown_at).zip(&analysis.is_pressure_at)
                {
                    *value = side[unknown as usize] * self.scale(is_pressure);
                }
            }
            if n_sides == 1 {
                self.arch.dispatch(OneSide { factors: self, analysis, scratch: &mut scratch });
            } else {
                self.substitute_block(analysis, fronts.clone(), &mut scratch, n_sides);
            }
            for (side, x) in block.chunks_mut(n).zip(scratch.x.chunks(n)) {
                for ((value, &unknown), &is_pressure) in
                    x.iter().zip(&analysis.unknown_at).zip(&analysis.is_pressure_at)
                {
                    side[unknown as usize] = *value * self.scale(is_pressure);
                }
            }
        }
        self.scratch = scratch;
    }

    /// The block of the inverse in the rows and columns of some of the unknowns with dense rows, column
    /// by column: their values for unit right-hand sides in their own equations.
    ///
    /// They are eliminated last, so only the last fronts take part.
    ///
    /// # Panics
    /// When one of them is not among the unknowns with dense rows.
    pub fn inverse_of_dense(&mut self, analysis: &Analysis, unknowns: &[usize]) -> Vec<f64> {
        let n = analysis.n();
        let position = |unknown: &usize| {
            let is_it = |at: &u32| *at as usize == *unknown;
            assert!(analysis.dense.iter().any(is_it), "an unknown with a dense row");
            let position = analysis.unknown_at.iter().rposition(is_it);
            position.expect("every unknown has a position in the order of elimination")
        };
        let positions: Vec<usize> = unknowns.iter().map(position).collect();
        let Some(&earliest) = positions.iter().min() else { return Vec::new() };
        let first = analysis.fronts.partition_point(|front| front.start <= earliest) - 1;
        let mut scratch = std::mem::take(&mut self.scratch);
        let mut inverse = Vec::with_capacity(positions.len().pow(2));
        for block in positions.chunks(BLOCK) {
            scratch.fit(n, self.largest_front(analysis, first), block.len());
            scratch.b.fill(0.0);
            for (b, &position) in scratch.b.chunks_mut(n).zip(block) {
                b[position] = 1.0;
            }
            let fronts = first..analysis.fronts.len();
            self.substitute_block(analysis, fronts, &mut scratch, block.len());
            for x in scratch.x.chunks(n).take(block.len()) {
                inverse.extend(positions.iter().map(|&position| x[position]));
            }
        }
        self.scratch = scratch;
        inverse
    }

    /// The substitutions in the last fronts for several right-hand sides.
    fn substitute_block(
        &self,
        analysis: &Analysis,
        fronts: Range<usize>,
        scratch: &mut Scratch,
        n_sides: usize,
    ) {
        let Scratch { b, x, local, border } = scratch;
        for index in fronts.clone() {
            forward_block(&self.of_front(analysis, index), b, local, n_sides);
        }
        for index in fronts.rev() {
            backward_block(&self.of_front(analysis, index), b, x, local, border, n_sides);
        }
    }

    fn of_front<'a>(&'a self, analysis: &'a Analysis, index: usize) -> FrontFactors<'a> {
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
        let border = analysis.border_of(front);
        FrontFactors {
            l,
            u,
            pivot_rows: &self.pivot_rows[front.positions()],
            border_rows: border,
            pivot_columns: &analysis.pivot_positions[front.positions()],
            border_columns: border,
        }
    }

    /// Largest order of the fronts from `first` on, and of those with delayed pivots.
    fn largest_front(&self, analysis: &Analysis, first: usize) -> usize {
        let regular = analysis.fronts[first..].iter().map(Front::m);
        regular.chain(self.delayed.values().map(|own| own.rows.len())).fold(0, usize::max)
    }

    fn scale(&self, is_pressure: bool) -> f64 {
        if is_pressure { self.pressure_scale } else { 1.0 }
    }
}

/// The substitutions for one right-hand side: a type of our own, so that they are compiled for the
/// processor's vectors.
struct OneSide<'a> {
    factors: &'a Factors,
    analysis: &'a Analysis,
    scratch: &'a mut Scratch,
}

impl pulp::WithSimd for OneSide<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _simd: S) {
        let Self { factors, analysis, scratch } = self;
        let Scratch { b, x, local, .. } = scratch;
        for index in 0..analysis.fronts.len() {
            forward(&factors.of_front(analysis, index), b, local);
        }
        for index in (0..analysis.fronts.len()).rev() {
            backward(&factors.of_front(analysis, index), b, x, local);
        }
    }
}
