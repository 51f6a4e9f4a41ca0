//! `SaddleMatrix`: a saddle-point matrix in blocks, each number the sum of two in single precision.
//!
//! The leading numbers are what the preconditioner computes with, so that it needs no copy; with the rest, 48
//! bits together, residuals have the accuracy of double precision.

mod block_maps;
mod gradient;
mod numbering;
mod vector;

use std::ops::Range;

use rayon::prelude::*;

use self::block_maps::{BlockMaps, BlockPattern, CellBlocks, RowsOfCells};
pub(super) use self::gradient::Gradient;
pub(super) use self::numbering::Numbering;
pub(super) use self::vector::{B, Blocks, Place, dot};
use super::super::cell_unknowns::CellUnknowns;
use super::data::SaddlePoint;
use crate::multigrid::{Block, BlockMatrix};
use crate::sparse::index::to_u32;
use crate::sparse::single::single;
use crate::sparse::{Pattern, Revision, SparseMatrix};

/// Rows that one task works on.
const ROWS: usize = 256;
/// Numbers that one task sets to zero.
const CLEARED: usize = 1 << 16;
/// Parts of the rows whose products with pressures are summed up on their own, whatever the number of threads.
const PARTS: usize = 4;

/// The matrix [F G; G^T 0] on the unknowns of a system.
///
/// Columns of the rows ascend. Of G^T nothing is stored: cells give its transposed.
#[derive(Debug)]
pub struct SaddleMatrix {
    numbering: Numbering,
    maps: BlockMaps,
    /// F.
    velocity: BlockMatrix<B>,
    velocity_rest: Vec<Block<B>>,
    /// G.
    gradient: Gradient,
    gradient_rest: Vec<[f32; B]>,
    revision: Revision,
}

impl SaddleMatrix {
    /// Zeros, for cells with these unknowns.
    ///
    /// # Panics
    /// When parts and cells have different numbers of unknowns.
    #[must_use]
    pub fn new(system: &SaddlePoint, cells: &CellUnknowns) -> Self {
        assert_eq!(system.parts.len(), cells.n(), "a part for each unknown");
        let numbering = Numbering::new(system);
        let of_cells = RowsOfCells::new(cells, &numbering);
        let BlockPattern { columns, pressures } = of_cells.pattern(&numbering);
        let velocity = BlockMatrix::zeros(columns, numbering.blocks.len());
        let gradient = Gradient::zeros(pressures, numbering.pressures.len());
        let maps = BlockMaps::new(cells, &numbering, &of_cells, &velocity, &gradient);
        Self {
            maps,
            velocity_rest: vec![[[0.0; B]; B]; velocity.n_blocks()],
            gradient_rest: vec![[0.0; B]; gradient.values().len()],
            velocity,
            gradient,
            numbering,
            revision: Revision::default(),
        }
    }

    /// Number of unknowns.
    #[must_use]
    pub fn n(&self) -> usize {
        self.numbering.places.len()
    }

    /// Number of stored entries, blocks as wholes.
    #[must_use]
    pub fn n_entries(&self) -> usize {
        B * (B * self.velocity.n_blocks() + self.gradient.values().len())
    }

    /// The state of the values.
    #[must_use]
    pub fn revision(&self) -> &Revision {
        &self.revision
    }

    pub(super) fn numbering(&self) -> &Numbering {
        &self.numbering
    }

    /// F in single precision. Components that are no unknowns have the mean of the others on their diagonal.
    pub(super) fn velocity(&self) -> &BlockMatrix<B> {
        &self.velocity
    }

    /// G in single precision.
    pub(super) fn gradient(&self) -> &Gradient {
        &self.gradient
    }

    /// Whether all values are finite.
    pub(super) fn is_finite(&self) -> bool {
        self.parts().into_iter().all(|part| part.par_iter().all(|value| value.is_finite()))
    }

    /// All numbers: F and what single precision leaves of it, then the same of G.
    pub(crate) fn parts(&self) -> [&[f32]; 4] {
        let velocity = [self.velocity.blocks(), &self.velocity_rest];
        let gradient = [self.gradient.values(), &self.gradient_rest];
        let [leading, rest] = velocity.map(|part| part.as_flattened().as_flattened());
        let [gradient, gradient_rest] = gradient.map(|part| part.as_flattened());
        [leading, rest, gradient, gradient_rest]
    }

    /// Sets all values to zero.
    pub fn clear(&mut self) {
        self.revision.advance();
        // In parallel, as the first time all memory is new
        let velocity = [self.velocity.blocks_mut(), &mut self.velocity_rest];
        let gradient = [self.gradient.values_mut(), &mut self.gradient_rest];
        let numbers = velocity.map(|blocks| blocks.as_flattened_mut().as_flattened_mut());
        for numbers in numbers.into_iter().chain(gradient.map(|values| values.as_flattened_mut())) {
            numbers.par_chunks_mut(CLEARED).for_each(|numbers| numbers.fill(0.0));
        }
    }

