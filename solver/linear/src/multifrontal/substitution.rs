//! Forward and backward substitution in one front.

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{
    solve_unit_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::{Accum, Par};

use super::dense::{view, view_mut};

/// Vectors of the substitutions, kept from one solve to the next.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    /// Right-hand sides in the order of elimination.
    pub b: Vec<f64>,
    /// Solutions in the order of elimination.
    pub x: Vec<f64>,
    /// Values of the unknowns of a front.
    pub local: Vec<f64>,
    /// Values of the border of a front.
    pub border: Vec<f64>,
}

impl Scratch {
    /// Sets the sizes for `n_sides` right-hand sides of n values, and fronts of that order at most.
    pub fn fit(&mut self, n: usize, largest_front: usize, n_sides: usize) {
        self.b.resize(n * n_sides, 0.0);
        self.x.resize(n * n_sides, 0.0);
        self.local.resize(largest_front * n_sides, 0.0);
        self.border.resize(largest_front * n_sides, 0.0);
    }
}

/// A front as the substitutions see it: p pivots and q others.
pub(super) struct FrontFactors<'a> {
    /// (p + q) x p columns of L with U11.
    pub l: &'a [f64],
    /// p x q entries of U12.
    pub u: &'a [f64],
    /// Positions of the rows of the pivots.
    pub pivot_rows: &'a [u32],
    /// Positions of the other rows.
    pub border_rows: &'a [u32],
    /// Positions of the columns of the pivots.
    pub pivot_columns: &'a [u32],
    /// Positions of the other columns.
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

/// Reads the values at some positions.
#[inline(always)]
fn gather(values: &mut [f64], from: &[f64], positions: &[u32]) {
    for (value, &position) in values.iter_mut().zip(positions) {
        *value = from[position as usize];
    }
}

/// Writes values to some positions.
#[inline(always)]
fn scatter(values: &[f64], positions: &[u32], target: &mut [f64]) {
    for (value, &position) in values.iter().zip(positions) {
        target[position as usize] = *value;
    }
}

/// b of the pivot rows becomes L11^-1 b, from b of the other rows L21 times that is subtracted.
#[inline(always)]
pub(super) fn forward(front: &FrontFactors<'_>, b: &mut [f64], local: &mut [f64]) {
    let p = front.pivot_rows.len();
    let m = p + front.border_rows.len();
    let local = &mut local[..m];
    gather(local, b, front.pivot_rows);
    local[p..].fill(0.0);
    let mut j = 0;
    while j + 4 <= p {
        let columns: [&[f64]; 4] = std::array::from_fn(|c| &front.l[(j + c) * m..(j + c + 1) * m]);
        let mut factors = [0.0; 4];
        for c in 0..4 {
            factors[c] = -local[j + c];
            for later in c + 1..4 {
                local[j + later] += columns[c][j + later] * factors[c];
            }
        }
        let below = columns.map(|column| &column[j + 4..]);
        add_four(&mut local[j + 4..], below, factors);
        j += 4;
    }
    for j in j..p {
        let factor = -local[j];
        add_one(&mut local[j + 1..], &front.l[j * m + j + 1..(j + 1) * m], factor);
    }
    scatter(local, front.pivot_rows, b);
    for (&row, value) in front.border_rows.iter().zip(&local[p..]) {
        b[row as usize] += value;
    }
}

/// x of the pivot columns from b of the pivot rows and x of the others.
#[inline(always)]
pub(super) fn backward(front: &FrontFactors<'_>, b: &[f64], x: &mut [f64], local: &mut [f64]) {
    let p = front.pivot_rows.len();
    let m = p + front.border_rows.len();
    let local = &mut local[..p];
    gather(local, b, front.pivot_rows);
    let mut columns = front.u.chunks_exact(p.max(1) * 4);
    let mut positions = front.border_columns.chunks_exact(4);
    for (four, positions) in (&mut columns).zip(&mut positions) {
        let factors = std::array::from_fn(|c| -x[positions[c] as usize]);
        add_four(local, std::array::from_fn(|c| &four[c * p..(c + 1) * p]), factors);
    }
    if p > 0 {
        for (column, &position) in columns.remainder().chunks_exact(p).zip(positions.remainder()) {
            add_one(local, column, -x[position as usize]);
        }
    }
    let mut j = p;
    while j >= 4 {
        j -= 4;
        let columns: [&[f64]; 4] =
            std::array::from_fn(|c| &front.l[(j + c) * m..(j + c) * m + j + 4]);
        let mut factors = [0.0; 4];
        for c in (0..4).rev() {
            let value = local[j + c] / columns[c][j + c];
            local[j + c] = value;
            factors[c] = -value;
            for earlier in 0..c {
                local[j + earlier] -= columns[c][j + earlier] * value;
            }
        }
        let above = columns.map(|column| &column[..j]);
        add_four(&mut local[..j], above, factors);
    }
    for j in (0..j).rev() {
        let value = local[j] / front.l[j * m + j];
        local[j] = value;
        add_one(&mut local[..j], &front.l[j * m..j * m + j], -value);
    }
    scatter(local, front.pivot_columns, x);
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

/// [`backward`] for several right-hand sides; `border` is workspace.
pub(super) fn backward_block(
    front: &FrontFactors<'_>,
    b: &[f64],
    x: &mut [f64],
    local: &mut [f64],
    border: &mut [f64],
    n_sides: usize,
) {
    let (p, q) = (front.pivot_rows.len(), front.border_columns.len());
    let (m, n) = (p + q, b.len() / n_sides);
    if p == 0 {
        return;
    }
    let local = &mut local[..p * n_sides];
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
