//! `BlockMatrix`: a sparse matrix of small dense blocks in single precision, by compressed rows.

use std::ops::Range;

use rayon::prelude::*;

use crate::sparse::index::to_u32;
use crate::sparse::lists::{Lists, Parts, starts_by_item};

/// A dense block, column by column.
pub(crate) type Block<const B: usize> = [[f32; B]; B];

/// Rows that one task works on.
const ROWS: usize = 256;

/// A sparse matrix of B x B blocks, by compressed rows.
///
/// Rows and columns are counted in blocks. The columns of a row are in no particular order, each is stored
/// once.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct BlockMatrix<const B: usize> {
    n_columns: usize,
    /// Start of each row in `columns` and `blocks`, and the end of the last.
    starts: Vec<usize>,
    columns: Vec<u32>,
    blocks: Vec<Block<B>>,
}

/// Collects the rows of a [`BlockMatrix`] in their order.
#[derive(Debug)]
pub(crate) struct RowBuilder<const B: usize> {
    n_columns: usize,
    starts: Vec<usize>,
    columns: Vec<u32>,
    blocks: Vec<Block<B>>,
}

impl<const B: usize> RowBuilder<B> {
    /// No rows yet of a matrix with so many columns.
    pub fn new(n_columns: usize) -> Self {
        Self { n_columns, starts: vec![0], columns: Vec::new(), blocks: Vec::new() }
    }

    /// Appends a block to the row at hand.
    pub fn push(&mut self, column: u32, block: Block<B>) {
        self.columns.push(column);
        self.blocks.push(block);
    }

    /// The next block belongs to the next row.
    pub fn end_row(&mut self) {
        self.starts.push(self.columns.len());
    }

    /// The matrix with the rows that were ended.
    pub fn build(self) -> BlockMatrix<B> {
        let Self { n_columns, starts, columns, blocks } = self;
        BlockMatrix { n_columns, starts, columns, blocks }
    }
}

impl<const B: usize> BlockMatrix<B> {
    /// Zeros in these columns of each row.
    pub fn zeros(columns: Lists, n_columns: usize) -> Self {
        let Parts { starts, items } = columns.into_parts();
        let blocks = vec![[[0.0; B]; B]; items.len()];
        Self { n_columns, starts, columns: items, blocks }
    }

    /// The rows of several matrices, one after the other.
    pub(super) fn stacked(n_columns: usize, parts: Vec<Self>) -> Self {
        let n_blocks = parts.iter().map(|part| part.columns.len()).sum();
        let mut all = Self {
            n_columns,
            starts: vec![0],
            columns: Vec::with_capacity(n_blocks),
            blocks: Vec::with_capacity(n_blocks),
        };
        for part in parts {
            let before = all.columns.len();
            all.starts.extend(part.starts[1..].iter().map(|start| start + before));
            all.columns.extend(part.columns);
            all.blocks.extend(part.blocks);
        }
        all
    }

    /// Number of rows of blocks.
    pub fn n_rows(&self) -> usize {
        self.starts.len() - 1
    }

    /// Number of columns of blocks.
    pub fn n_columns(&self) -> usize {
        self.n_columns
    }

    /// Number of stored blocks.
    pub fn n_blocks(&self) -> usize {
        self.blocks.len()
    }

    /// Memory of the blocks and their columns (bytes).
    pub fn n_bytes(&self) -> usize {
        self.n_blocks() * (size_of::<Block<B>>() + size_of::<u32>())
    }

    /// All blocks, row by row.
    pub fn blocks(&self) -> &[Block<B>] {
        &self.blocks
    }

    /// All blocks, row by row, to be changed.
    pub fn blocks_mut(&mut self) -> &mut [Block<B>] {
        &mut self.blocks
    }

    /// Index of a block among all, if it is stored, in a matrix with rows whose columns ascend.
    pub fn find(&self, row: usize, column: u32) -> Option<usize> {
        let entries = self.entries(row);
        let place = self.columns[entries.clone()].binary_search(&column);
        place.ok().map(|place| entries.start + place)
    }

