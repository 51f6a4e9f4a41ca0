//! Elimination of one front: assembled from the matrix and its children, factorised, its Schur
//! complement left to the parent.

use std::ops::Range;

use alewife_interrupt::Listener;
use faer::Accum;

use super::super::analysis::Analysis;
use super::super::dense::{self, NoPivot, PanelShape, PivotRows};
use super::super::front::Front;
use super::runs::{add_runs, runs};
use crate::sparse::index::to_u32;

/// Columns of the border that a thread updates at a time in fronts that threads share.
const SHARED_COLUMNS: usize = 96;
/// Entries of a panel from which on its elimination takes much longer than to ask whether the work is to end.
const LARGE_PANEL: usize = 20_000;

/// A factorisation under way: what all fronts read.
#[derive(Debug, Clone, Copy)]
pub(super) struct FactorisationContext<'a> {
    pub analysis: &'a Analysis,
    /// Values of the matrix.
    pub values: &'a [f64],
    /// Factor of the rows and columns of pressures.
    pub pressure_scale: f64,
    /// Size that the pivot of each position has to exceed.
    pub pivot_floors: &'a [f64],
    pub arch: pulp::Arch,
    /// Whether a front may use all threads.
    pub shared: bool,
    /// Says whether the work is to end.
    pub listener: &'a Listener,
}

/// Entries of a front and the factor of their values.
struct ScaledEntries {
    entries: Range<usize>,
    scale: f64,
}

impl FactorisationContext<'_> {
    /// Whether the work is to end before a front.
    pub fn is_to_end(&self, front: &Front) -> bool {
        if front.m() * front.k < LARGE_PANEL {
            self.listener.is_requested()
        } else {
            self.listener.check().is_err()
        }
    }

    fn entries(&self, front: &Front) -> [ScaledEntries; 2] {
        let Range { start, end } = front.entries;
        let first_pressure = front.first_pressure_entry;
        [
            ScaledEntries { entries: start..first_pressure, scale: 1.0 },
            ScaledEntries { entries: first_pressure..end, scale: self.pressure_scale },
        ]
    }
}

/// The contribution of a child as its parent takes it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Child<'a> {
    /// Square matrix over delayed unknowns, then the border.
    pub values: &'a [f64],
    /// Indices of the border in the parent.
    pub relative: &'a [u32],
    /// Positions of delayed rows.
    pub delayed_rows: &'a [u32],
    /// Positions of delayed columns.
    pub delayed_columns: &'a [u32],
}

/// The contribution of a front with delayed pivots, in memory of its own.
#[derive(Debug, Clone, Default)]
pub(in super::super) struct DelayedContribution {
    pub values: Vec<f64>,
    pub delayed_rows: Vec<u32>,
    pub delayed_columns: Vec<u32>,
}

/// Factors of a front that has not the size the analysis foresaw, because pivots were delayed.
#[derive(Debug, Clone)]
pub(in super::super) struct DelayedPivotFactors {
    /// m x p columns of L with U11, for p pivots.
    pub l: Vec<f64>,
    /// p x (m - p) entries of U12.
    pub u: Vec<f64>,
    /// Positions of the rows, pivots first; slots of them once all is factorised.
    pub rows: Vec<u32>,
    /// The same of the columns.
    pub columns: Vec<u32>,
    /// p.
    pub n_pivots: usize,
    /// Number of unknowns that might have been eliminated in the front.
    pub n_candidates: usize,
}

/// A front eliminated with delayed pivots.
#[derive(Debug)]
pub(super) struct DelayedElimination {
    pub factors: DelayedPivotFactors,
    pub contribution: DelayedContribution,
}

/// Memory that elimination without delayed pivots writes to.
pub(super) struct FrontTarget<'a> {
    /// The factors.
    pub panel: &'a mut [f64],
    /// The contribution.
    pub contribution: &'a mut [f64],
    /// Slots of the pivot rows.
    pub pivot_rows: &'a mut [u32],
    /// Row exchanges, k at least: workspace.
    pub swaps: &'a mut [u32],
}

/// A front in memory, k of its m unknowns fully summed.
struct FrontMatrix<'a> {
    /// m x k: F11 and F21.
    l: &'a mut [f64],
    /// k x r: F12.
    u: &'a mut [f64],
    /// r x r: F22.
    c: &'a mut [f64],
    k: usize,
    m: usize,
    /// Number of unknowns with dense rows at the end of the border.
    n_dense: usize,
}

