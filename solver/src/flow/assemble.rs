//! Loop over cells: gather, add the terms, fold into the free unknowns, scatter.
//!
//! Cells are worked on in parallel in blocks; what they give is added in the order of the cells,
//! so that the sums have the same bits on any number of threads.

use std::ops::Range;

use alewife_mesh::{Facet, Mesh, nodes_per_cell};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::cell_terms::{Input, LocalLayout, cell_matrix, cell_residual};
use super::open_side::add_open_side;
use super::points::PointTable;
use super::terms::{Convection, Fields, FlowTerms};
use crate::algebra::{AffineConstraints, CellMaps, Pattern};
use crate::space::{DofLayout, Rule, Tables, interval_rule};

/// Cells a thread takes at a time: their matrices stay in its cache.
const CELLS_PER_TASK: usize = 64;

/// Nodes of a cell, and nodes rounded up to whole registers.
const N: usize = nodes_per_cell(2);
const P: usize = N.next_multiple_of(4);
/// Velocities and pressures of a cell.
const N_FLUID: usize = LocalLayout::<2, N>::FLUID;

/// Basis values on cells with straight sides.
#[derive(Debug, Clone)]
enum StraightTable {
    Planar(PointTable<2, N, P, 8>),
    /// The factor r asks for a rule of higher degree.
    Axisymmetric(PointTable<2, N, P, 12>),
}

/// What assembling needs of a mesh: derived from it, replaced with it.
#[derive(Debug, Clone)]
pub struct Assembly {
    tables: Tables<2>,
    straight: StraightTable,
    curved: PointTable<2, N, P, 16>,
    maps: CellMaps,
    /// The open side of each cell that has one.
    open: Vec<Option<Facet>>,
    facet_rule: Rule<1>,
    layout: DofLayout<2>,
    with_frame: bool,
}

impl Assembly {
    /// Pattern and maps of a mesh under constraints.
    ///
    /// `open_boundaries` lists the sides with the do-nothing condition; `frame` is the body whose
    /// velocity is an unknown of every cell, if any.
    #[must_use]
    pub fn new(
        mesh: &Mesh<2>,
        layout: DofLayout<2>,
        constraints: &AffineConstraints,
        axisymmetric: bool,
        open_boundaries: &[usize],
        frame: Option<usize>,
    ) -> (Pattern, Self) {
        // In the order of `LocalLayout`.
        let n_local = N_FLUID + if frame.is_some() { 2 } else { 0 };
        let mut raw = Vec::with_capacity(n_local * mesh.n_cells());
        for cell in 0..mesh.n_cells() {
            let nodes = mesh.cell(cell);
            for axis in 0..2 {
                raw.extend(nodes.iter().map(|&node| layout.velocity(node as usize, axis) as u32));
            }
            raw.extend(nodes[..3].iter().map(|&vertex| layout.pressure(vertex as usize) as u32));
            if let Some(body) = frame {
                raw.extend((0..2).map(|axis| layout.rigid(body, axis) as u32));
            }
        }
        let mut is_pressure = vec![false; constraints.n_unknowns()];
        for vertex in 0..layout.n_vertices {
            if let Some(unknown) = constraints.unknown(layout.pressure(vertex)) {
                is_pressure[unknown] = true;
            }
        }
        let (pattern, maps) = CellMaps::new(n_local, raw, constraints, |row, column| {
            !(is_pressure[row] && is_pressure[column])
        });
        let mut open = vec![None; mesh.n_cells()];
        for facet in &mesh.facets {
            if open_boundaries.contains(&usize::from(facet.boundary)) {
                open[facet.cell as usize] = Some(*facet);
            }
        }
        let tables = Tables::new(axisymmetric);
        let straight = if axisymmetric {
            StraightTable::Axisymmetric(PointTable::new(tables.rule(false)))
        } else {
            StraightTable::Planar(PointTable::new(tables.rule(false)))
        };
        let assembly = Self {
            straight,
            curved: PointTable::new(tables.rule(true)),
            tables,
            maps,
            open,
            facet_rule: interval_rule(4),
            layout,
            with_frame: frame.is_some(),
        };
        (pattern, assembly)
    }

    /// Basis tables.
    #[must_use]
    pub fn tables(&self) -> &Tables<2> {
        &self.tables
    }

    fn n_local(&self) -> usize {
        N_FLUID + if self.with_frame { 2 } else { 0 }
    }
}