    /// The diagonal of a row of blocks, zero where it is not stored.
    pub fn diagonal(&self, row: usize) -> [f32; B] {
        let block = self.row(row).find(|(column, _)| *column == row);
        block.map_or([0.0; B], |(_, block)| std::array::from_fn(|a| block[a][a]))
    }

    /// Columns of a row.
    pub fn columns(&self, row: usize) -> &[u32] {
        &self.columns[self.entries(row)]
    }

    /// The blocks of a row, among all.
    pub fn entries(&self, row: usize) -> Range<usize> {
        self.starts[row]..self.starts[row + 1]
    }

    /// Columns and blocks of a row.
    pub fn row(&self, row: usize) -> impl Iterator<Item = (usize, &Block<B>)> {
        let entries = self.entries(row);
        let columns = self.columns[entries.clone()].iter().map(|&column| column as usize);
        columns.zip(&self.blocks[entries])
    }

    /// Columns of a row, and its blocks to be changed.
    pub(super) fn row_mut(&mut self, row: usize) -> impl Iterator<Item = (usize, &mut Block<B>)> {
        let entries = self.entries(row);
        let columns = self.columns[entries.clone()].iter().map(|&column| column as usize);
        columns.zip(&mut self.blocks[entries])
    }

    /// The product of one row with a vector.
    #[inline(always)]
    fn row_product(&self, row: usize, x: &[[f32; B]]) -> [f32; B] {
        // A sum for each column of the blocks: none waits for another
        let mut sums = [[0.0; B]; B];
        let entries = self.entries(row);
        for (&column, block) in self.columns[entries.clone()].iter().zip(&self.blocks[entries]) {
            let x = &x[column as usize];
            for b in 0..B {
                for a in 0..B {
                    sums[b][a] += block[b][a] * x[b];
                }
            }
        }
        let mut total = [0.0; B];
        for sum in sums {
            for a in 0..B {
                total[a] += sum[a];
            }
        }
        total
    }

    /// Overwrites y by f(row, A x) in each row, where f also gets the earlier value.
    fn for_each_row(
        &self,
        x: &[[f32; B]],
        y: &mut [[f32; B]],
        value: impl Fn([f32; B], &mut [f32; B]) + Sync,
    ) {
        y.par_chunks_mut(ROWS).enumerate().for_each(|(chunk, rows)| {
            for (offset, y) in rows.iter_mut().enumerate() {
                value(self.row_product(chunk * ROWS + offset, x), y);
            }
        });
    }

    /// y = A x.
    pub fn multiply(&self, x: &[[f32; B]], y: &mut [[f32; B]]) {
        self.for_each_row(x, y, |product, y| *y = product);
    }

    /// y += A x.
    pub fn multiply_add(&self, x: &[[f32; B]], y: &mut [[f32; B]]) {
        self.for_each_row(x, y, |product, y| (0..B).for_each(|a| y[a] += product[a]));
    }

    /// y -= A x.
    pub fn multiply_subtract(&self, x: &[[f32; B]], y: &mut [[f32; B]]) {
        self.for_each_row(x, y, |product, y| (0..B).for_each(|a| y[a] -= product[a]));
    }

    /// The transposed matrix; the columns of its rows ascend.
    pub fn transposed(&self) -> Self {
        let starts = starts_by_item(&self.columns, self.n_columns);
        let mut next = starts.clone();
        let mut columns = vec![0; self.columns.len()];
        let mut blocks = vec![[[0.0; B]; B]; self.blocks.len()];
        for row in 0..self.n_rows() {
            for (column, block) in self.row(row) {
                let entry = next[column];
                next[column] += 1;
                columns[entry] = to_u32(row);
                blocks[entry] = std::array::from_fn(|b| std::array::from_fn(|a| block[a][b]));
            }
        }
        Self { n_columns: self.n_rows(), starts, columns, blocks }
    }
}
