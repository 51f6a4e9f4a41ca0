//! `BlockDiagonal`: the inverse of the blocks on the diagonal, those of pairs of rows taken together.

use rayon::prelude::*;

use super::block_matrix::{Block, BlockMatrix};
use super::dense::invert;
use crate::sparse::single::single;

/// Rows that one task works on.
const ROWS: usize = 2048;

/// The inverse of the diagonal blocks of a matrix whose last rows are pairs.
#[derive(Debug)]
pub(super) struct BlockDiagonal<const B: usize> {
    /// Of the rows that are in no pair.
    blocks: Vec<Block<B>>,
    pairs: Vec<Pair<B>>,
}

/// The inverse of the 2 B x 2 B matrix of a pair: its blocks by row and column.
type Pair<const B: usize> = [[Block<B>; 2]; 2];

impl<const B: usize> BlockDiagonal<B> {
    /// Inverts the diagonal blocks of a square matrix; singular ones are taken for infinite, and their
    /// inverse is zero.
    pub fn new(matrix: &BlockMatrix<B>, n_pairs: usize) -> Self {
        let n_single = matrix.n_rows() - 2 * n_pairs;
        let blocks =
            (0..n_single).into_par_iter().map(|row| inverse(matrix, [row])[0][0]).collect();
        let pair = |pair: usize| {
            let first = n_single + 2 * pair;
            inverse(matrix, [first, first + 1])
        };
        Self { blocks, pairs: (0..n_pairs).map(pair).collect() }
    }

    /// Overwrites z with the inverse times r.
    pub fn apply(&self, r: &[[f32; B]], z: &mut [[f32; B]]) {
        let n_single = self.blocks.len();
        let chunks = z[..n_single].par_chunks_mut(ROWS).zip(self.blocks.par_chunks(ROWS));
        chunks.zip(r[..n_single].par_chunks(ROWS)).for_each(|((z, blocks), r)| {
            for ((z, block), r) in z.iter_mut().zip(blocks).zip(r) {
                *z = times(block, r);
            }
        });
        let in_pairs = z[n_single..].chunks_exact_mut(2).zip(r[n_single..].chunks_exact(2));
        for (pair, (z, r)) in self.pairs.iter().zip(in_pairs) {
            for (z, blocks) in z.iter_mut().zip(pair) {
                let [first, second] = [times(&blocks[0], &r[0]), times(&blocks[1], &r[1])];
                *z = std::array::from_fn(|a| first[a] + second[a]);
            }
        }
    }

    /// The diagonal of the inverse in a row.
    pub fn entries(&self, row: usize) -> [f32; B] {
        let block = self.blocks.get(row).unwrap_or_else(|| {
            let row = row - self.blocks.len();
            &self.pairs[row / 2][row % 2][row % 2]
        });
        std::array::from_fn(|a| block[a][a])
    }

    /// The inverse of the block of a row, in no pair.
    pub fn single(&self, row: usize) -> Option<&Block<B>> {
        self.blocks.get(row)
    }
}

#[inline(always)]
pub(super) fn times<const B: usize>(block: &Block<B>, x: &[f32; B]) -> [f32; B] {
    let mut y = [0.0; B];
    for b in 0..B {
        for a in 0..B {
            y[a] += block[b][a] * x[b];
        }
    }
    y
}

/// The inverse of the matrix in some rows and the same columns, by blocks.
fn inverse<const B: usize, const N: usize>(
    matrix: &BlockMatrix<B>,
    rows: [usize; N],
) -> [[Block<B>; N]; N] {
    let n = B * N;
    // Nodes have few unknowns, pairs twice as many
    let mut dense = [0.0; 36];
    let dense = &mut dense[..n * n];
    for (i, &row) in rows.iter().enumerate() {
        for (column, block) in matrix.row(row) {
            let Some(j) = rows.iter().position(|&other| other == column) else { continue };
            for b in 0..B {
                for a in 0..B {
                    dense[(i * B + a) * n + j * B + b] = f64::from(block[b][a]);
                }
            }
        }
    }
    if !invert(n, dense) {
        dense.fill(0.0);
    }
    let value = |i: usize, j: usize, a: usize, b: usize| single(dense[(i * B + a) * n + j * B + b]);
    std::array::from_fn(|i| {
        std::array::from_fn(|j| std::array::from_fn(|b| std::array::from_fn(|a| value(i, j, a, b))))
    })
}