/// Assembles and eliminates a front of the size that the analysis foresaw.
pub(super) fn factorise_static<'a>(
    context: FactorisationContext<'_>,
    front: &Front,
    children: impl Iterator<Item = Child<'a>>,
    target: FrontTarget<'_>,
) -> Result<(), NoPivot> {
    let (k, m) = (front.k, front.m());
    let FrontTarget { panel, contribution, pivot_rows, swaps } = target;
    panel.fill(0.0);
    let accum = if front.children.is_empty() { Accum::Replace } else { Accum::Add };
    if accum == Accum::Add {
        contribution.fill(0.0);
    }
    let map = &context.analysis.entries;
    for ScaledEntries { entries, scale } in context.entries(front) {
        let targets = &map.targets[entries.clone()];
        for (&source, &target) in map.sources[entries].iter().zip(targets) {
            panel[target as usize] += context.values[source as usize] * scale;
        }
    }
    let (l, u) = panel.split_at_mut(m * k);
    let mut matrix = FrontMatrix { l, u, c: contribution, k, m, n_dense: front.n_dense };
    for child in children {
        matrix.extend_add(child.relative, child.values);
    }
    let swaps = &mut swaps[..k];
    matrix.eliminate(context, &context.pivot_floors[front.positions()], swaps, accum)?;
    for (slot, row) in (to_u32(front.slot)..).zip(pivot_rows.iter_mut()) {
        *row = slot;
    }
    for (row, &swap) in swaps.iter().enumerate() {
        pivot_rows.swap(row, row + swap as usize);
    }
    Ok(())
}

/// Assembles and eliminates a front some of whose pivots are, or become, delayed.
pub(super) fn factorise_delayed<'a>(
    context: FactorisationContext<'_>,
    front: &Front,
    children: impl Iterator<Item = Child<'a>> + Clone,
) -> DelayedElimination {
    let n_delayed: usize = children.clone().map(|child| child.delayed_rows.len()).sum();
    let (k, r) = (front.k + n_delayed, front.r);
    let m = k + r;
    let mut rows: Vec<u32> = (to_u32(front.start)..).take(front.k).collect();
    let mut columns = rows.clone();
    let (mut l, mut u, mut c) = (vec![0.0; m * k], vec![0.0; k * r], vec![0.0; r * r]);
    let mut matrix = FrontMatrix { l: &mut l, u: &mut u, c: &mut c, k, m, n_dense: front.n_dense };
    matrix.add_entries(context, front, n_delayed);
    for child in children {
        let first = to_u32(rows.len());
        rows.extend(child.delayed_rows);
        columns.extend(child.delayed_columns);
        let relative =
            child.relative.iter().map(|&index| to_u32(shifted(index as usize, front, n_delayed)));
        let map: Vec<u32> = (first..to_u32(rows.len())).chain(relative).collect();
        matrix.extend_add(&map, child.values);
    }
    let pivot_floors: Vec<f64> =
        columns.iter().map(|&position| context.pivot_floors[position as usize]).collect();
    let partial =
        dense::lu_delaying(context.listener, matrix.l, m, matrix.pivot_rows(), &pivot_floors);
    let p = partial.pivots;
    matrix.permute_border_rows(&partial.rows);
    matrix.eliminate_from_border(p, context.listener);
    let border = context.analysis.border_of(front);
    let permuted = |positions: &[u32], order: &[u32]| -> Vec<u32> {
        let own = order.iter().map(|&index| positions[index as usize]);
        own.chain(border.iter().copied()).collect()
    };
    let (rows, columns) = (permuted(&rows, &partial.rows), permuted(&columns, &partial.columns));
    let contribution = DelayedContribution {
        values: matrix.remainder(p),
        delayed_rows: rows[p..k].to_vec(),
        delayed_columns: columns[p..k].to_vec(),
    };
    let upper = matrix.upper(p);
    l.truncate(m * p);
    l.shrink_to_fit();
    let factors = DelayedPivotFactors { l, u: upper, rows, columns, n_pivots: p, n_candidates: k };
    DelayedElimination { factors, contribution }
}

/// The index in a front with delayed unknowns, which stand between its own and the border, of an
/// index without them.
fn shifted(index: usize, front: &Front, n_delayed: usize) -> usize {
    if index < front.k { index } else { index + n_delayed }
}