/// Lets `compute` fill `size` numbers for each cell, in parallel, and hands those of one cell
/// after the other to `add`, in the order of the cells.
///
/// While one thread adds what a block of cells gave, the others work on the next block.
fn for_each_cell(
    n_cells: usize,
    size: usize,
    compute: impl Fn(Range<usize>, &mut [f64]) + Sync,
    mut add: impl FnMut(usize, &[f64]) + Send,
) {
    let block_size = CELLS_PER_TASK * rayon::current_num_threads();
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

/// Overwrites `values` with P^T A P of the terms, linearised at the fields.
pub fn assemble(
    assembly: &Assembly,
    mesh: &Mesh<2>,
    constraints: &AffineConstraints,
    terms: &FlowTerms<'_, 2>,
    fields: &Fields<'_, 2>,
    values: &mut [f64],
) {
    debug_assert!(assembly.with_frame || terms.convection != Convection::NewtonInFrame);
    values.fill(0.0);
    let axisymmetric = assembly.tables.is_axisymmetric();
    let input = Input { mesh, axisymmetric, terms, fields };
    let size = assembly.maps.largest_matrix();
    for_each_cell(
        mesh.n_cells(),
        size,
        |cells, results| {
            Arch::new().dispatch(Matrices { assembly, constraints, input, cells, size, results });
        },
        |cell, matrix| assembly.maps.scatter(cell, matrix, values),
    );
}

/// The raw residual of the terms at the fields, without anything of the bodies' own.
#[must_use]
pub fn residual(
    assembly: &Assembly,
    mesh: &Mesh<2>,
    terms: &FlowTerms<'_, 2>,
    fields: &Fields<'_, 2>,
) -> Vec<f64> {
    let axisymmetric = assembly.tables.is_axisymmetric();
    let input = Input { mesh, axisymmetric, terms, fields };
    let mut total = vec![0.0; assembly.layout.n_raw()];
    for_each_cell(
        mesh.n_cells(),
        N_FLUID,
        |cells, results| Arch::new().dispatch(Residuals { assembly, input, cells, results }),
        |cell, local| {
            for (&raw, value) in assembly.maps.raw_unknowns(cell).iter().zip(local) {
                total[raw as usize] += value;
            }
        },
    );
    total
}

/// The matrices of some cells, `size` numbers for each.
struct Matrices<'a> {
    assembly: &'a Assembly,
    constraints: &'a AffineConstraints,
    input: Input<'a, 2>,
    cells: Range<usize>,
    size: usize,
    results: &'a mut [f64],
}

impl WithSimd for Matrices<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { assembly, constraints, input, cells, size, results } = self;
        let n_local = assembly.n_local();
        let mut raw = vec![0.0; n_local * n_local];
        for (cell, result) in cells.zip(results.chunks_exact_mut(size)) {
            let is_folded = assembly.maps.is_folded(cell);
            let matrix = if is_folded { &mut raw[..] } else { &mut result[..n_local * n_local] };
            let with_frame = assembly.with_frame;
            if input.mesh.curved[cell] {
                cell_matrix::<S, 2, N, P, 16>(input, cell, &assembly.curved, with_frame, matrix);
            } else {
                match &assembly.straight {
                    StraightTable::Planar(table) => {
                        cell_matrix::<S, 2, N, P, 8>(input, cell, table, with_frame, matrix);
                    }
                    StraightTable::Axisymmetric(table) => {
                        cell_matrix::<S, 2, N, P, 12>(input, cell, table, with_frame, matrix);
                    }
                }
            }
            if let Some(facet) = &assembly.open[cell] {
                add_open_side(
                    input.mesh,
                    facet,
                    &assembly.facet_rule,
                    input.axisymmetric,
                    input.terms.viscosity,
                    Some((matrix, n_local)),
                    None,
                );
            }
            if is_folded {
                assembly.maps.fold(cell, constraints, &raw, result);
            }
        }
    }
}

/// The residuals of some cells.
struct Residuals<'a> {
    assembly: &'a Assembly,
    input: Input<'a, 2>,
    cells: Range<usize>,
    results: &'a mut [f64],
}

impl WithSimd for Residuals<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { assembly, input, cells, results } = self;
        for (cell, local) in cells.zip(results.chunks_exact_mut(N_FLUID)) {
            if input.mesh.curved[cell] {
                cell_residual::<S, 2, N, P, 16>(input, cell, &assembly.curved, local);
            } else {
                match &assembly.straight {
                    StraightTable::Planar(table) => {
                        cell_residual::<S, 2, N, P, 8>(input, cell, table, local);
                    }
                    StraightTable::Axisymmetric(table) => {
                        cell_residual::<S, 2, N, P, 12>(input, cell, table, local);
                    }
                }
            }
            if let Some(facet) = &assembly.open[cell] {
                add_open_side(
                    input.mesh,
                    facet,
                    &assembly.facet_rule,
                    input.axisymmetric,
                    input.terms.viscosity,
                    None,
                    Some((local, input.fields.velocity)),
                );
            }
        }
    }
}
