//! Forward and backward substitution in one front.

mod shared;
mod solve;
mod transposed;

use std::ops::Range;

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{
    solve_unit_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::{Accum, Par};

use super::dense::{view, view_mut};

/// Vectors of the substitutions, kept from one solve to the next: all segments, one after the other.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    /// Right-hand sides.
    pub b: Vec<f64>,
    /// Solutions.
    pub x: Vec<f64>,
}

/// Values of the unknowns of one front.
#[derive(Debug)]
pub(super) struct LocalValues {
    /// Of all or of the pivots.
    pub own: Vec<f64>,
    /// Of the border.
    pub border: Vec<f64>,
}

impl LocalValues {
    /// Of fronts of that order at most, for `n_sides` right-hand sides.
    pub fn new(largest_front: usize, n_sides: usize) -> Self {
        let zeros = vec![0.0; largest_front * n_sides];
        Self { own: zeros.clone(), border: zeros }
    }
}

/// A front as the substitutions see it: p pivots and q others.
pub(super) struct FrontFactors<'a> {
    /// (p + q) x p columns of L with U11.
    pub l: &'a [f64],
    /// p x q entries of U12.
    pub u: &'a [f64],
    /// Slots of the rows of the pivots.
    pub pivot_rows: &'a [u32],
    /// Slots of the other rows.
    pub border_rows: &'a [u32],
    /// Slots of the columns of the pivots.
    pub pivot_columns: &'a [u32],
    /// Slots of the other columns.
    pub border_columns: &'a [u32],
}

/// y += sum of four columns times factors.
#[inline(always)]
fn add_four(y: &mut [f64], columns: [&[f64]; 4], factors: [f64; 4]) {
    let n = y.len();
    let [a, b, c, d] = columns;
    let (a, b, c, d) = (&a[..n], &b[..n], &c[..n], &d[..n]);
    for i in 0..n {
        let left = a[i].mul_add(factors[0], b[i].mul_add(factors[1], y[i]));
        y[i] = c[i].mul_add(factors[2], d[i].mul_add(factors[3], left));
    }
}

#[inline(always)]
fn add_one(y: &mut [f64], column: &[f64], factor: f64) {
    for (y, value) in y.iter_mut().zip(column) {
        *y = value.mul_add(factor, *y);
    }
}

/// Reads the values in some slots.
#[inline(always)]
pub(super) fn gather(values: &mut [f64], from: &[f64], slots: &[u32]) {
    for (value, &slot) in values.iter_mut().zip(slots) {
        *value = from[slot as usize];
    }
}

/// Writes values to some slots.
#[inline(always)]
pub(super) fn scatter(values: &[f64], slots: &[u32], target: &mut [f64]) {
    for (value, &slot) in values.iter().zip(slots) {
        target[slot as usize] = *value;
    }
}

/// Whether there is nothing to eliminate: a load on bodies is zero but in the last fronts, and factors that are not read save
/// half of a substitution.
#[inline(always)]
pub(super) fn is_zero(values: &[f64]) -> bool {
    values.iter().all(|value| *value == 0.0)
}

/// b of the pivot rows becomes L11^-1 b, from b of the other rows L21 times that is subtracted.
#[inline(always)]
pub(super) fn forward(front: &FrontFactors<'_>, b: &mut [f64], local: &mut [f64]) {
    let p = front.pivot_rows.len();
    let m = p + front.border_rows.len();
    let local = &mut local[..m];
    gather(local, b, front.pivot_rows);
    if is_zero(&local[..p]) {
        return;
    }
    local[p..].fill(0.0);
    eliminate_down(front.l, m, 0..p, local);
    scatter(local, front.pivot_rows, b);
    for (&row, value) in front.border_rows.iter().zip(&local[p..]) {
        b[row as usize] += value;
    }
}

