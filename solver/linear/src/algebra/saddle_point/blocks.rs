//! The velocity block of a matrix in blocks of three, and the transfer from its coarser level.

use super::data::Interpolation;
use super::numbering::{B, Numbering, Place};
use crate::multigrid::{Block, BlockMatrix, RowBuilder};
use crate::sparse::SparseMatrix;
use crate::sparse::index::to_u32;
use crate::sparse::single::single;

/// F in single precision. Components that are no unknowns get the mean of the others on their diagonal.
pub(super) fn velocity_block(matrix: &SparseMatrix, numbering: &Numbering) -> BlockMatrix<B> {
    let n = numbering.blocks.len();
    let by_column = transposed_block(matrix, numbering, n);
    // By rows: the transposed of the columns
    by_column.transposed()
}

/// The transposed of F: its rows are the columns of the matrix.
fn transposed_block(matrix: &SparseMatrix, numbering: &Numbering, n: usize) -> BlockMatrix<B> {
    const ABSENT: u32 = u32::MAX;
    let (pattern, values) = (matrix.pattern(), matrix.values());
    let mut rows = RowBuilder::new(n);
    let mut position = vec![ABSENT; n];
    let mut touched: Vec<u32> = Vec::new();
    let mut blocks: Vec<Block<B>> = Vec::new();
    for (own, unknowns) in numbering.blocks.iter().enumerate() {
        for (b, unknown) in unknowns.iter().enumerate() {
            let Some(column) = unknown else { continue };
            for entry in pattern.entries(*column as usize) {
                let Place::Velocity { row, component } = numbering.places[pattern.rows[entry]]
                else {
                    continue;
                };
                let slot = &mut position[row as usize];
                if *slot == ABSENT {
                    *slot = to_u32(blocks.len());
                    touched.push(row);
                    blocks.push([[0.0; B]; B]);
                }
                // Transposed: entry (a, b) of a block becomes (b, a)
                blocks[*slot as usize][usize::from(component)][b] = single(values[entry]);
            }
        }
        pad_diagonal(unknowns, position[own], &mut blocks);
        for (row, block) in touched.drain(..).zip(blocks.drain(..)) {
            position[row as usize] = ABSENT;
            rows.push(row, block);
        }
        rows.end_row();
    }
    rows.build()
}

/// Gives components that are no unknowns a diagonal entry.
fn pad_diagonal(unknowns: &[Option<u32>; B], position: u32, blocks: &mut [Block<B>]) {
    let Some(block) = blocks.get_mut(position as usize) else { return };
    let free = unknowns.iter().flatten().count().max(1);
    let trace: f32 = (0..B).map(|a| block[a][a]).sum();
    let mean = if trace > 0.0 { trace / free as f32 } else { 1.0 };
    for a in (0..B).filter(|&a| unknowns[a].is_none()) {
        block[a][a] = mean;
    }
}

/// The prolongation from the coarser level, which has the nodes with an unknown on both levels, and the
/// bodies.
pub(super) fn transfer(interpolation: &Interpolation, numbering: &Numbering) -> BlockMatrix<B> {
    let is_coarse = |block: &[Option<u32>; B]| {
        block.iter().flatten().any(|&unknown| interpolation.is_coarse(unknown as usize))
    };
    let mut n_coarse = 0;
    let coarse_row: Vec<Option<u32>> = numbering
        .blocks
        .iter()
        .enumerate()
        .map(|(row, block)| {
            let is_coarse = row >= numbering.n_nodes || is_coarse(block);
            n_coarse += u32::from(is_coarse);
            is_coarse.then(|| n_coarse - 1)
        })
        .collect();
    let mut rows = RowBuilder::new(n_coarse as usize);
    let mut found: Vec<Found> = Vec::new();
    for (own, unknowns) in numbering.blocks.iter().enumerate() {
        for (a, unknown) in unknowns.iter().enumerate() {
            let Some(unknown) = unknown else {
                // A component that is no unknown stands for itself
                if let Some(row) = coarse_row[own] {
                    add(&mut found, row, a, a, 1.0);
                }
                continue;
            };
            for term in interpolation.terms(*unknown as usize) {
                let place = numbering.places[term.unknown as usize];
                let Place::Velocity { row, component } = place else { continue };
                let Some(row) = coarse_row[row as usize] else { continue };
                add(&mut found, row, a, usize::from(component), single(term.weight));
            }
        }
        for Found { column, block } in found.drain(..) {
            rows.push(column, block);
        }
        rows.end_row();
    }
    rows.build()
}

/// A block of the row at hand.
struct Found {
    column: u32,
    block: Block<B>,
}

/// Adds to an entry of the block in a column.
fn add(found: &mut Vec<Found>, column: u32, a: usize, b: usize, value: f32) {
    let known = found.iter().position(|other| other.column == column);
    let index = known.unwrap_or_else(|| {
        found.push(Found { column, block: [[0.0; B]; B] });
        found.len() - 1
    });
    found[index].block[b][a] += value;
}
