//! Damping of the velocities at nodes by walls and inertia: what pressures in films and tubes feel.
//!
//! Between two walls a gradient of pressure p drives a mean velocity of -g^2 / (12 mu) grad p, with g the
//! width of the gap; in a tube of radius a, -a^2 / (8 mu) grad p. Both are the mean of the w with -mu laplace w = 1
//! between the walls, in whatever section: no distances between surfaces are needed. Waves of pressure that are
//! longer than the gap then have the Schur complement G^T D^-1 G with D = m / w and lumped masses m, and not
//! a mass over the viscosity.

use super::data::Weights;
use super::numbering::Numbering;
use super::vector::B;
use crate::multigrid::{BlockMatrix, HierarchySettings, Multigrid, RowBuilder};
use crate::sparse::index::to_u32;
use crate::sparse::single::single;

/// Degree of the smoothers.
const SMOOTHING: usize = 2;
/// Part of w at each node that the last cycle may change.
const ACCURACY: f32 = 0.1;
/// Cycles at most.
const CYCLES: usize = 16;

/// D of each velocity at a node, from the velocity block and the transfer from its coarser level; zero for
/// what is no unknown, and where no w was found.
///
/// With density over time step w is its inverse far from walls.
pub(super) fn damping_at_nodes(
    block: &BlockMatrix<B>,
    transfer: &BlockMatrix<B>,
    numbering: &Numbering,
    weights: &Weights,
) -> Vec<[f32; B]> {
    let mut masses = numbering.split(&weights.lumped_mass, |_| 1.0).velocity;
    masses.truncate(numbering.n_nodes);
    let means = masses.iter().zip(&numbering.blocks);
    let means = means.map(|(masses, unknowns)| masses.iter().sum::<f32>() / n_free(unknowns));
    let w = permeability(block, transfer, numbering, means.collect());
    // Of the four Laplacians in the trace three are with inertia
    let inertia = single(0.25 * weights.inertia);
    for (masses, w) in masses.iter_mut().zip(&w) {
        let factor = if *w > 0.0 { 1.0 / w + inertia } else { 0.0 };
        masses.iter_mut().for_each(|mass| *mass *= factor);
    }
    masses
}

/// w at each node for the masses of the nodes, with bodies at rest.
///
/// The trace of the blocks is that of four Laplacians: the form has the symmetric gradient.
fn permeability(
    block: &BlockMatrix<B>,
    transfer: &BlockMatrix<B>,
    numbering: &Numbering,
    masses: Vec<f32>,
) -> Vec<f32> {
    let matrix = trace(block, numbering);
    let settings = HierarchySettings {
        n_pairs: 0,
        degree: SMOOTHING,
        is_singular: false,
        is_convective: false,
    };
    let transfer = scalar_transfer(transfer, numbering);
    let mut multigrid = Multigrid::new(matrix, Some(transfer), settings);
    let rhs: Vec<[f32; 1]> = masses.into_iter().map(|mass| [4.0 * mass]).collect();
    let mut w = vec![[0.0]; rhs.len()];
    let mut change = w.clone();
    let mut residual = rhs.clone();
    for _ in 0..CYCLES {
        multigrid.cycle(&residual, &mut change);
        let mut is_accurate = true;
        for ([w], [change]) in w.iter_mut().zip(&change) {
            *w += change;
            is_accurate &= change.abs() <= ACCURACY * w.abs();
        }
        if is_accurate {
            break;
        }
        residual.copy_from_slice(&rhs);
        multigrid.matrix().multiply_subtract(&w, &mut residual);
    }
    w.into_iter().map(|[w]| w).collect()
}

fn n_free(unknowns: &[Option<u32>; B]) -> f32 {
    unknowns.iter().flatten().count() as f32
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
        for (column, block) in transfer.row(row).filter(|(column, _)| *column < n_columns) {
            let free = (0..B).filter(|&a| unknowns[a].is_some());
            rows.push(
                to_u32(column),
                [[free.map(|a| block[a][a]).sum::<f32>() / n_free(unknowns)]],
            );
        }
        rows.end_row();
    }
    rows.build()
}