/// Eliminates the unknowns of some columns of L, of stride m, from the rows below them that `local` has.
#[inline(always)]
pub(super) fn eliminate_down(l: &[f64], m: usize, columns: Range<usize>, local: &mut [f64]) {
    let rows = local.len();
    let mut j = columns.start;
    while j + 4 <= columns.end {
        let columns = four_columns(l, m, j);
        let mut factors = [0.0; 4];
        for c in 0..4 {
            factors[c] = -local[j + c];
            for later in c + 1..4 {
                local[j + later] += columns[c][j + later] * factors[c];
            }
        }
        let [a, b, c, d] = columns;
        let below = [&a[j + 4..rows], &b[j + 4..rows], &c[j + 4..rows], &d[j + 4..rows]];
        add_four(&mut local[j + 4..], below, factors);
        j += 4;
    }
    for j in j..columns.end {
        let factor = -local[j];
        add_one(&mut local[j + 1..], &l[j * m + j + 1..j * m + rows], factor);
    }
}

/// x of the pivot columns from b of the pivot rows and x of the others.
#[inline(always)]
pub(super) fn backward(front: &FrontFactors<'_>, b: &[f64], x: &mut [f64], local: &mut [f64]) {
    let (p, q) = (front.pivot_rows.len(), front.border_columns.len());
    let local = &mut local[..p];
    gather(local, b, front.pivot_rows);
    // As `subtract_columns`, with factors from where they are: columns of U have few rows in most fronts,
    // and a copy of the factors would cost as much as the sums
    let mut columns = front.u.chunks_exact(p.max(1) * 4);
    let mut slots = front.border_columns.chunks_exact(4);
    for (four, slots) in (&mut columns).zip(&mut slots) {
        let factors = std::array::from_fn(|c| -x[slots[c] as usize]);
        add_four(local, std::array::from_fn(|c| &four[c * p..(c + 1) * p]), factors);
    }
    if p > 0 {
        for (column, &slot) in columns.remainder().chunks_exact(p).zip(slots.remainder()) {
            add_one(local, column, -x[slot as usize]);
        }
    }
    eliminate_up(front.l, p + q, 0..p, local);
    scatter(local, front.pivot_columns, x);
}

/// Solves for the unknowns of some columns of U, of stride m, the last first, and eliminates them from the
/// rows above them down to the first of these columns; those rows begin `local` at `columns.start`.
#[inline(always)]
pub(super) fn eliminate_up(l: &[f64], m: usize, columns: Range<usize>, local: &mut [f64]) {
    let first = columns.start;
    let mut j = columns.end;
    while j >= first + 4 {
        j -= 4;
        let [a, b, c, d] = four_columns(l, m, j);
        let columns = [&a[first..j + 4], &b[first..j + 4], &c[first..j + 4], &d[first..j + 4]];
        let mut factors = [0.0; 4];
        let own = j - first;
        for c in (0..4).rev() {
            let value = local[own + c] / columns[c][own + c];
            local[own + c] = value;
            factors[c] = -value;
            for earlier in 0..c {
                local[own + earlier] -= columns[c][own + earlier] * value;
            }
        }
        let [a, b, c, d] = columns;
        let above = [&a[..own], &b[..own], &c[..own], &d[..own]];
        add_four(&mut local[..own], above, factors);
    }
    for j in (first..j).rev() {
        let value = local[j - first] / l[j * m + j];
        local[j - first] = value;
        add_one(&mut local[..j - first], &l[j * m + first..j * m + j], -value);
    }
}

/// Four columns of a matrix of stride m, from column j on.
#[inline(always)]
fn four_columns(matrix: &[f64], m: usize, j: usize) -> [&[f64]; 4] {
    let (a, others) = matrix[j * m..(j + 4) * m].split_at(m);
    let (b, others) = others.split_at(m);
    let (c, d) = others.split_at(m);
    [a, b, c, d]
}

/// Columns of a matrix, `stride` apart, from some row on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Columns<'a> {
    pub values: &'a [f64],
    pub stride: usize,
    pub first_row: usize,
}

impl<'a> Columns<'a> {
    /// The same rows further down.
    pub fn below(self, rows: usize) -> Self {
        Self { first_row: self.first_row + rows, ..self }
    }

