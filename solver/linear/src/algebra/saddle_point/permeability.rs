//! How easily pressure drives fluid past the nodes of a mesh: what `SchurComplement` has in films and tubes.
//!
//! Between two walls a gradient of pressure p drives a mean velocity of -g^2 / (12 mu) grad p, with g the
//! width of the gap; in a tube of radius a, -a^2 / (8 mu) grad p. Both are the mean of the w with -mu laplace w = 1
//! between the walls, in whatever section: no distances between surfaces are needed. Waves of pressure that are
//! longer than the gap then have the Schur complement G^T D^-1 G with D = m / w and lumped masses m, and not
//! a mass over the viscosity.

use std::sync::Arc;

use super::numbering::Numbering;
use super::vector::B;
use crate::multigrid::{BlockMatrix, Hierarchy, HierarchySettings, RowBuilder};
use crate::sparse::index::to_u32;

/// Degree of the smoothers.
const SMOOTHING: usize = 2;
/// Part of w at each node that the last cycle may change.
const ACCURACY: f32 = 0.1;
/// Cycles at most.
const CYCLES: usize = 16;

/// w at each node, of the velocity block, the transfer from its coarser level and masses of the nodes, with bodies
/// at rest.
///
/// The three components of the block have a sum of four times a Laplacian: its form has the symmetric gradient.
pub(super) fn permeability(
    block: &BlockMatrix<B>,
    transfer: &BlockMatrix<B>,
    numbering: &Numbering,
    masses: &[f32],
) -> Vec<f32> {
    let matrix = Arc::new(trace(block, numbering));
    let settings = HierarchySettings {
        n_pairs: 0,
        degree: SMOOTHING,
        is_singular: false,
        is_convective: false,
    };
    let transfer = scalar_transfer(transfer, numbering);
    let mut hierarchy = Hierarchy::new(Arc::clone(&matrix), Some(transfer), settings);
    let rhs: Vec<[f32; 1]> = masses.iter().map(|mass| [4.0 * mass]).collect();
    let mut w = vec![[0.0]; rhs.len()];
    let mut change = w.clone();
    let mut residual = rhs.clone();
    for cycle in 0..CYCLES {
        hierarchy.cycle(&residual, &mut change);
        let mut is_accurate = true;
        for ([w], [change]) in w.iter_mut().zip(&change) {
            *w += change;
            is_accurate &= change.abs() <= ACCURACY * w.abs();
        }
        if is_accurate {
            tracing::debug!(cycle, "permeability");
            break;
        }
        residual.copy_from_slice(&rhs);
        matrix.multiply_subtract(&w, &mut residual);
    }
    w.into_iter().map(|[w]| w).collect()
}

/// The sum of the components of the blocks of nodes.
fn trace(block: &BlockMatrix<B>, numbering: &Numbering) -> BlockMatrix<1> {
    let mut rows = RowBuilder::new(numbering.n_nodes);
    for (row, unknowns) in numbering.blocks[..numbering.n_nodes].iter().enumerate() {
        for (column, block) in block.row(row).filter(|(column, _)| *column < numbering.n_nodes) {
            let free = (0..B).filter(|&a| unknowns[a].is_some());
            rows.push(to_u32(column), [[free.map(|a| block[a][a]).sum()]]);
        }
        rows.end_row();
    }
    rows.build()
}

/// The mean over the components of a transfer between nodes.
fn scalar_transfer(transfer: &BlockMatrix<B>, numbering: &Numbering) -> BlockMatrix<1> {
    let n_columns = transfer.n_columns() - 2 * numbering.n_bodies;
    let mut rows = RowBuilder::new(n_columns);
    for (row, unknowns) in numbering.blocks[..numbering.n_nodes].iter().enumerate() {
        let n_free = unknowns.iter().flatten().count() as f32;
        for (column, block) in transfer.row(row).filter(|(column, _)| *column < n_columns) {
            let free = (0..B).filter(|&a| unknowns[a].is_some());
            rows.push(to_u32(column), [[free.map(|a| block[a][a]).sum::<f32>() / n_free]]);
        }
        rows.end_row();
    }
    rows.build()
}
