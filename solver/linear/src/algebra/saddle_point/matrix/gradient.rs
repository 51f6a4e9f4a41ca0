//! `Gradient`: the block G that couples velocities to pressures.

use std::ops::Range;

use rayon::prelude::*;

use super::vector::B;
use crate::multigrid::{BlockMatrix, RowBuilder};
use crate::sparse::index::to_u32;
use crate::sparse::lists::{Lists, Parts, starts_by_item};

/// Rows that one task works on.
const ROWS: usize = 256;
/// Sums below this part of their terms are zero.
const ROUNDING: f32 = 1e-4;

/// G by rows of blocks: for each node or body its pressures with three numbers each.
#[derive(Debug, Clone, PartialEq)]
pub(in super::super) struct Gradient {
    n_pressures: usize,
    /// Start of each row in the others, and the end of the last.
    starts: Vec<usize>,
    pressures: Vec<u32>,
    values: Vec<[f32; B]>,
}

impl Gradient {
    /// Zeros for these pressures of each row.
    pub fn zeros(pressures: Lists, n_pressures: usize) -> Self {
        let Parts { starts, items } = pressures.into_parts();
        let values = vec![[0.0; B]; items.len()];
        Self { n_pressures, starts, pressures: items, values }
    }

    /// Index of the entry of a pressure in a row, if it is stored, where the pressures of rows ascend.
    pub fn find(&self, row: usize, pressure: u32) -> Option<usize> {
        let entries = self.entries(row);
        let place = self.pressures[entries.clone()].binary_search(&pressure);
        place.ok().map(|place| entries.start + place)
    }

    /// The entries of a row, among all.
    pub fn entries(&self, row: usize) -> Range<usize> {
        self.starts[row]..self.starts[row + 1]
    }

    /// All entries, row by row.
    pub fn values(&self) -> &[[f32; B]] {
        &self.values
    }

    /// All entries, row by row, to be changed.
    pub fn values_mut(&mut self) -> &mut [[f32; B]] {
        &mut self.values
    }

    /// The pressures of all entries, row by row.
    pub fn pressures(&self) -> &[u32] {
        &self.pressures
    }

    /// Number of pressures.
    pub fn n_pressures(&self) -> usize {
        self.n_pressures
    }

    /// Memory (bytes).
    pub fn n_bytes(&self) -> usize {
        self.values.len() * (size_of::<[f32; B]>() + size_of::<u32>())
    }

    fn row(&self, row: usize) -> impl Iterator<Item = (u32, &[f32; B])> {
        let entries = self.entries(row);
        self.pressures[entries.clone()].iter().copied().zip(&self.values[entries])
    }

    /// u += G p.
    pub fn multiply_add(&self, p: &[f32], u: &mut [[f32; B]]) {
        u.par_chunks_mut(ROWS).enumerate().for_each(|(chunk, rows)| {
            for (offset, u) in rows.iter_mut().enumerate() {
                for (pressure, value) in self.row(chunk * ROWS + offset) {
                    for a in 0..B {
                        u[a] += value[a] * p[pressure as usize];
                    }
                }
            }
        });
    }

    /// G^T, where rows and pressures have changed places.
    pub fn transposed(&self) -> Self {
        self.rows_of_pressures(self.starts.len() - 1)
    }

    /// p = G^T u, of the transposed G.
    pub fn multiply_transposed(&self, u: &[[f32; B]], p: &mut [f32]) {
        p.par_chunks_mut(ROWS).enumerate().for_each(|(chunk, pressures)| {
            for (offset, p) in pressures.iter_mut().enumerate() {
                let terms = self.row(chunk * ROWS + offset);
                let mut sums = [0.0; B];
                for (row, value) in terms {
                    let u = &u[row as usize];
                    for a in 0..B {
                        sums[a] += value[a] * u[a];
                    }
                }
                *p = sums.iter().sum();
            }
        });
    }