impl FrontMatrix<'_> {
    fn r(&self) -> usize {
        self.m - self.k
    }

    fn pivot_rows(&self) -> PivotRows {
        PivotRows { candidates: self.k, sparse: self.m - self.n_dense }
    }

    /// Adds the entries of the matrix to a front with some delayed unknowns.
    fn add_entries(&mut self, context: FactorisationContext<'_>, front: &Front, n_delayed: usize) {
        let map = &context.analysis.entries;
        let n_panel = front.m() * front.k;
        for ScaledEntries { entries, scale } in context.entries(front) {
            for entry in entries {
                let target = map.targets[entry] as usize;
                let (row, column) = if target < n_panel {
                    (target % front.m(), target / front.m())
                } else {
                    ((target - n_panel) % front.k, front.k + (target - n_panel) / front.k)
                };
                let row = shifted(row, front, n_delayed);
                let column = shifted(column, front, n_delayed);
                let value = context.values[map.sources[entry] as usize] * scale;
                if column < self.k {
                    self.l[row + column * self.m] += value;
                } else {
                    self.u[row + (column - self.k) * self.k] += value;
                }
            }
        }
    }

    /// Adds a child's contribution; `map` gives the index in the front of each of its unknowns, those
    /// that are fully summed (below k) first.
    fn extend_add(&mut self, map: &[u32], values: &[f64]) {
        let Self { l, u, c, k, m, .. } = self;
        let (k, m, r) = (*k, *m, self.m - self.k);
        let n_summed = map.iter().take_while(|&&index| (index as usize) < k).count();
        let (summed, others) = map.split_at(n_summed);
        let (summed, others) = (runs(summed, 0), runs(others, k));
        for (&column, source) in map.iter().zip(values.chunks(map.len())) {
            let column = column as usize;
            let (source_summed, source_others) = source.split_at(n_summed);
            if column < k {
                let (target_summed, target_others) =
                    l[column * m..(column + 1) * m].split_at_mut(k);
                add_runs(&summed, source_summed, target_summed);
                add_runs(&others, source_others, target_others);
            } else {
                let column = column - k;
                add_runs(&summed, source_summed, &mut u[column * k..(column + 1) * k]);
                add_runs(&others, source_others, &mut c[column * r..(column + 1) * r]);
            }
        }
    }

    /// Eliminates all k unknowns, or none.
    fn eliminate(
        &mut self,
        context: FactorisationContext<'_>,
        pivot_floors: &[f64],
        swaps: &mut [u32],
        accum: Accum,
    ) -> Result<(), NoPivot> {
        use rayon::prelude::*;
        let (k, m, r) = (self.k, self.m, self.r());
        let shape = PanelShape { rows: m, columns: k, stride: m };
        let panel = dense::Panel { arch: context.arch, listener: context.listener, shape };
        panel.lu(self.l, self.pivot_rows(), swaps)?;
        let pivots = (0..k).map(|column| self.l[column * m + column].abs());
        if pivots.zip(pivot_floors).any(|(pivot, floor)| pivot <= *floor) {
            return Err(NoPivot);
        }
        if r == 0 {
            return Ok(());
        }
        let (l, swaps) = (&*self.l, &*swaps);
        let update = |[u, c]: [&mut [f64]; 2]| {
            // Where it is to end, what is left out is not looked at
            if context.listener.check().is_ok() {
                dense::update(l, m, swaps, u, c, accum);
            }
        };
        if context.shared {
            let columns = self.u.par_chunks_mut(k * SHARED_COLUMNS);
            columns
                .zip(self.c.par_chunks_mut(r * SHARED_COLUMNS))
                .for_each(|(u, c)| update([u, c]));
        } else {
            let columns = dense::columns_at_once(r, 2 * k * m);
            if columns >= r {
                dense::update(l, m, swaps, self.u, self.c, accum);
            } else {
                let columns_of_u = self.u.chunks_mut(k * columns);
                columns_of_u.zip(self.c.chunks_mut(r * columns)).for_each(|(u, c)| update([u, c]));
            }
        }
        Ok(())
    }

    fn permute_border_rows(&mut self, rows: &[u32]) {
        if self.k == 0 {
            return;
        }
        let mut old = vec![0.0; self.k];
        for column in self.u.chunks_mut(self.k) {
            old.copy_from_slice(column);
            for (value, &row) in column.iter_mut().zip(rows) {
                *value = old[row as usize];
            }
        }
    }

    /// Eliminates p pivots from the columns of the border, in delayed rows too.
    fn eliminate_from_border(&mut self, p: usize, listener: &Listener) {
        let Self { l, u, c, k, m, .. } = self;
        let (k, m, r) = (*k, *m, self.m - self.k);
        for column in (0..r).take_while(|_| !listener.is_requested()) {
            let u = &mut u[column * k..(column + 1) * k];
            let c = &mut c[column * r..(column + 1) * r];
            for pivot in 0..p {
                let factor = u[pivot];
                let multipliers = &l[pivot * m..(pivot + 1) * m];
                let delayed = u[pivot + 1..].iter_mut().zip(&multipliers[pivot + 1..k]);
                for (value, multiplier) in delayed {
                    *value -= multiplier * factor;
                }
                for (value, multiplier) in c.iter_mut().zip(&multipliers[k..]) {
                    *value -= multiplier * factor;
                }
            }
        }
    }

    /// What is left after p pivots as one square matrix: delayed unknowns, then the border.
    fn remainder(&self, p: usize) -> Vec<f64> {
        let (k, m, r) = (self.k, self.m, self.r());
        let mut values = Vec::with_capacity((m - p) * (m - p));
        for column in p..k {
            values.extend_from_slice(&self.l[column * m + p..(column + 1) * m]);
        }
        for column in 0..r {
            values.extend_from_slice(&self.u[column * k + p..(column + 1) * k]);
            values.extend_from_slice(&self.c[column * r..(column + 1) * r]);
        }
        values
    }

    /// U12 of p pivots: p rows of delayed columns, then of those of the border.
    fn upper(&self, p: usize) -> Vec<f64> {
        let (k, m, r) = (self.k, self.m, self.r());
        let mut upper = Vec::with_capacity(p * (m - p));
        for column in p..k {
            upper.extend_from_slice(&self.l[column * m..column * m + p]);
        }
        for column in 0..r {
            upper.extend_from_slice(&self.u[column * k..column * k + p]);
        }
        upper
    }
}
