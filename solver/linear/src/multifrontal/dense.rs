//! Dense kernels of a front: LU of a tall panel with pivots from its upper rows, and updates.
//!
//! Matrices are column-major slices. Products and triangular solves are faer's; narrow
//! panels are eliminated here, because calls would cost more than the arithmetic.

use alewife_interrupt::Listener;
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::solve_unit_lower_triangular_in_place;
use faer::{Accum, MatMut, MatRef, Par};

use crate::sparse::index::to_u32;

/// Panels of so many columns are eliminated column by column.
const NARROW: usize = 8;
/// A pivot is at least this fraction of the largest entry of its column: multipliers stay below 1e4.
/// Solutions of the shipped cases have the same accuracy with 1e-8 and with 1e-3.
pub(super) const THRESHOLD: f64 = 1e-4;
/// The same against unknowns with dense rows: far below what films of a ten-thousandth of a radius need,
/// and far above what is left of a pivot that only these unknowns determine.
const DENSE_THRESHOLD: f64 = 1e-12;

/// Operations that take some tenths of a second: between more it is asked whether the work is to end.
pub(super) const LONG: usize = 4_000_000_000;
/// Operations that take much longer than to ask.
const WORTH_A_LOOK: usize = 10_000_000;

/// Columns that are worked on at once, of some that take so many operations each: parts of about the same size, since
/// few columns are worked on in another order.
pub(super) fn columns_at_once(columns: usize, operations: usize) -> usize {
    let parts = columns.saturating_mul(operations).div_ceil(LONG).max(1);
    columns.div_ceil(parts).next_multiple_of(NARROW)
}

pub(super) fn view(slice: &[f64], rows: usize, columns: usize, stride: usize) -> MatRef<'_, f64> {
    MatRef::from_column_major_slice_with_stride(slice, rows, columns, stride)
}

pub(super) fn view_mut(
    slice: &mut [f64],
    rows: usize,
    columns: usize,
    stride: usize,
) -> MatMut<'_, f64> {
    MatMut::from_column_major_slice_with_stride_mut(slice, rows, columns, stride)
}

/// A column of the panel has no acceptable pivot, or the work is to end.
#[derive(Debug)]
pub(super) struct NoPivot;

/// A rows x columns matrix inside a slice, its columns `stride` apart.
#[derive(Debug, Clone, Copy)]
pub(super) struct PanelShape {
    pub rows: usize,
    pub columns: usize,
    pub stride: usize,
}

/// What the rows of a panel are to its pivots, from the first row on.
#[derive(Debug, Clone, Copy)]
pub(super) struct PivotRows {
    /// Number of rows that pivots are taken from.
    pub candidates: usize,
    /// Number of rows, these included, before those of unknowns with dense rows.
    pub sparse: usize,
}

impl PivotRows {
    /// Without the first rows.
    fn after(self, rows: usize) -> Self {
        Self { candidates: self.candidates - rows, sparse: self.sparse - rows }
    }

    /// The size that a pivot of a column needs.
    #[inline(always)]
    fn smallest_pivot(self, column: &[f64]) -> f64 {
        let (sparse, dense) = column.split_at(self.sparse);
        let of_sparse = THRESHOLD * largest_size(&sparse[self.candidates..]);
        of_sparse.max(DENSE_THRESHOLD * largest_size(dense))
    }
}

/// How a panel is eliminated.
#[derive(Debug, Clone, Copy)]
pub(super) struct Panel<'a> {
    pub arch: pulp::Arch,
    /// Says whether the work is to end.
    pub listener: &'a Listener,
    pub shape: PanelShape,
}

