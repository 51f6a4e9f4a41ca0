//! One front: assembled from the matrix and its children, eliminated, its contribution left.

use std::ops::Range;

use faer::Accum;

use super::analysis::{Analysis, Front};
use super::dense::{self, NoPivot, Shape};

/// Columns of the rest that are updated at a time where fronts are shared among threads.
const SHARED_COLUMNS: usize = 96;

/// The contribution of a child as its parent takes it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Child<'a> {
    /// Square matrix over delayed unknowns, then the rest.
    pub values: &'a [f64],
    /// Where the rest is in the parent.
    pub relative: &'a [u32],
    /// Places of delayed rows and columns.
    pub delayed_rows: &'a [u32],
    pub delayed_columns: &'a [u32],
}

/// A contribution with memory of its own.
#[derive(Debug, Clone, Default)]
pub(super) struct Contribution {
    pub values: Vec<f64>,
    pub delayed_rows: Vec<u32>,
    pub delayed_columns: Vec<u32>,
}

/// Factors of a front that has not the size the analysis foresaw, because pivots were delayed.
#[derive(Debug, Clone)]
pub(super) struct Irregular {
    /// (p + q) x p columns of L with U11, then p x q of U12.
    pub l: Vec<f64>,
    pub u: Vec<f64>,
    /// Places of the rows and columns, pivots first.
    pub rows: Vec<u32>,
    pub columns: Vec<u32>,
    pub pivots: usize,
}

/// The matrix as the fronts see it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Input<'a> {
    pub analysis: &'a Analysis,
    pub values: &'a [f64],
    /// Factor of the rows and columns of pressures.
    pub pressure_scale: f64,
    /// Smallest pivot for each place.
    pub tiny: &'a [f64],
    pub arch: pulp::Arch,
    /// Whether the front may use all threads.
    pub shared: bool,
}

impl Input<'_> {
    /// Ranges of a front's entries, with the factor of their values.
    fn entries(&self, front: &Front) -> [(Range<usize>, f64); 2] {
        let Range { start, end } = front.entries;
        [(start..front.mixed, 1.0), (front.mixed..end, self.pressure_scale)]
    }
}

/// Adds a child's contribution; `map` gives the index in the front of each of its unknowns, those
/// that are fully summed (below k) first.
fn extend_add(map: &[u32], values: &[f64], k: usize, m: usize, panel: &mut [f64], c: &mut [f64]) {
    let order = map.len();
    let r = m - k;
    let n_summed = map.iter().take_while(|&&index| (index as usize) < k).count();
    let (l, u) = panel.split_at_mut(m * k);
    for (&column, source) in map.iter().zip(values.chunks(order)) {
        let column = column as usize;
        if column < k {
            let target = &mut l[column * m..(column + 1) * m];
            for (&row, value) in map.iter().zip(source) {
                target[row as usize] += value;
            }
        } else {
            let column = column - k;
            let (summed, others) = source.split_at(n_summed);
            let target = &mut u[column * k..(column + 1) * k];
            for (&row, value) in map.iter().zip(summed) {
                target[row as usize] += value;
            }
            let target = &mut c[column * r..(column + 1) * r];
            for (&row, value) in map[n_summed..].iter().zip(others) {
                target[row as usize - k] += value;
            }
        }
    }
}

/// Assembles and eliminates a front that has the size foreseen.
///
/// `panel` takes its factors, `c` its contribution, `pivot_rows` the places of its pivot rows.
pub(super) fn regular<'a>(
    input: Input<'_>,
    front: &Front,
    children: impl Iterator<Item = Child<'a>>,
    panel: &mut [f64],
    c: &mut [f64],
    pivot_rows: &mut [u32],
    swaps: &mut [u32],
) -> Result<(), NoPivot> {
    let (k, m) = (front.k, front.m());
    panel.fill(0.0);
    let accum = if front.children.is_empty() { Accum::Replace } else { Accum::Add };
    if accum == Accum::Add {
        c.fill(0.0);
    }
    let analysis = input.analysis;
    for (entries, scale) in input.entries(front) {
        let targets = &analysis.targets[entries.clone()];
        for (&source, &target) in analysis.sources[entries].iter().zip(targets) {
            panel[target as usize] += input.values[source as usize] * scale;
        }
    }
    for child in children {
        extend_add(child.relative, child.values, k, m, panel, c);
    }
    let (l, u) = panel.split_at_mut(m * k);
    let swaps = &mut swaps[..k];
    eliminate(input, (l, u, c), k, m, &input.tiny[front.start..front.start + k], swaps, accum)?;
    for (place, row) in (front.start as u32..).zip(pivot_rows.iter_mut()) {
        *row = place;
    }
    for (row, &swap) in swaps.iter().enumerate() {
        pivot_rows.swap(row, row + swap as usize);
    }
    Ok(())
}

