//! The velocity block of a matrix in blocks of three, and the transfer from its coarser level.

use super::data::Interpolation;
use super::numbering::{Numbering, Place};
use super::vector::B;
use crate::multigrid::{Block, BlockMatrix, RowBuilder};
use crate::sparse::SparseMatrix;
use crate::sparse::index::to_u32;
use crate::sparse::single::single;

/// F in single precision. Components that are no unknowns get the mean of the others on their diagonal.
///
/// Columns are taken in their order, so that those of each row ascend.
pub(super) fn velocity_block(matrix: &SparseMatrix, numbering: &Numbering) -> BlockMatrix<B> {
    const NONE: u32 = u32::MAX;
    let pattern = matrix.pattern();
    let n = numbering.blocks.len();
    let columns_of = |own: usize| {
        let unknowns = numbering.blocks[own].iter().enumerate();
        unknowns.filter_map(|(b, unknown)| unknown.map(|unknown| (b, unknown as usize)))
    };
    let velocity = |unknown: u32| match numbering.places[unknown as usize] {
        Place::Velocity { row, component } => Some((row as usize, usize::from(component))),
        Place::Pressure(_) => None,
    };
    // The column in which a row had an entry last
    let mut last = vec![NONE; n];
    let mut starts = vec![0; n + 1];
    for own in 0..n {
        for (_, column) in columns_of(own) {
            for (row, _) in pattern.column(column).iter().filter_map(|&row| velocity(row)) {
                if last[row] != to_u32(own) {
                    last[row] = to_u32(own);
                    starts[row + 1] += 1;
                }
            }
        }
    }
    for row in 0..n {
        starts[row + 1] += starts[row];
    }
    let mut next = starts.clone();
    let (mut columns, mut blocks) = (vec![0; starts[n]], vec![[[0.0; B]; B]; starts[n]]);
    last.fill(NONE);
    for own in 0..n {
        for (b, column) in columns_of(own) {
            let values = &matrix.values()[pattern.entries(column)];
            for (&unknown, value) in pattern.column(column).iter().zip(values) {
                let Some((row, component)) = velocity(unknown) else { continue };
                if last[row] != to_u32(own) {
                    last[row] = to_u32(own);
                    columns[next[row]] = to_u32(own);
                    next[row] += 1;
                }
                blocks[next[row] - 1][b][component] = single(*value);
            }
        }
    }
    for (row, unknowns) in numbering.blocks.iter().enumerate() {
        let entries = starts[row]..starts[row + 1];
        let diagonal = columns[entries.clone()].binary_search(&to_u32(row));
        if let Ok(position) = diagonal {
            pad_diagonal(unknowns, &mut blocks[entries][position]);
        }
    }
    BlockMatrix::new(n, starts, columns, blocks)
}

/// Gives components that are no unknowns a diagonal entry.
fn pad_diagonal(unknowns: &[Option<u32>; B], block: &mut Block<B>) {
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