    #[inline(always)]
    fn column(self, index: usize, rows: usize) -> &'a [f64] {
        &self.values[index * self.stride + self.first_row..][..rows]
    }

    #[inline(always)]
    fn four(self, first: usize, rows: usize) -> [&'a [f64]; 4] {
        // Written out, because array::from_fn is not always inlined
        let [a, b, c, d] = [first, first + 1, first + 2, first + 3];
        [self.column(a, rows), self.column(b, rows), self.column(c, rows), self.column(d, rows)]
    }
}

/// Subtracts columns times factors, the first column first.
#[inline(always)]
pub(super) fn subtract_columns(columns: Columns<'_>, factors: &[f64], target: &mut [f64]) {
    let rows = target.len();
    let mut fours = factors.chunks_exact(4);
    let mut j = 0;
    for four in &mut fours {
        let factors = [-four[0], -four[1], -four[2], -four[3]];
        add_four(target, columns.four(j, rows), factors);
        j += 4;
    }
    for (j, factor) in (j..).zip(fours.remainder()) {
        add_one(target, columns.column(j, rows), -factor);
    }
}

/// The same, the last column first.
#[inline(always)]
pub(super) fn subtract_last_first(columns: Columns<'_>, factors: &[f64], target: &mut [f64]) {
    let rows = target.len();
    let mut j = factors.len();
    while j >= 4 {
        j -= 4;
        let four = [-factors[j], -factors[j + 1], -factors[j + 2], -factors[j + 3]];
        add_four(target, columns.four(j, rows), four);
    }
    for j in (0..j).rev() {
        add_one(target, columns.column(j, rows), -factors[j]);
    }
}

/// [`forward`] for several right-hand sides.
pub(super) fn forward_block(
    front: &FrontFactors<'_>,
    b: &mut [f64],
    local: &mut [f64],
    n_sides: usize,
) {
    let (p, q) = (front.pivot_rows.len(), front.border_rows.len());
    let (m, n) = (p + q, b.len() / n_sides);
    if p == 0 {
        return;
    }
    let local = &mut local[..m * n_sides];
    for (side, local) in b.chunks(n).zip(local.chunks_mut(m)) {
        gather(local, side, front.pivot_rows);
    }
    let (mut upper, lower) = view_mut(local, m, n_sides, m).split_at_row_mut(p);
    let unit_lower = view(front.l, p, p, m);
    solve_unit_lower_triangular_in_place(unit_lower, upper.as_mut(), Par::Seq);
    if q > 0 {
        let multipliers = view(&front.l[p..], q, p, m);
        matmul(lower, Accum::Replace, multipliers, upper.as_ref(), -1.0, Par::Seq);
    }
    for (side, local) in b.chunks_mut(n).zip(local.chunks(m)) {
        scatter(local, front.pivot_rows, side);
        for (&row, value) in front.border_rows.iter().zip(&local[p..]) {
            side[row as usize] += value;
        }
    }
}

/// [`backward`] for several right-hand sides.
pub(super) fn backward_block(
    front: &FrontFactors<'_>,
    b: &[f64],
    x: &mut [f64],
    values: &mut LocalValues,
    n_sides: usize,
) {
    let (p, q) = (front.pivot_rows.len(), front.border_columns.len());
    let (m, n) = (p + q, b.len() / n_sides);
    if p == 0 {
        return;
    }
    let LocalValues { own, border } = values;
    let local = &mut own[..p * n_sides];
    for (side, local) in b.chunks(n).zip(local.chunks_mut(p)) {
        gather(local, side, front.pivot_rows);
    }
    if q > 0 {
        let border = &mut border[..q * n_sides];
        for (side, border) in x.chunks(n).zip(border.chunks_mut(q)) {
            gather(border, side, front.border_columns);
        }
        let known = view(border, q, n_sides, q);
        let target = view_mut(local, p, n_sides, p);
        matmul(target, Accum::Add, view(front.u, p, q, p), known, -1.0, Par::Seq);
    }
    let upper = view(front.l, p, p, m);
    solve_upper_triangular_in_place(upper, view_mut(local, p, n_sides, p), Par::Seq);
    for (side, local) in x.chunks_mut(n).zip(local.chunks(p)) {
        scatter(local, front.pivot_columns, side);
    }
}
