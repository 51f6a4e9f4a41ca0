//! `Operator`: products with a matrix in double precision.

use std::ops::Range;

use rayon::prelude::*;

use crate::sparse::index::to_u32;
use crate::sparse::{Pattern, SparseMatrix};

/// Parts of the columns that are summed up on their own, whatever the number of threads.
const PARTS: usize = 4;
/// Columns that are taken together at most.
const GROUP: usize = 3;

/// Columns of a pattern in groups that have entries in the same rows, as those of one node have.
#[derive(Debug, Clone)]
pub(super) struct ColumnGroups {
    /// First column of each group, and the end of the last.
    starts: Vec<u32>,
    /// Ranges of groups with about as many entries each.
    parts: Vec<Range<usize>>,
}

impl ColumnGroups {
    pub fn new(pattern: &Pattern) -> Self {
        let n = pattern.n();
        let mut starts = vec![0];
        let mut column = 0;
        while column < n {
            let is_alike = |other: &usize| *other < n && pattern.is_like_last(*other);
            column += 1 + (column + 1..column + GROUP).take_while(is_alike).count();
            starts.push(to_u32(column));
        }
        let n_groups = starts.len() - 1;
        let end = |part: usize| {
            let wanted = pattern.n_entries() / PARTS * part;
            starts.partition_point(|&column| pattern.starts()[column as usize] < wanted)
        };
        let bounds: Vec<usize> = (0..PARTS).map(end).chain([n_groups]).collect();
        let parts = bounds.windows(2).map(|pair| pair[0].min(n_groups)..pair[1]).collect();
        Self { starts, parts }
    }
}

/// A matrix by parts.
pub(super) struct Operator<'a> {
    pub matrix: &'a SparseMatrix,
    pub groups: &'a ColumnGroups,
}

impl Operator<'_> {
    /// Overwrites y with A x.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        let n = y.len();
        let parts = self.groups.parts.par_iter().map(|groups| {
            let mut sum = vec![0.0; n];
            for group in groups.clone() {
                let starts = &self.groups.starts;
                self.add_columns(starts[group] as usize..starts[group + 1] as usize, x, &mut sum);
            }
            sum
        });
        let parts: Vec<Vec<f64>> = parts.collect();
        y.fill(0.0);
        for part in &parts {
            for (y, value) in y.iter_mut().zip(part) {
                *y += value;
            }
        }
    }

    /// Adds some columns with entries in the same rows, each times its value in x.
    fn add_columns(&self, columns: Range<usize>, x: &[f64], sum: &mut [f64]) {
        let pattern = self.matrix.pattern();
        let factor = |column: usize| x[column];
        let values = |column: usize| &self.matrix.values()[pattern.entries(column)];
        let rows = pattern.column(columns.start);
        let first = columns.start;
        if columns.len() == GROUP {
            let [a, b, c] = [factor(first), factor(first + 1), factor(first + 2)];
            let all = values(first).iter().zip(values(first + 1)).zip(values(first + 2));
            for (&row, ((u, v), w)) in rows.iter().zip(all) {
                sum[row as usize] += u * a + v * b + w * c;
            }
        } else {
            for column in columns {
                let factor = factor(column);
                for (&row, value) in rows.iter().zip(values(column)) {
                    sum[row as usize] += value * factor;
                }
            }
        }
    }
}