    /// The same with other rows in place of some, which `of_row` gives as pressures with their values, ascending.
    pub fn with_rows(&self, mut of_row: impl FnMut(usize) -> Option<Vec<(u32, [f32; B])>>) -> Self {
        let mut all = Self {
            n_pressures: self.n_pressures,
            starts: vec![0],
            pressures: Vec::with_capacity(self.pressures.len()),
            values: Vec::with_capacity(self.values.len()),
        };
        for row in 0..self.starts.len() - 1 {
            let entries = self.entries(row);
            match of_row(row) {
                Some(others) => others.into_iter().for_each(|(pressure, value)| {
                    all.pressures.push(pressure);
                    all.values.push(value);
                }),
                None => {
                    all.pressures.extend(&self.pressures[entries.clone()]);
                    all.values.extend(&self.values[entries]);
                }
            }
            all.starts.push(all.pressures.len());
        }
        all
    }

    /// The same with one more pressure, the one that is held: together they have no gradient where they
    /// are equal.
    pub fn with_held_pressure(&self) -> Self {
        let mut all = Self {
            n_pressures: self.n_pressures + 1,
            starts: vec![0],
            pressures: Vec::with_capacity(self.pressures.len()),
            values: Vec::with_capacity(self.values.len()),
        };
        for row in 0..self.starts.len() - 1 {
            let (mut sum, mut size) = ([0.0; B], [0.0; B]);
            for (pressure, value) in self.row(row) {
                all.pressures.push(pressure);
                all.values.push(*value);
                for a in 0..B {
                    sum[a] += value[a];
                    size[a] += value[a].abs();
                }
            }
            if (0..B).any(|a| sum[a].abs() > ROUNDING * size[a]) {
                all.pressures.push(to_u32(self.n_pressures));
                all.values.push(sum.map(|value| -value));
            }
            all.starts.push(all.pressures.len());
        }
        all
    }

    /// G^T D^-1 G over the first rows, those of nodes, for a diagonal matrix D; components where D is not
    /// positive are left out.
    pub fn laplacian(&self, damping: &[[f32; B]]) -> BlockMatrix<1> {
        let columns = self.rows_of_pressures(damping.len());
        let mut place = vec![u32::MAX; self.n_pressures];
        let mut rows = RowBuilder::new(self.n_pressures);
        let (mut touched, mut sums): (Vec<u32>, Vec<f32>) = (Vec::new(), Vec::new());
        for pressure in 0..self.n_pressures {
            for (row, value) in columns.row(pressure) {
                let weighted: [f32; B] = std::array::from_fn(|a| {
                    let damping = damping[row as usize][a];
                    if damping > 0.0 { value[a] / damping } else { 0.0 }
                });
                for (other, value) in self.row(row as usize) {
                    let slot = &mut place[other as usize];
                    if *slot == u32::MAX {
                        *slot = to_u32(sums.len());
                        touched.push(other);
                        sums.push(0.0);
                    }
                    sums[*slot as usize] += (0..B).map(|a| weighted[a] * value[a]).sum::<f32>();
                }
            }
            for (other, sum) in touched.drain(..).zip(sums.drain(..)) {
                place[other as usize] = u32::MAX;
                rows.push(other, [[sum]]);
            }
            rows.end_row();
        }
        rows.build()
    }

    /// For each pressure its rows among the first ones, in place of the pressures of each row.
    fn rows_of_pressures(&self, n_rows: usize) -> Self {
        let starts = starts_by_item(&self.pressures[..self.starts[n_rows]], self.n_pressures);
        let mut next = starts.clone();
        let n_entries = starts[self.n_pressures];
        let (mut rows, mut values) = (vec![0; n_entries], vec![[0.0; B]; n_entries]);
        for row in 0..n_rows {
            for (pressure, value) in self.row(row) {
                let entry = &mut next[pressure as usize];
                rows[*entry] = to_u32(row);
                values[*entry] = *value;
                *entry += 1;
            }
        }
        Self { n_pressures: n_rows, starts, pressures: rows, values }
    }
}