impl Panel<'_> {
    /// LU with partial pivoting among the first rows; `swaps[j]` is how far below row j the pivot was found.
    pub fn lu(
        self,
        a: &mut [f64],
        pivot_rows: PivotRows,
        swaps: &mut [u32],
    ) -> Result<(), NoPivot> {
        let Self { arch, shape, .. } = self;
        let PanelShape { rows, columns, stride } = shape;
        if columns <= NARROW {
            return arch.dispatch(Narrow { a, shape, pivot_rows, swaps });
        }
        let half = (columns / 2).next_multiple_of(NARROW);
        let others = columns - half;
        let (left, right) = a.split_at_mut(half * stride);
        let (left_swaps, right_swaps) = swaps.split_at_mut(half);
        let of_left = Self { shape: PanelShape { columns: half, ..shape }, ..self };
        of_left.lu(left, pivot_rows, left_swaps)?;
        swap_rows(right, others, stride, left_swaps);
        let per_column = 2 * rows * half;
        for some in right.chunks_mut(columns_at_once(others, per_column) * stride) {
            let n = some.len().div_ceil(stride).min(others);
            if per_column * n > WORTH_A_LOOK && self.listener.check().is_err() {
                return Err(NoPivot);
            }
            self.eliminate(left, half, some, n);
        }
        let shape = PanelShape { rows: rows - half, columns: others, stride };
        Self { shape, ..self }.lu(&mut right[half..], pivot_rows.after(half), right_swaps)?;
        swap_rows(&mut left[half..], half, stride, right_swaps);
        Ok(())
    }

    /// Eliminates the unknowns of the first columns from some of the others.
    pub fn eliminate(self, left: &[f64], half: usize, right: &mut [f64], columns: usize) {
        let PanelShape { rows, stride, .. } = self.shape;
        // Columns of the upper and the lower part are interleaved in memory
        let (mut upper, lower) = view_mut(right, rows, columns, stride).split_at_row_mut(half);
        let triangle = view(left, half, half, stride);
        solve_unit_lower_triangular_in_place(triangle, upper.as_mut(), Par::Seq);
        let multipliers = view(&left[half..], rows - half, half, stride);
        matmul(lower, Accum::Add, multipliers, upper.as_ref(), -1.0, Par::Seq);
    }
}

/// Applies the row exchanges of a panel to other columns.
pub(super) fn swap_rows(a: &mut [f64], columns: usize, stride: usize, swaps: &[u32]) {
    for column in a.chunks_mut(stride).take(columns) {
        for (row, &swap) in swaps.iter().enumerate() {
            column.swap(row, row + swap as usize);
        }
    }
}

/// The arguments of `lu_narrow`: only a type of our own is compiled for the processor's vectors.
struct Narrow<'a> {
    a: &'a mut [f64],
    shape: PanelShape,
    pivot_rows: PivotRows,
    swaps: &'a mut [u32],
}

impl pulp::WithSimd for Narrow<'_> {
    type Output = Result<(), NoPivot>;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _simd: S) -> Self::Output {
        lu_narrow(self.a, self.shape, self.pivot_rows, self.swaps)
    }
}

#[inline(always)]
fn lu_narrow(
    a: &mut [f64],
    shape: PanelShape,
    pivot_rows: PivotRows,
    swaps: &mut [u32],
) -> Result<(), NoPivot> {
    let PanelShape { rows, columns, stride } = shape;
    let PivotRows { candidates, .. } = pivot_rows;
    for j in 0..columns {
        let end = a.len().min((j + 1) * stride);
        let (done, later) = a.split_at_mut(end);
        let column = &mut done[j * stride..j * stride + rows];
        let Largest { index: below, size } = largest(&column[j..candidates]).ok_or(NoPivot)?;
        if pivot_rows.smallest_pivot(column) > size {
            return Err(NoPivot);
        }
        swaps[j] = to_u32(below);
        let inverse = 1.0 / column[j + below];
        column.swap(j, j + below);
        for value in &mut column[j + 1..] {
            *value *= inverse;
        }
        let multipliers = &column[j + 1..];
        for other in later.chunks_mut(stride).take(columns - j - 1) {
            other.swap(j, j + below);
            let factor = -other[j];
            for (value, multiplier) in other[j + 1..rows].iter_mut().zip(multipliers) {
                *value = multiplier.mul_add(factor, *value);
            }
        }
        if below > 0 {
            for earlier in 0..j {
                done.swap(earlier * stride + j, earlier * stride + j + below);
            }
        }
    }
    Ok(())
}

/// The largest entry of a column.
struct Largest {
    index: usize,
    /// Absolute value.
    size: f64,
}

