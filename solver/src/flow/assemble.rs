//! Loop over cells: gather, add the terms, fold into the free unknowns, scatter.
//!
//! Cells are worked on in parallel in blocks; their matrices are added in the order of the cells,
//! so that the sums have the same bits on any number of threads.

use alewife_mesh::{Facet, Mesh, nodes_per_cell};
use rayon::prelude::*;

use super::cell_terms::{cell_matrix, cell_residual};
use super::open_side::add_open_side;
use super::terms::{Convection, Fields, FlowTerms};
use crate::algebra::{AffineConstraints, CellMaps, Pattern};
use crate::space::{CellValues, DofLayout, Rule, Tables, interval_rule};

/// Cells a thread takes at a time, and cells whose matrices are held at once.
const CELLS_PER_TASK: usize = 32;
const CELLS_PER_BLOCK: usize = 1024;

/// What assembling needs of a mesh: derived from it, replaced with it.
#[derive(Debug, Clone)]
pub struct Assembly {
    tables: Tables<2>,
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
        let mut raw = Vec::new();
        for cell in 0..mesh.n_cells() {
            let nodes = mesh.cell(cell);
            for &node in nodes {
                raw.extend((0..2).map(|axis| layout.velocity(node as usize, axis) as u32));
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
        let n_local = nodes_per_cell(2) * 2 + 3 + if frame.is_some() { 2 } else { 0 };
        let (pattern, maps) = CellMaps::new(n_local, raw, constraints, |row, column| {
            !(is_pressure[row] && is_pressure[column])
        });
        let mut open = vec![None; mesh.n_cells()];
        for facet in &mesh.facets {
            if open_boundaries.contains(&usize::from(facet.boundary)) {
                open[facet.cell as usize] = Some(*facet);
            }
        }
        let assembly = Self {
            tables: Tables::new(axisymmetric),
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
        nodes_per_cell(2) * 2 + 3 + if self.with_frame { 2 } else { 0 }
    }
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
    let n_local = assembly.n_local();
    let cells: Vec<usize> = (0..mesh.n_cells()).collect();
    for block in cells.chunks(CELLS_PER_BLOCK) {
        let reduced: Vec<Vec<Vec<f64>>> = block
            .par_chunks(CELLS_PER_TASK)
            .map(|task| {
                let mut workspace = CellValues::default();
                let mut matrix = vec![0.0; n_local * n_local];
                task.iter()
                    .map(|&cell| {
                        cell_matrix::<2, 6>(
                            mesh,
                            cell,
                            &assembly.tables,
                            terms,
                            fields,
                            &mut workspace,
                            &mut matrix,
                        );
                        if let Some(facet) = &assembly.open[cell] {
                            add_open_side(
                                mesh,
                                facet,
                                &assembly.facet_rule,
                                assembly.tables.is_axisymmetric(),
                                terms.viscosity,
                                Some((&mut matrix, n_local)),
                                None,
                            );
                        }
                        let mut reduced = Vec::new();
                        assembly.maps.reduce(cell, constraints, &matrix, &mut reduced);
                        reduced
                    })
                    .collect()
            })
            .collect();
        for (&cell, matrix) in block.iter().zip(reduced.iter().flatten()) {
            assembly.maps.scatter(cell, matrix, values);
        }
    }
}

/// The raw residual of the terms at the fields, without anything of the bodies' own.
#[must_use]
pub fn residual(
    assembly: &Assembly,
    mesh: &Mesh<2>,
    terms: &FlowTerms<'_, 2>,
    fields: &Fields<'_, 2>,
) -> Vec<f64> {
    let n_fluid = nodes_per_cell(2) * 2 + 3;
    let cells: Vec<usize> = (0..mesh.n_cells()).collect();
    let mut total = vec![0.0; assembly.layout.n_raw()];
    for block in cells.chunks(CELLS_PER_BLOCK) {
        let locals: Vec<Vec<f64>> = block
            .par_chunks(CELLS_PER_TASK)
            .map(|task| {
                let mut workspace = CellValues::default();
                let mut locals = vec![0.0; n_fluid * task.len()];
                for (&cell, local) in task.iter().zip(locals.chunks_mut(n_fluid)) {
                    cell_residual::<2, 6>(
                        mesh,
                        cell,
                        &assembly.tables,
                        terms,
                        fields,
                        &mut workspace,
                        local,
                    );
                    if let Some(facet) = &assembly.open[cell] {
                        add_open_side(
                            mesh,
                            facet,
                            &assembly.facet_rule,
                            assembly.tables.is_axisymmetric(),
                            terms.viscosity,
                            None,
                            Some((local, fields.velocity)),
                        );
                    }
                }
                locals
            })
            .collect();
        let locals = locals.iter().flat_map(|task| task.chunks(n_fluid));
        for (&cell, local) in block.iter().zip(locals) {
            for (&raw, value) in assembly.maps.raw_unknowns(cell).iter().zip(local) {
                total[raw as usize] += value;
            }
        }
    }
    total
}
