//! Forward and backward substitution.

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{
    solve_unit_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::{Accum, Par};

use super::analysis::{Analysis, Front};
use super::dense::{view, view_mut};
use super::factors::Factors;

/// Right-hand sides worked on together: the factors are read once for all of them.
const BLOCK: usize = 32;

/// Vectors of the substitutions, kept from one solve to the next.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    b: Vec<f64>,
    solution: Vec<f64>,
    local: Vec<f64>,
    others: Vec<f64>,
}

/// A front as the substitutions see it: p pivots and q others.
struct View<'a> {
    l: &'a [f64],
    u: &'a [f64],
    pivot_rows: &'a [u32],
    rest_rows: &'a [u32],
    pivot_columns: &'a [u32],
    rest_columns: &'a [u32],
}

impl Factors {
    fn view<'a>(&'a self, analysis: &'a Analysis, index: usize) -> View<'a> {
        if let Some(own) = self.irregular.get(&index) {
            let (pivot_rows, rest_rows) = own.rows.split_at(own.pivots);
            let (pivot_columns, rest_columns) = own.columns.split_at(own.pivots);
            return View {
                l: &own.l,
                u: &own.u,
                pivot_rows,
                rest_rows,
                pivot_columns,
                rest_columns,
            };
        }
        let front = &analysis.fronts[index];
        let values = &self.values[front.values..front.values + front.n_values()];
        let (l, u) = values.split_at(front.m() * front.k);
        let rest = analysis.rest_of(front);
        let own = front.start..front.start + front.k;
        View {
            l,
            u,
            pivot_rows: &self.pivot_rows[own.clone()],
            rest_rows: rest,
            pivot_columns: &analysis.places[own],
            rest_columns: rest,
        }
    }

    /// Solves A x = b in place for one or several right-hand sides, one after the other in `x`,
    /// each in the order of the unknowns.
    ///
    /// # Panics
    /// When the length of `x` is no multiple of the number of unknowns.
    pub fn solve(&mut self, analysis: &Analysis, x: &mut [f64]) {
        let n = analysis.n();
        assert_eq!(x.len() % n.max(1), 0, "whole right-hand sides");
        let largest = analysis.fronts.iter().map(Front::m).max().unwrap_or(0);
        let largest = self.irregular.values().map(|own| own.rows.len()).fold(largest, usize::max);
        let mut scratch = std::mem::take(&mut self.scratch);
        for block in x.chunks_mut(n.max(1) * BLOCK) {
            let n_sides = block.len() / n;
            let Scratch { b, solution, local, others } = &mut scratch;
            b.resize(n * n_sides, 0.0);
            solution.resize(n * n_sides, 0.0);
            local.resize(largest * n_sides, 0.0);
            for (side, b) in block.chunks(n).zip(b.chunks_mut(n)) {
                for ((value, &unknown), &is_pressure) in
                    b.iter_mut().zip(&analysis.unknown_at).zip(&analysis.is_pressure_at)
                {
                    *value = side[unknown as usize] * self.scale(is_pressure);
                }
            }
            if n_sides == 1 {
                let one = One { factors: self, analysis, b, solution, local };
                self.arch.dispatch(one);
            } else {
                others.resize(largest * n_sides, 0.0);
                for index in 0..analysis.fronts.len() {
                    forward_block(&self.view(analysis, index), b, local, n_sides);
                }
                for index in (0..analysis.fronts.len()).rev() {
                    let view = self.view(analysis, index);
                    backward_block(&view, b, solution, local, others, n_sides);
                }
            }
            for (side, solution) in block.chunks_mut(n).zip(solution.chunks(n)) {
                for ((value, &unknown), &is_pressure) in
                    solution.iter().zip(&analysis.unknown_at).zip(&analysis.is_pressure_at)
                {
                    side[unknown as usize] = *value * self.scale(is_pressure);
                }
            }
        }
        self.scratch = scratch;
    }

