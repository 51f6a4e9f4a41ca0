//! The amount of a scalar in the fluid, and its extremes.

use alewife_mesh::Mesh;

use crate::space::{CellValues, Tables};

/// How much of a scalar there is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Amount {
    /// Its integral over the fluid (m3; m2 planar).
    pub total: f64,
    /// The volume of the fluid (m3; m2 planar).
    pub volume: f64,
    /// Its least value at a node.
    pub minimum: f64,
    /// Its largest value at a node.
    pub maximum: f64,
}

/// How much there is of a scalar with values at the nodes.
#[must_use]
pub fn amount<const D: usize>(mesh: &Mesh<D>, tables: &Tables<D>, values: &[f64]) -> Amount {
    let mut workspace = CellValues::default();
    let (mut total, mut volume) = (0.0, 0.0);
    for cell in mesh.cell_ids() {
        let nodes = mesh.cell(cell);
        workspace.for_each_point(tables, mesh, cell, |at| {
            let there = nodes
                .iter()
                .zip(at.phi)
                .fold(0.0, |sum, (&node, phi)| sum + phi * values[node.index()]);
            total += there * at.dx;
            volume += at.dx;
        });
    }
    let minimum = values.iter().copied().fold(f64::INFINITY, f64::min);
    let maximum = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    Amount { total, volume, minimum, maximum }
}