    /// Adds the matrix of a cell, column by column and folded where it has to be. Rows of pressures are
    /// not read: they are the columns of pressures.
    pub fn add_cell(&mut self, cell: usize, matrix: &[f64]) {
        let CellBlocks { size, rows, pressures, blocks, entries } = self.maps.of_cell(cell);
        // Nothing where there is no unknown: `NO_ROW` is beyond all columns
        let column =
            |column: u16| matrix.chunks_exact(size.max(1)).nth(usize::from(column)).unwrap_or(&[]);
        // Cells whose velocities are all given have neither rows nor entries
        let n_rows = rows.len().max(1);
        let (leading, rest) = (self.velocity.blocks_mut(), &mut self.velocity_rest);
        for (columns, blocks) in rows.iter().zip(blocks.chunks_exact(n_rows)) {
            let columns = columns.map(column);
            for (&rows, &index) in rows.iter().zip(blocks) {
                let (leading, rest) = (&mut leading[index as usize], &mut rest[index as usize]);
                let values = columns.map(|column| values(column, rows));
                let leading = leading.as_flattened_mut().iter_mut();
                let sums = leading.zip(rest.as_flattened_mut()).zip(values.as_flattened());
                sums.for_each(|((leading, rest), value)| add(leading, rest, *value));
            }
        }
        let (leading, rest) = (self.gradient.values_mut(), &mut self.gradient_rest);
        for (&pressure, entries) in pressures.iter().zip(entries.chunks_exact(n_rows)) {
            let column = column(pressure);
            for (&rows, &index) in rows.iter().zip(entries) {
                let (leading, rest) = (&mut leading[index as usize], &mut rest[index as usize]);
                let sums = leading.iter_mut().zip(rest).zip(values(column, rows));
                sums.for_each(|((leading, rest), value)| add(leading, rest, value));
            }
        }
    }