    /// The block of the inverse in the rows and columns of some of the unknowns with dense rows,
    /// column by column: how they answer unit right-hand sides of their own equations.
    ///
    /// They are eliminated last, so only the last fronts take part.
    ///
    /// # Panics
    /// When one of them is not among the unknowns with dense rows.
    pub fn inverse_of_dense(&mut self, analysis: &Analysis, unknowns: &[usize]) -> Vec<f64> {
        let (n, n_dense) = (analysis.n(), unknowns.len());
        let place = |unknown: &usize| {
            assert!(analysis.dense.contains(&(*unknown as u32)), "an unknown with a dense row");
            let mut places = analysis.unknown_at.iter();
            places.rposition(|at| *at as usize == *unknown).unwrap_or(0)
        };
        let places: Vec<usize> = unknowns.iter().map(place).collect();
        let Some(&earliest) = places.iter().min() else { return Vec::new() };
        let first = analysis.fronts.partition_point(|front| front.start <= earliest) - 1;
        let largest = analysis.fronts[first..].iter().map(Front::m).max().unwrap_or(0);
        let largest = self.irregular.values().map(|own| own.rows.len()).fold(largest, usize::max);
        let mut scratch = std::mem::take(&mut self.scratch);
        let mut inverse = Vec::with_capacity(n_dense * n_dense);
        for block in places.chunks(BLOCK) {
            let n_sides = block.len();
            let Scratch { b, solution, local, others } = &mut scratch;
            b.resize(n * n_sides, 0.0);
            b.fill(0.0);
            solution.resize(n * n_sides, 0.0);
            local.resize(largest * n_sides, 0.0);
            others.resize(largest * n_sides, 0.0);
            for (side, &place) in block.iter().enumerate() {
                b[side * n + place] = 1.0;
            }
            for index in first..analysis.fronts.len() {
                forward_block(&self.view(analysis, index), b, local, n_sides);
            }
            for index in (first..analysis.fronts.len()).rev() {
                let view = self.view(analysis, index);
                backward_block(&view, b, solution, local, others, n_sides);
            }
            for side in solution.chunks(n).take(n_sides) {
                inverse.extend(places.iter().map(|&place| side[place]));
            }
        }
        self.scratch = scratch;
        inverse
    }

    fn scale(&self, is_pressure: bool) -> f64 {
        if is_pressure { self.pressure_scale } else { 1.0 }
    }
}

/// The substitutions for one right-hand side: a type of our own, so that they are compiled for the
/// processor's vectors.
struct One<'a> {
    factors: &'a Factors,
    analysis: &'a Analysis,
    b: &'a mut [f64],
    solution: &'a mut [f64],
    local: &'a mut [f64],
}

impl pulp::WithSimd for One<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _simd: S) {
        let Self { factors, analysis, b, solution, local } = self;
        for index in 0..analysis.fronts.len() {
            forward(&factors.view(analysis, index), b, local);
        }
        for index in (0..analysis.fronts.len()).rev() {
            backward(&factors.view(analysis, index), b, solution, local);
        }
    }
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

/// The values at some places, as many as there are places.
#[inline(always)]
fn gather(values: &mut [f64], from: &[f64], places: &[u32]) {
    for (value, &place) in values.iter_mut().zip(places) {
        *value = from[place as usize];
    }
}

/// Writes values to their places.
#[inline(always)]
fn put(values: &[f64], places: &[u32], target: &mut [f64]) {
    for (value, &place) in values.iter().zip(places) {
        target[place as usize] = *value;
    }
}

/// b of the pivot rows becomes L^-1 b, and the other rows lose what the pivots explain.
#[inline(always)]
fn forward(view: &View<'_>, b: &mut [f64], local: &mut [f64]) {
    let p = view.pivot_rows.len();
    let m = p + view.rest_rows.len();
    let local = &mut local[..m];
    gather(local, b, view.pivot_rows);
    local[p..].fill(0.0);
    let mut j = 0;
    while j + 4 <= p {
        let columns: [&[f64]; 4] = std::array::from_fn(|c| &view.l[(j + c) * m..(j + c + 1) * m]);
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
        add_one(&mut local[j + 1..], &view.l[j * m + j + 1..(j + 1) * m], factor);
    }
    put(local, view.pivot_rows, b);
    for (&row, value) in view.rest_rows.iter().zip(&local[p..]) {
        b[row as usize] += value;
    }
}

