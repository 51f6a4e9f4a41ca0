//! Discrete upwinding: the least diffusion along edges with which smoothers and coarser levels converge
//! for a matrix with convection (@kuzmin2006).

use super::block_matrix::{Block, BlockMatrix};

/// A matrix with diffusion added.
#[derive(Debug)]
pub(crate) struct Upwinded<const B: usize> {
    /// The matrix; the columns of its rows ascend.
    pub matrix: BlockMatrix<B>,
    /// What was added to the diagonal over the diagonal, each summed over all rows.
    pub part: f64,
}

/// Adds to a matrix with as many rows as columns, and a pattern that is symmetric, diffusion along each edge
/// between two rows: as much as makes the mean entries of both blocks negative where convection made one of
/// them positive.
///
/// Symmetric positive entries, which quadratic elements have, stay as they are. So do the pairs, which are
/// the last rows: bodies.
pub(crate) fn upwinded<const B: usize>(matrix: &BlockMatrix<B>, n_pairs: usize) -> Upwinded<B> {
    let transposed = matrix.transposed();
    let mut matrix = transposed.transposed();
    let n_single = matrix.n_rows() - 2 * n_pairs;
    let (mut added, mut total) = (0.0, 0.0);
    for row in 0..n_single {
        let mut sum = 0.0;
        let pairs = matrix.row_mut(row).zip(transposed.row(row));
        for ((column, block), (_, mirrored)) in pairs {
            if column == row || column >= n_single {
                continue;
            }
            let (here, there) = (mean_diagonal(block), mean_diagonal(mirrored));
            let convection = 0.5 * (here - there).abs();
            let diffusion = -0.5 * (here + there);
            let missing = (convection - diffusion.max(0.0)).max(0.0);
            add_to_diagonal(block, -missing);
            sum += missing;
        }
        for (_, block) in matrix.row_mut(row).filter(|(column, _)| *column == row) {
            total += f64::from(mean_diagonal(block));
            add_to_diagonal(block, sum);
        }
        added += f64::from(sum);
    }
    Upwinded { matrix, part: if total > 0.0 { added / total } else { 0.0 } }
}

fn mean_diagonal<const B: usize>(block: &Block<B>) -> f32 {
    (0..B).map(|a| block[a][a]).sum::<f32>() / B as f32
}

fn add_to_diagonal<const B: usize>(block: &mut Block<B>, value: f32) {
    for a in 0..B {
        block[a][a] += value;
    }
}
