//! The transfer of velocities from the coarser level, in blocks.

use super::super::data::Interpolation;
use super::super::matrix::{B, Numbering, Place};
use crate::multigrid::{Block, BlockMatrix, RowBuilder};
use crate::sparse::single::single;

/// The prolongation from the coarser level, which has the nodes with an unknown on both levels, and the
/// bodies.
pub(in super::super) fn transfer(
    interpolation: &Interpolation,
    numbering: &Numbering,
) -> BlockMatrix<B> {
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
