//! Aggregates of neighbouring rows, and the prolongation by them, smoothed once (@vanek1996).

use super::block_diagonal::times;
use super::block_matrix::{Block, BlockMatrix, RowBuilder};
use super::chebyshev::Chebyshev;
use super::product::product;
use crate::sparse::index::to_u32;

/// Marks a row that is in no aggregate yet.
const FREE: u32 = u32::MAX;

/// Rows in aggregates.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Aggregates {
    /// The aggregate of each row; the rows of pairs are their own, the last ones.
    pub of_row: Vec<u32>,
    /// Number of aggregates.
    pub count: usize,
}

/// Rows with which a row has a coupling, but for those of pairs.
fn neighbours<const B: usize>(
    matrix: &BlockMatrix<B>,
    row: usize,
    n_single: usize,
) -> impl Iterator<Item = (usize, &Block<B>)> {
    matrix.row(row).filter(move |(column, block)| {
        *column != row && *column < n_single && block.iter().flatten().any(|value| *value != 0.0)
    })
}

/// Aggregates of the rows of a matrix, of which the last are pairs: a row with all its neighbours where
/// none of them is taken, then what is left with the neighbour it couples to most.
pub(super) fn aggregate<const B: usize>(matrix: &BlockMatrix<B>, n_pairs: usize) -> Aggregates {
    let n_single = matrix.n_rows() - 2 * n_pairs;
    let mut of_row = vec![FREE; matrix.n_rows()];
    let mut count = 0;
    for row in 0..n_single {
        let all = || neighbours(matrix, row, n_single).map(|(column, _)| column);
        let is_free = of_row[row] == FREE && all().all(|column| of_row[column] == FREE);
        if is_free && all().next().is_some() {
            of_row[row] = to_u32(count);
            all().for_each(|column| of_row[column] = to_u32(count));
            count += 1;
        }
    }
    let first = of_row.clone();
    for row in 0..n_single {
        if first[row] != FREE {
            continue;
        }
        let taken = neighbours(matrix, row, n_single).filter(|(column, _)| first[*column] != FREE);
        let size =
            |block: &Block<B>| block.iter().flatten().map(|value| value * value).sum::<f32>();
        // The earlier of equals
        let closest = taken.fold(None, |most: Option<Coupling>, (column, block)| {
            let size = size(block);
            if most.as_ref().is_some_and(|most| most.size >= size) {
                most
            } else {
                Some(Coupling { column, size })
            }
        });
        if let Some(Coupling { column, .. }) = closest {
            of_row[row] = first[column];
        }
    }
    // Rows far from all others: with what is left around them
    for row in 0..n_single {
        if of_row[row] == FREE {
            let left = neighbours(matrix, row, n_single).map(|(column, _)| column);
            let left: Vec<usize> = left.filter(|&column| of_row[column] == FREE).collect();
            of_row[row] = to_u32(count);
            left.into_iter().for_each(|column| of_row[column] = to_u32(count));
            count += 1;
        }
    }
    for row in &mut of_row[n_single..] {
        *row = to_u32(count);
        count += 1;
    }
    Aggregates { of_row, count }
}

/// How much a row couples to another.
struct Coupling {
    column: usize,
    size: f32,
}

/// (I - omega D^-1 A) T, T with the constants of each aggregate and omega = 4/3 over the largest
/// eigenvalue of D^-1 A. The rows of pairs stay those of T: they stand for themselves on each level.
pub(super) fn smoothed_prolongation<const B: usize>(
    matrix: &BlockMatrix<B>,
    smoother: &Chebyshev<B>,
    aggregates: &Aggregates,
) -> BlockMatrix<B> {
    let mut tentative = RowBuilder::new(aggregates.count);
    for &aggregate in &aggregates.of_row {
        tentative.push(aggregate, identity());
        tentative.end_row();
    }
    let images = product(matrix, &tentative.build());
    let omega = 4.0 / (3.0 * smoother.upper());
    let mut rows = RowBuilder::new(aggregates.count);
    for (row, &own) in aggregates.of_row.iter().enumerate() {
        match smoother.diagonal().single(row) {
            Some(inverse) => {
                for (column, block) in images.row(row) {
                    let mut smoothed =
                        block.map(|image| times(inverse, &image).map(|value| -omega * value));
                    if column == own as usize {
                        (0..B).for_each(|a| smoothed[a][a] += 1.0);
                    }
                    rows.push(to_u32(column), smoothed);
                }
            }
            None => rows.push(own, identity()),
        }
        rows.end_row();
    }
    rows.build()
}

fn identity<const B: usize>() -> Block<B> {
    std::array::from_fn(|b| std::array::from_fn(|a| if a == b { 1.0 } else { 0.0 }))
}