/// x of the pivot columns from b of the pivot rows and x of the others.
#[inline(always)]
fn backward(view: &View<'_>, b: &[f64], x: &mut [f64], local: &mut [f64]) {
    let p = view.pivot_rows.len();
    let m = p + view.rest_rows.len();
    let local = &mut local[..p];
    gather(local, b, view.pivot_rows);
    let mut columns = view.u.chunks_exact(p.max(1) * 4);
    let mut rest = view.rest_columns.chunks_exact(4);
    for (four, places) in (&mut columns).zip(&mut rest) {
        let factors = std::array::from_fn(|c| -x[places[c] as usize]);
        add_four(local, std::array::from_fn(|c| &four[c * p..(c + 1) * p]), factors);
    }
    if p > 0 {
        for (column, &place) in columns.remainder().chunks_exact(p).zip(rest.remainder()) {
            add_one(local, column, -x[place as usize]);
        }
    }
    let mut j = p;
    while j >= 4 {
        j -= 4;
        let columns: [&[f64]; 4] =
            std::array::from_fn(|c| &view.l[(j + c) * m..(j + c) * m + j + 4]);
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
        let value = local[j] / view.l[j * m + j];
        local[j] = value;
        add_one(&mut local[..j], &view.l[j * m..j * m + j], -value);
    }
    put(local, view.pivot_columns, x);
}

/// `forward` for several right-hand sides.
fn forward_block(view_of: &View<'_>, b: &mut [f64], local: &mut [f64], n_sides: usize) {
    let (p, q) = (view_of.pivot_rows.len(), view_of.rest_rows.len());
    let (m, n) = (p + q, b.len() / n_sides);
    if p == 0 {
        return;
    }
    let local = &mut local[..m * n_sides];
    for (side, local) in b.chunks(n).zip(local.chunks_mut(m)) {
        gather(local, side, view_of.pivot_rows);
    }
    let (mut upper, lower) = view_mut(local, m, n_sides, m).split_at_row_mut(p);
    let unit_lower = view(view_of.l, p, p, m);
    solve_unit_lower_triangular_in_place(unit_lower, upper.as_mut(), Par::Seq);
    if q > 0 {
        let multipliers = view(&view_of.l[p..], q, p, m);
        matmul(lower, Accum::Replace, multipliers, upper.as_ref(), -1.0, Par::Seq);
    }
    for (side, local) in b.chunks_mut(n).zip(local.chunks(m)) {
        put(local, view_of.pivot_rows, side);
        for (&row, value) in view_of.rest_rows.iter().zip(&local[p..]) {
            side[row as usize] += value;
        }
    }
}

/// `backward` for several right-hand sides.
fn backward_block(
    view_of: &View<'_>,
    b: &[f64],
    x: &mut [f64],
    local: &mut [f64],
    others: &mut [f64],
    n_sides: usize,
) {
    let (p, q) = (view_of.pivot_rows.len(), view_of.rest_columns.len());
    let (m, n) = (p + q, b.len() / n_sides);
    if p == 0 {
        return;
    }
    let local = &mut local[..p * n_sides];
    for (side, local) in b.chunks(n).zip(local.chunks_mut(p)) {
        gather(local, side, view_of.pivot_rows);
    }
    if q > 0 {
        let others = &mut others[..q * n_sides];
        for (side, others) in x.chunks(n).zip(others.chunks_mut(q)) {
            gather(others, side, view_of.rest_columns);
        }
        let known = view(others, q, n_sides, q);
        let target = view_mut(local, p, n_sides, p);
        matmul(target, Accum::Add, view(view_of.u, p, q, p), known, -1.0, Par::Seq);
    }
    let upper = view(view_of.l, p, p, m);
    solve_upper_triangular_in_place(upper, view_mut(local, p, n_sides, p), Par::Seq);
    for (side, local) in x.chunks_mut(n).zip(local.chunks(p)) {
        put(local, view_of.pivot_columns, side);
    }
}
