//! Products of sparse block matrices, row by row (@gustavson1978).

use rayon::prelude::*;

use super::block_matrix::{Block, BlockMatrix, RowBuilder};
use crate::sparse::index::to_u32;

/// Rows that one task works on.
const ROWS: usize = 512;
/// Marks a column that the row at hand does not have yet.
const ABSENT: u32 = u32::MAX;

/// A B.
pub(super) fn product<const B: usize>(
    left: &BlockMatrix<B>,
    right: &BlockMatrix<B>,
) -> BlockMatrix<B> {
    let n_columns = right.n_columns();
    let chunks: Vec<usize> = (0..left.n_rows()).step_by(ROWS).collect();
    let parts = chunks.par_iter().map_init(
        || vec![ABSENT; n_columns],
        |place, &start| {
            let mut rows = RowBuilder::new(n_columns);
            for row in start..(start + ROWS).min(left.n_rows()) {
                push_row(left.row(row), right, place, &mut rows);
            }
            rows.build()
        },
    );
    BlockMatrix::stacked(n_columns, parts.collect())
}

/// Appends the sum of rows of `right` with the blocks of a row as factors. `place` is all `ABSENT` before
/// and after.
fn push_row<'a, const B: usize>(
    factors: impl Iterator<Item = (usize, &'a Block<B>)>,
    right: &BlockMatrix<B>,
    place: &mut [u32],
    rows: &mut RowBuilder<B>,
) {
    let mut columns = Vec::new();
    let mut sums: Vec<Block<B>> = Vec::new();
    for (middle, factor) in factors {
        for (column, block) in right.row(middle) {
            if place[column] == ABSENT {
                place[column] = to_u32(sums.len());
                columns.push(column);
                sums.push([[0.0; B]; B]);
            }
            add_product(factor, block, &mut sums[place[column] as usize]);
        }
    }
    for (column, sum) in columns.into_iter().zip(sums) {
        place[column] = ABSENT;
        rows.push(to_u32(column), sum);
    }
    rows.end_row();
}

/// sum += A B for blocks.
#[inline(always)]
fn add_product<const B: usize>(left: &Block<B>, right: &Block<B>, sum: &mut Block<B>) {
    for b in 0..B {
        for k in 0..B {
            for a in 0..B {
                sum[b][a] += left[k][a] * right[b][k];
            }
        }
    }
}

/// P^T A P, with P^T given as well.
pub(super) fn galerkin<const B: usize>(
    restriction: &BlockMatrix<B>,
    matrix: &BlockMatrix<B>,
    prolongation: &BlockMatrix<B>,
) -> BlockMatrix<B> {
    product(restriction, &product(matrix, prolongation))
}