/// The largest entry, unless it is zero or not finite.
#[inline(always)]
fn largest(values: &[f64]) -> Option<Largest> {
    let size = largest_size(values);
    if size == 0.0 || !size.is_finite() {
        return None;
    }
    let index = values.iter().position(|value| value.abs() == size)?;
    Some(Largest { index, size })
}

/// Absolute value of the largest entry; 0 of none.
#[inline(always)]
fn largest_size(values: &[f64]) -> f64 {
    const LANES: usize = 8;
    let mut most = [0.0f64; LANES];
    let chunks = values.chunks_exact(LANES);
    let mut size = chunks.remainder().iter().fold(0.0f64, |most, value| most.max(value.abs()));
    for chunk in chunks {
        for lane in 0..LANES {
            let value = chunk[lane].abs();
            most[lane] = if value > most[lane] { value } else { most[lane] };
        }
    }
    for lane in most {
        size = size.max(lane);
    }
    size
}

/// U12 = L11^-1 P U12 and C -= L21 U12 for some columns of both; C is not read where `accum` is to
/// replace it. `swaps` are the row exchanges of all k pivots of the panel `l`, which has m rows.
pub(super) fn update(
    l: &[f64],
    m: usize,
    swaps: &[u32],
    u: &mut [f64],
    c: &mut [f64],
    accum: Accum,
) {
    let k = swaps.len();
    let r = m - k;
    let columns = u.len() / k;
    swap_rows(u, columns, k, swaps);
    let mut upper = view_mut(u, k, columns, k);
    solve_unit_lower_triangular_in_place(view(l, k, k, m), upper.as_mut(), Par::Seq);
    if r > 0 {
        let multipliers = view(&l[k..], r, k, m);
        matmul(view_mut(c, r, columns, r), accum, multipliers, upper.as_ref(), -1.0, Par::Seq);
    }
}

/// The pivots of a front whose columns could not all be eliminated.
#[derive(Debug)]
pub(super) struct PartialLu {
    /// Number of pivots found.
    pub pivots: usize,
    /// Original index of each row and column of the fully summed block, pivots first.
    pub rows: Vec<u32>,
    pub columns: Vec<u32>,
}

/// LU with a free choice of pivot columns: as many of the k fully summed columns of the panel of m
/// rows as have a pivot above `pivot_floors[column]` and large enough against the tested rest of its
/// column. Where the work is to end, there are fewer.
pub(super) fn lu_delaying(
    listener: &Listener,
    l: &mut [f64],
    m: usize,
    pivot_rows: PivotRows,
    pivot_floors: &[f64],
) -> PartialLu {
    let PivotRows { candidates: k, .. } = pivot_rows;
    let mut rows: Vec<u32> = (0..to_u32(k)).collect();
    let mut columns = rows.clone();
    let mut pivots = 0;
    while pivots < k && !listener.is_requested() {
        let candidate = (pivots..k).find_map(|column| {
            let values = &l[column * m..(column + 1) * m];
            let Largest { index: below, size } = largest(&values[pivots..k])?;
            let is_acceptable = size > pivot_floors[columns[column] as usize]
                && size >= pivot_rows.smallest_pivot(values);
            is_acceptable.then_some((column, pivots + below))
        });
        let Some((column, row)) = candidate else { break };
        columns.swap(pivots, column);
        for index in 0..m {
            l.swap(pivots * m + index, column * m + index);
        }
        rows.swap(pivots, row);
        for other in l.chunks_mut(m) {
            other.swap(pivots, row);
        }
        let (done, later) = l.split_at_mut((pivots + 1) * m);
        let pivot_column = &mut done[pivots * m..];
        let inverse = 1.0 / pivot_column[pivots];
        for value in &mut pivot_column[pivots + 1..] {
            *value *= inverse;
        }
        for other in later.chunks_mut(m) {
            let factor = other[pivots];
            for (value, multiplier) in
                other[pivots + 1..].iter_mut().zip(&pivot_column[pivots + 1..])
            {
                *value -= multiplier * factor;
            }
        }
        pivots += 1;
    }
    PartialLu { pivots, rows, columns }
}