    /// Adds to the entry of two velocities, if it is stored.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        self.revision.advance();
        let [row, column] = [row, column].map(|unknown| self.numbering.places[unknown]);
        let Place::Velocity { row, component: a } = row else { return };
        let Place::Velocity { row: column, component: b } = column else { return };
        let Some(index) = self.velocity.find(row as usize, column) else { return };
        let [a, b] = [a, b].map(usize::from);
        let leading = &mut self.velocity.blocks_mut()[index][b][a];
        add(leading, &mut self.velocity_rest[index][b][a], value);
    }

    /// Gives components that are no unknowns a diagonal entry, once all cells have been added.
    pub fn complete(&mut self) {
        for (row, unknowns) in self.numbering.blocks.iter().enumerate() {
            if unknowns.iter().all(Option::is_some) {
                continue;
            }
            // A body that only turns, or does not, has no unknown in one of its two blocks
            let other = || self.numbering.paired(row).and_then(|other| self.mean_diagonal(other));
            let mean = self.mean_diagonal(row).or_else(other).unwrap_or(1.0);
            if let Some(index) = self.velocity.find(row, to_u32(row)) {
                let block = &mut self.velocity.blocks_mut()[index];
                (0..B).filter(|&a| unknowns[a].is_none()).for_each(|a| block[a][a] = mean);
            }
        }
    }

    /// The mean of the diagonal entries of the unknowns in a row of blocks, if it is positive.
    fn mean_diagonal(&self, row: usize) -> Option<f32> {
        let unknowns = &self.numbering.blocks[row];
        let diagonal = self.velocity.diagonal(row);
        let trace: f32 = (0..B).filter(|&a| unknowns[a].is_some()).map(|a| diagonal[a]).sum();
        (trace > 0.0).then(|| trace / unknowns.iter().flatten().count() as f32)
    }

    /// Overwrites y with A x.
    pub(super) fn multiply(&self, x: &[f64], y: &mut [f64]) {
        let Blocks { velocity, pressure } = self.numbering.split(x, |_, value| value);
        let mut result = Blocks {
            velocity: vec![[0.0; B]; velocity.len()],
            pressure: self.divergence(&velocity),
        };
        result.velocity.par_chunks_mut(ROWS).enumerate().for_each(|(chunk, rows)| {
            for (offset, sum) in rows.iter_mut().enumerate() {
                *sum = self.row_product(chunk * ROWS + offset, &velocity, &pressure);
            }
        });
        for (&place, y) in self.numbering.places.iter().zip(y) {
            *y = result.at(place);
        }
    }

    /// Columns and blocks of a row of F, in double precision.
    pub(super) fn velocity_row(&self, row: usize) -> impl Iterator<Item = (usize, [[f64; B]; B])> {
        let entries = self.velocity.entries(row);
        let blocks = self.velocity.blocks()[entries.clone()].iter();
        let blocks = blocks.zip(&self.velocity_rest[entries]).map(|(leading, rest)| {
            std::array::from_fn(|b| std::array::from_fn(|a| whole(leading[b][a], rest[b][a])))
        });
        self.velocity.columns(row).iter().map(|&column| column as usize).zip(blocks)
    }

    /// A row of F u + G p.
    fn row_product(&self, row: usize, u: &[[f64; B]], p: &[f64]) -> [f64; B] {
        let mut sum = [0.0; B];
        let entries = self.velocity.entries(row);
        let blocks = self.velocity.blocks()[entries.clone()].iter();
        let blocks = blocks.zip(&self.velocity_rest[entries]);
        for (&column, (leading, rest)) in self.velocity.columns(row).iter().zip(blocks) {
            let u = &u[column as usize];
            for b in 0..B {
                for a in 0..B {
                    sum[a] += whole(leading[b][a], rest[b][a]) * u[b];
                }
            }
        }
        let entries = self.gradient.entries(row);
        let values = self.gradient.values()[entries.clone()].iter();
        let values = values.zip(&self.gradient_rest[entries.clone()]);
        for (&pressure, (leading, rest)) in self.gradient.pressures()[entries].iter().zip(values) {
            for a in 0..B {
                sum[a] += whole(leading[a], rest[a]) * p[pressure as usize];
            }
        }
        sum
    }

    /// G^T u.
    fn divergence(&self, u: &[[f64; B]]) -> Vec<f64> {
        let part = |rows: Range<usize>| {
            let mut sums = vec![0.0; self.numbering.pressures.len()];
            for (row, u) in rows.clone().zip(&u[rows]) {
                for entry in self.gradient.entries(row) {
                    let (leading, rest) =
                        (self.gradient.values()[entry], self.gradient_rest[entry]);
                    let sum: f64 = (0..B).map(|a| whole(leading[a], rest[a]) * u[a]).sum();
                    sums[self.gradient.pressures()[entry] as usize] += sum;
                }
            }
            sums
        };
        let n = u.len();
        let parts: Vec<Range<usize>> =
            (0..PARTS).map(|index| n * index / PARTS..n * (index + 1) / PARTS).collect();
        let parts: Vec<Vec<f64>> = parts.into_par_iter().map(part).collect();
        let mut sums = vec![0.0; self.numbering.pressures.len()];
        for part in &parts {
            sums.iter_mut().zip(part).for_each(|(sum, value)| *sum += value);
        }
        sums
    }

    /// The same with compressed rows, G^T included, for a direct solver.
    #[must_use]
    pub fn to_sparse(&self) -> SparseMatrix {
        let Numbering { blocks, pressures, .. } = &self.numbering;
        // Row of each unknown as columns with their values; both triangles have the same pattern
        let mut rows: Vec<Vec<(u32, f64)>> = vec![Vec::new(); self.n()];
        for (row, unknowns) in blocks.iter().enumerate() {
            let own = || unknowns.iter().enumerate().filter_map(|(a, one)| one.map(|one| (a, one)));
            for (&column, index) in
                self.velocity.columns(row).iter().zip(self.velocity.entries(row))
            {
                let (leading, rest) = (self.velocity.blocks()[index], self.velocity_rest[index]);
                for (b, other) in blocks[column as usize].iter().enumerate() {
                    let Some(other) = other else { continue };
                    for (a, one) in own() {
                        rows[one as usize].push((*other, whole(leading[b][a], rest[b][a])));
                    }
                }
            }
            for index in self.gradient.entries(row) {
                let pressure = pressures[self.gradient.pressures()[index] as usize];
                let (leading, rest) = (self.gradient.values()[index], self.gradient_rest[index]);
                for (a, one) in own() {
                    let value = whole(leading[a], rest[a]);
                    rows[pressure as usize].push((one, value));
                    rows[one as usize].push((pressure, value));
                }
            }
        }
        rows.iter_mut().for_each(|row| row.sort_unstable_by_key(|(column, _)| *column));
        let columns = |row: &Vec<(u32, f64)>| -> Vec<usize> {
            row.iter().map(|(column, _)| *column as usize).collect()
        };
        let pattern = Pattern::from_rows(rows.iter().map(columns));
        let values = rows.iter().flatten().map(|(_, value)| *value).collect();
        SparseMatrix::new(pattern, values)
    }
}

/// The values of a column in some rows, zero in those that it does not have.
#[inline(always)]
fn values(column: &[f64], rows: [u16; B]) -> [f64; B] {
    let [first, second, third] = rows.map(usize::from);
    // Most cells have all velocities of a node, one after the other
    if (second, third) == (first + 1, first + 2) {
        return column
            .get(first..first + B)
            .and_then(|values| values.try_into().ok())
            .unwrap_or_default();
    }
    [first, second, third].map(|row| column.get(row).copied().unwrap_or(0.0))
}

/// A number that is the sum of two.
#[inline(always)]
fn whole(leading: f32, rest: f32) -> f64 {
    f64::from(leading) + f64::from(rest)
}

/// Adds to a number that is the sum of two.
#[inline(always)]
fn add(leading: &mut f32, rest: &mut f32, value: f64) {
    let sum = whole(*leading, *rest) + value;
    *leading = single(sum);
    *rest = single(sum - f64::from(*leading));
}
