//! Forward and backward substitution in one large front by all threads.
//!
//! One thread solves for a block of unknowns, then all eliminate them from the other rows, each from rows of
//! its own. What is done to a row does not depend on who does it: the bits are those of one thread.

use std::ops::Range;

use rayon::prelude::*;

use super::{
    Columns, FrontFactors, LocalValues, eliminate_down, eliminate_up, gather, is_zero, scatter,
    subtract_columns, subtract_last_first,
};

/// Columns of a block: few enough that one thread is soon done with it, a multiple of four.
const BLOCK: usize = 64;
/// Entries of a matrix below which sharing it takes longer than reading it.
const SMALL: usize = 1 << 14;
/// Rows that a thread takes at least: what it reads of a column is some lines of the cache.
const MIN_ROWS: usize = 64;

/// The order in which columns are subtracted, which decides the rounding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Order {
    FirstFirst,
    LastFirst,
}

/// As `substitution::forward`.
pub(super) fn forward(
    arch: pulp::Arch,
    front: &FrontFactors<'_>,
    b: &mut [f64],
    local: &mut [f64],
) {
    let p = front.pivot_rows.len();
    let m = p + front.border_rows.len();
    let local = &mut local[..m];
    gather(local, b, front.pivot_rows);
    if is_zero(&local[..p]) {
        return;
    }
    local[p..].fill(0.0);
    for start in (0..p).step_by(BLOCK) {
        let end = (start + BLOCK).min(p);
        let (solved, below) = local.split_at_mut(end);
        arch.dispatch(Triangle {
            l: front.l,
            m,
            columns: start..end,
            local: solved,
            is_lower: true,
        });
        let columns = Columns { values: &front.l[start * m..], stride: m, first_row: end };
        subtract(arch, columns, &solved[start..], below, Order::FirstFirst);
    }
    scatter(local, front.pivot_rows, b);
    for (&row, value) in front.border_rows.iter().zip(&local[p..]) {
        b[row as usize] += value;
    }
}

/// As `substitution::backward`.
pub(super) fn backward(
    arch: pulp::Arch,
    front: &FrontFactors<'_>,
    b: &[f64],
    x: &mut [f64],
    values: &mut LocalValues,
) {
    let (p, q) = (front.pivot_rows.len(), front.border_columns.len());
    let (local, border) = (&mut values.own[..p], &mut values.border[..q]);
    gather(local, b, front.pivot_rows);
    gather(border, x, front.border_columns);
    let upper = Columns { values: front.u, stride: p, first_row: 0 };
    subtract(arch, upper, border, local, Order::FirstFirst);
    let m = p + q;
    let mut end = p;
    while end > 0 {
        let start = end.saturating_sub(BLOCK);
        let (above, own) = local[..end].split_at_mut(start);
        arch.dispatch(Triangle { l: front.l, m, columns: start..end, local: own, is_lower: false });
        let columns = Columns { values: &front.l[start * m..], stride: m, first_row: 0 };
        subtract(arch, columns, own, above, Order::LastFirst);
        end = start;
    }
    scatter(local, front.pivot_columns, x);
}

/// Subtracts columns times factors, by all threads where that pays.
fn subtract(
    arch: pulp::Arch,
    columns: Columns<'_>,
    factors: &[f64],
    target: &mut [f64],
    order: Order,
) {
    if target.len() * factors.len() < SMALL {
        return arch.dispatch(Rows { columns, factors, target, order });
    }
    let even = target.len().div_ceil(2 * rayon::current_num_threads());
    let n_rows = even.next_multiple_of(8).max(MIN_ROWS);
    target.par_chunks_mut(n_rows).enumerate().for_each(|(index, target)| {
        let columns = columns.below(index * n_rows);
        arch.dispatch(Rows { columns, factors, target, order });
    });
}

/// The triangle of a block of columns: types of our own, so that they are compiled for the processor's vectors.
struct Triangle<'a> {
    l: &'a [f64],
    m: usize,
    columns: Range<usize>,
    local: &'a mut [f64],
    is_lower: bool,
}

impl pulp::WithSimd for Triangle<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _simd: S) {
        let Self { l, m, columns, local, is_lower } = self;
        if is_lower {
            eliminate_down(l, m, columns, local);
        } else {
            eliminate_up(l, m, columns, local);
        }
    }
}

/// Rows from which columns are subtracted.
struct Rows<'a> {
    columns: Columns<'a>,
    factors: &'a [f64],
    target: &'a mut [f64],
    order: Order,
}

impl pulp::WithSimd for Rows<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _simd: S) {
        let Self { columns, factors, target, order } = self;
        match order {
            Order::FirstFirst => subtract_columns(columns, factors, target),
            Order::LastFirst => subtract_last_first(columns, factors, target),
        }
    }
}
