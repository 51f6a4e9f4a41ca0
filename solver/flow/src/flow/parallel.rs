//! Loop over cells in parallel, with sums in the order of the cells.

use std::ops::Range;

use alewife_mesh::{CellId, Mesh};
use rayon::prelude::*;

use crate::space::{CellValues, PointValues, Tables};

/// Cells a thread takes at a time: enough for what handing them over costs, few enough that the threads end
/// together.
const CELLS_PER_TASK: usize = 16;
/// Numbers of a block for each thread: they stay in its cache.
const NUMBERS_PER_THREAD: usize = 1 << 17;

/// Lets `compute` fill `size` numbers for each cell, in parallel, and hands those of one cell
/// after the other to `add`, in the order of the cells, so that sums have the same bits on any number
/// of threads.
///
/// While one thread adds what a block of cells gave, the others work on the next block.
pub fn for_each_cell(
    n_cells: usize,
    size: usize,
    compute: impl Fn(Range<usize>, &mut [f64]) + Sync,
    mut add: impl FnMut(usize, &[f64]) + Send,
) {
    let tasks_per_thread = (NUMBERS_PER_THREAD / (CELLS_PER_TASK * size)).max(1);
    let block_size = CELLS_PER_TASK * tasks_per_thread * rayon::current_num_threads();
    let block = |index: usize| {
        let start = (index * block_size).min(n_cells);
        start..(start + block_size).min(n_cells)
    };
    let compute_block = |index: usize, results: &mut [f64]| {
        let cells = block(index);
        results[..cells.len() * size].par_chunks_mut(CELLS_PER_TASK * size).enumerate().for_each(
            |(task, results)| {
                let start = cells.start + task * CELLS_PER_TASK;
                compute(start..start + results.len() / size, results);
            },
        );
    };
    let mut next = vec![0.0; block_size.min(n_cells) * size];
    let mut done = next.clone();
    // Inside the pool, so that no block has to be handed over to it.
    rayon::scope(|_| {
        compute_block(0, &mut next);
        for index in 0..n_cells.div_ceil(block_size) {
            std::mem::swap(&mut next, &mut done);
            rayon::join(
                || {
                    for (cell, result) in block(index).zip(done.chunks_exact(size)) {
                        add(cell, result);
                    }
                },
                || compute_block(index + 1, &mut next),
            );
        }
    });
}

/// Adds the integrals of basis functions over the mesh to one value for each node that has one, its
/// first `per_cell` nodes in each cell.
pub fn integrate_basis<const D: usize>(
    mesh: &Mesh<D>,
    tables: &Tables<D>,
    per_cell: usize,
    basis: impl for<'a> Fn(&PointValues<'a, D>) -> &'a [f64] + Sync,
    integrals: &mut [f64],
) {
    let compute = |cells: Range<usize>, results: &mut [f64]| {
        let mut workspace = CellValues::default();
        results.fill(0.0);
        for (cell, of_cell) in cells.map(CellId::new).zip(results.chunks_exact_mut(per_cell)) {
            workspace.for_each_point(tables, mesh, cell, |at| {
                of_cell.iter_mut().zip(basis(at)).for_each(|(sum, value)| *sum += value * at.dx);
            });
        }
    };
    for_each_cell(mesh.n_cells(), per_cell, compute, |cell, of_cell| {
        for (node, integral) in mesh.cell(CellId::new(cell)).iter().zip(of_cell) {
            integrals[node.index()] += integral;
        }
    });
}
