//! Loop over cells: gather, add the terms, fold into the free unknowns, scatter.
//!
//! Cells are worked on in parallel in blocks; what they give is added in the order of the cells,
//! so that the sums have the same bits on any number of threads.

use std::ops::Range;
use std::sync::Arc;

use alewife_interrupt::Listener;
use alewife_mesh::{CellId, Mesh};
use rayon::prelude::*;

use super::kernel::{CellInput, CellKernel, LocalLayout};
use super::open_side::{OpenSide, OpenSides};
use super::parallel::for_each_cell;
use super::taylor_hood::quadratic_kernel;
use super::terms::{Convection, Fields, FlowTerms};
use crate::algebra::{AffineConstraints, CellFolds, CellMaps, CellUnknowns};
use crate::space::{DofLayout, Metric, Tables};

/// Cells whose unknowns a thread lists at a time.
const CELLS_PER_TASK: usize = 1024;

/// What assembling needs of a mesh: derived from it, replaced with it.
#[derive(Debug, Clone)]
pub struct Assembly<const D: usize> {
    tables: Tables<D>,
    kernel: Arc<dyn CellKernel<D>>,
    folds: CellFolds,
    open_sides: OpenSides<D>,
    layout: DofLayout<D>,
}

impl<const D: usize> Assembly<D> {
    /// For a mesh under constraints.
    ///
    /// `open` lists the sides with terms of their own; `frame` is the body whose velocity is an unknown of every cell, if
    /// any.
    #[must_use]
    pub fn new(
        mesh: &Mesh<D>,
        layout: DofLayout<D>,
        constraints: &AffineConstraints,
        metric: Metric,
        open: &[OpenSide],
        frame: Option<usize>,
    ) -> Self {
        let tables = Tables::new(metric);
        let kernel = quadratic_kernel(&tables, frame.is_some());
        let local = kernel.layout();
        let raw = raw_unknowns(mesh, &layout, local, frame);
        let folds = CellFolds::new(local.n_local(), raw, constraints);
        let open_sides = OpenSides::new(mesh, open, metric);
        Self { tables, kernel, folds, open_sides, layout }
    }

    /// The unknowns of the matrix of each cell, then those of each body that couple with each other.
    #[must_use]
    pub fn cell_unknowns(
        &self,
        constraints: &AffineConstraints,
        bodies: &[Vec<u32>],
    ) -> CellUnknowns {
        let mut unknowns = self.folds.unknowns(constraints);
        bodies.iter().for_each(|body| unknowns.push(body));
        unknowns
    }

    /// Where the matrices of cells go in one by compressed columns, with room for what couples unknowns of bodies.
    #[must_use]
    pub fn maps(&self, constraints: &AffineConstraints, bodies: &[Vec<u32>]) -> CellMaps {
        let is_pressure = pressure_unknowns(&self.layout, constraints);
        let couples = |row: usize, column: usize| !(is_pressure[row] && is_pressure[column]);
        CellMaps::new(&self.cell_unknowns(constraints, bodies), couples)
    }

    /// Basis tables.
    #[must_use]
    pub fn tables(&self) -> &Tables<D> {
        &self.tables
    }

    /// Overwrites the matrices of some cells, folded where they have to be, each at the beginning of
    /// `stride` numbers.
    fn matrices(
        &self,
        constraints: &AffineConstraints,
        input: CellInput<'_, D>,
        cells: Range<usize>,
        stride: usize,
        matrices: &mut [f64],
    ) {
        let n_entries = self.kernel.layout().n_local().pow(2);
        self.raw_matrices(input, cells.clone(), stride, matrices);
        let mut raw = Vec::new();
        for (cell, matrix) in cells.zip(matrices.chunks_exact_mut(stride)) {
            if self.folds.is_folded(cell) {
                raw.clear();
                raw.extend_from_slice(&matrix[..n_entries]);
                self.folds.fold(cell, constraints, &raw, matrix);
            }
        }
    }

    /// Overwrites the raw matrices of some cells, each at the beginning of `stride` numbers.
    fn raw_matrices(
        &self,
        input: CellInput<'_, D>,
        cells: Range<usize>,
        stride: usize,
        matrices: &mut [f64],
    ) {
        let local = self.kernel.layout();
        let n_entries = local.n_local() * local.n_local();
        self.kernel.matrices(input, cells.clone(), stride, matrices);
        for at in self.open_sides.of_cells(&cells) {
            let start = (at.facet.cell.index() - cells.start) * stride;
            let matrix = &mut matrices[start..start + n_entries];
            self.open_sides.add_to_matrix(at, input, local, matrix);
        }
    }

    /// Overwrites the raw residuals of some cells.
    fn residuals(&self, input: CellInput<'_, D>, cells: Range<usize>, residuals: &mut [f64]) {
        let local = self.kernel.layout();
        self.kernel.residuals(input, cells.clone(), residuals);
        for at in self.open_sides.of_cells(&cells) {
            let start = (at.facet.cell.index() - cells.start) * local.n_fluid();
            let residual = &mut residuals[start..start + local.n_fluid()];
            self.open_sides.add_to_residual(at, input, local, residual);
        }
    }
}