/// LU of the panel and update of the rest, all pivots in place.
fn eliminate(
    input: Input<'_>,
    (l, u, c): (&mut [f64], &mut [f64], &mut [f64]),
    k: usize,
    m: usize,
    tiny: &[f64],
    swaps: &mut [u32],
    accum: Accum,
) -> Result<(), NoPivot> {
    use rayon::prelude::*;
    dense::lu(input.arch, l, Shape { rows: m, columns: k, stride: m }, k, swaps)?;
    if tiny.iter().enumerate().any(|(column, tiny)| l[column * m + column].abs() <= *tiny) {
        return Err(NoPivot);
    }
    let r = m - k;
    if r == 0 {
        return Ok(());
    }
    let (l, swaps) = (&*l, &*swaps);
    if input.shared {
        u.par_chunks_mut(k * SHARED_COLUMNS)
            .zip(c.par_chunks_mut(r * SHARED_COLUMNS))
            .for_each(|(u, c)| dense::update(l, m, swaps, u, c, accum));
    } else {
        dense::update(l, m, swaps, u, c, accum);
    }
    Ok(())
}

/// Assembles and eliminates a front some of whose pivots are, or become, delayed.
pub(super) fn irregular<'a>(
    input: Input<'_>,
    front: &Front,
    children: impl Iterator<Item = Child<'a>> + Clone,
) -> (Irregular, Contribution) {
    let analysis = input.analysis;
    let delayed: usize = children.clone().map(|child| child.delayed_rows.len()).sum();
    let (k, r) = (front.k + delayed, front.r);
    let m = k + r;
    let places = || front.start as u32..(front.start + front.k) as u32;
    let mut rows: Vec<u32> = places().collect();
    let mut columns = rows.clone();
    let mut panel = vec![0.0; m * k + k * r];
    let mut c = vec![0.0; r * r];
    let shifted = |index: usize| if index < front.k { index } else { index + delayed };
    let n_panel = front.m() * front.k;
    for (entries, scale) in input.entries(front) {
        for entry in entries {
            let target = analysis.targets[entry] as usize;
            let (row, column) = if target < n_panel {
                (target % front.m(), target / front.m())
            } else {
                ((target - n_panel) % front.k, front.k + (target - n_panel) / front.k)
            };
            let (row, column) = (shifted(row), shifted(column));
            let at = if column < k { row + column * m } else { m * k + row + (column - k) * k };
            panel[at] += input.values[analysis.sources[entry] as usize] * scale;
        }
    }
    for child in children.clone() {
        let first = rows.len() as u32;
        rows.extend(child.delayed_rows);
        columns.extend(child.delayed_columns);
        let map: Vec<u32> = (first..rows.len() as u32)
            .chain(child.relative.iter().map(|&index| shifted(index as usize) as u32))
            .collect();
        extend_add(&map, child.values, k, m, &mut panel, &mut c);
    }
    let tiny: Vec<f64> = columns.iter().map(|&place| input.tiny[place as usize]).collect();
    let (l, u) = panel.split_at_mut(m * k);
    let partial = dense::lu_delaying(l, m, k, &tiny);
    let p = partial.pivots;
    permute_rows(u, k, &partial.rows);
    finish(l, u, &mut c, k, m, p);
    let rest = analysis.rest_of(front);
    let named = |names: &[u32], order: &[u32]| -> Vec<u32> {
        order.iter().map(|&index| names[index as usize]).chain(rest.iter().copied()).collect()
    };
    let (rows, columns) = (named(&rows, &partial.rows), named(&columns, &partial.columns));
    let contribution = Contribution {
        values: contribution(l, u, &c, k, m, p),
        delayed_rows: rows[p..k].to_vec(),
        delayed_columns: columns[p..k].to_vec(),
    };
    let mut upper = Vec::with_capacity(p * (m - p));
    for column in p..k {
        upper.extend_from_slice(&l[column * m..column * m + p]);
    }
    for column in 0..r {
        upper.extend_from_slice(&u[column * k..column * k + p]);
    }
    let factors = Irregular { l: l[..m * p].to_vec(), u: upper, rows, columns, pivots: p };
    (factors, contribution)
}

fn permute_rows(u: &mut [f64], k: usize, rows: &[u32]) {
    if k == 0 {
        return;
    }
    let mut old = vec![0.0; k];
    for column in u.chunks_mut(k) {
        old.copy_from_slice(column);
        for (value, &row) in column.iter_mut().zip(rows) {
            *value = old[row as usize];
        }
    }
}

/// Eliminates the p pivots from the columns of the rest, those of delayed rows included.
fn finish(l: &[f64], u: &mut [f64], c: &mut [f64], k: usize, m: usize, p: usize) {
    let r = m - k;
    for column in 0..r {
        let u = &mut u[column * k..(column + 1) * k];
        let c = &mut c[column * r..(column + 1) * r];
        for pivot in 0..p {
            let factor = u[pivot];
            let multipliers = &l[pivot * m..(pivot + 1) * m];
            for (value, multiplier) in u[pivot + 1..].iter_mut().zip(&multipliers[pivot + 1..k]) {
                *value -= multiplier * factor;
            }
            for (value, multiplier) in c.iter_mut().zip(&multipliers[k..]) {
                *value -= multiplier * factor;
            }
        }
    }
}

/// What is left after p pivots as one square matrix: delayed unknowns, then the rest.
fn contribution(l: &[f64], u: &[f64], c: &[f64], k: usize, m: usize, p: usize) -> Vec<f64> {
    let r = m - k;
    let mut values = Vec::with_capacity((m - p) * (m - p));
    for column in p..k {
        values.extend_from_slice(&l[column * m + p..(column + 1) * m]);
    }
    for column in 0..r {
        values.extend_from_slice(&u[column * k + p..(column + 1) * k]);
        values.extend_from_slice(&c[column * r..(column + 1) * r]);
    }
    values
}