/// Raw unknowns of all cells, in the order of [`LocalLayout`].
fn raw_unknowns<const D: usize>(
    mesh: &Mesh<D>,
    layout: &DofLayout<D>,
    local: LocalLayout<D>,
    frame: Option<usize>,
) -> Vec<u32> {
    let n_local = local.n_local();
    let mut raw = vec![0; n_local * mesh.n_cells()];
    raw.par_chunks_mut(CELLS_PER_TASK * n_local).enumerate().for_each(|(task, raw)| {
        let first = task * CELLS_PER_TASK;
        for (index, raw) in raw.chunks_exact_mut(n_local).enumerate() {
            let cell = CellId::new(first + index);
            let nodes = mesh.cell(cell);
            let velocities = (0..D).flat_map(|axis| nodes.iter().map(move |&n| (n, axis)));
            let velocities = velocities.map(|(node, axis)| layout.velocity(node, axis));
            let vertices = DofLayout::pressure_nodes(mesh, cell).iter();
            let pressures = vertices.map(|&node| layout.pressure(node));
            let frame = frame
                .into_iter()
                .flat_map(|body| (0..local.n_frame).map(move |axis| layout.rigid(body, axis)));
            for (raw, unknown) in raw.iter_mut().zip(velocities.chain(pressures).chain(frame)) {
                *raw =
                    u32::try_from(unknown).expect("unknowns are fewer than four thousand million");
            }
        }
    });
    raw
}

/// Whether each free unknown is a pressure.
#[must_use]
pub fn pressure_unknowns<const D: usize>(
    layout: &DofLayout<D>,
    constraints: &AffineConstraints,
) -> Vec<bool> {
    let mut is_pressure = vec![false; constraints.n_unknowns()];
    for vertex in layout.vertices() {
        if let Some(unknown) = constraints.unknown(layout.pressure(vertex)) {
            is_pressure[unknown] = true;
        }
    }
    is_pressure
}

/// Gives `scatter` what each cell has of P^T A P, in the order of the cells, for the matrix A of the terms,
/// linearised at the fields. Where the work of this thread is to end, numbers of some cells are left out.
pub fn assemble<const D: usize>(
    assembly: &Assembly<D>,
    mesh: &Mesh<D>,
    constraints: &AffineConstraints,
    terms: &FlowTerms<'_, D>,
    fields: &Fields<'_, D>,
    mut scatter: impl FnMut(usize, &[f64]) + Send,
) {
    let has_frame = assembly.kernel.layout().n_frame > 0;
    debug_assert!(has_frame || terms.convection != Convection::NewtonInFrame);
    let input = CellInput { mesh, terms, fields };
    let stride = assembly.folds.largest_matrix();
    let listener = Listener::here();
    let compute = |cells: Range<usize>, matrices: &mut [f64]| {
        if !listener.is_requested() {
            assembly.matrices(constraints, input, cells, stride, matrices);
        }
    };
    for_each_cell(mesh.n_cells(), stride, compute, |cell, matrix| {
        // To add them takes as long as to compute them
        if !listener.was_ended() {
            scatter(cell, matrix);
        }
    });
}

/// The raw residual of the terms at the fields, without anything of the bodies' own.
#[must_use]
pub fn residual<const D: usize>(
    assembly: &Assembly<D>,
    mesh: &Mesh<D>,
    terms: &FlowTerms<'_, D>,
    fields: &Fields<'_, D>,
) -> Vec<f64> {
    let input = CellInput { mesh, terms, fields };
    let mut total = vec![0.0; assembly.layout.n_raw()];
    for_each_cell(
        mesh.n_cells(),
        assembly.kernel.layout().n_fluid(),
        |cells, residuals| assembly.residuals(input, cells, residuals),
        |cell, local| {
            for (&raw, value) in assembly.folds.raw_unknowns(cell).iter().zip(local) {
                total[raw as usize] += value;
            }
        },
    );
    total
}

/// The derivative by the raw unknowns of the product of the residual of the terms with weights w, one for each row:
/// A^T w for the matrix A of the terms, linearised at the fields.
#[must_use]
pub fn transposed_product<const D: usize>(
    assembly: &Assembly<D>,
    mesh: &Mesh<D>,
    terms: &FlowTerms<'_, D>,
    fields: &Fields<'_, D>,
    weights: &[f64],
) -> Vec<f64> {
    let input = CellInput { mesh, terms, fields };
    let local = assembly.kernel.layout();
    let n_local = local.n_local();
    let mut total = vec![0.0; assembly.layout.n_raw()];
    for_each_cell(
        mesh.n_cells(),
        n_local,
        |cells, products| {
            let mut matrices = vec![0.0; cells.len() * n_local * n_local];
            assembly.raw_matrices(input, cells.clone(), n_local * n_local, &mut matrices);
            let of_cell = matrices.chunks_exact(n_local * n_local);
            for ((cell, matrix), product) in cells.zip(of_cell).zip(products.chunks_mut(n_local)) {
                let rows = &assembly.folds.raw_unknowns(cell)[..local.n_fluid()];
                for (sum, column) in product.iter_mut().zip(matrix.chunks_exact(n_local)) {
                    let terms = rows.iter().zip(column).map(|(&row, a)| a * weights[row as usize]);
                    *sum = terms.sum();
                }
            }
        },
        |cell, product| {
            for (&raw, value) in assembly.folds.raw_unknowns(cell).iter().zip(product) {
                total[raw as usize] += value;
            }
        },
    );
    total
}
