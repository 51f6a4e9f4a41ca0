//! Open sides with mu du/dn - p n = 0: what the symmetric stress has too much there.
//!
//! With the stress 2 mu D(u) a free side means sigma n = 0. A developed flow leaves undisturbed
//! when mu (grad u) n - p n = 0 instead, so the part mu (grad u)^T n is taken off again:
//! - int_side mu d_i u_j n_j v_i ds.

use std::ops::Range;

use alewife_mesh::{Facet, Mesh};
use nalgebra::SMatrix;

use super::kernel::{CellInput, LocalLayout};
use crate::space::{FacetRule, Metric};

/// Facets of open sides.
#[derive(Debug, Clone)]
pub(super) struct OpenSides<const D: usize> {
    /// In the order of their cells.
    facets: Vec<Facet>,
    rule: FacetRule<D>,
}

impl<const D: usize> OpenSides<D> {
    /// The facets of these boundaries.
    pub fn new(mesh: &Mesh<D>, boundaries: &[usize], metric: Metric) -> Self {
        let is_open = |facet: &&Facet| boundaries.contains(&facet.boundary.index());
        let mut facets: Vec<_> = mesh.facets.iter().filter(is_open).copied().collect();
        facets.sort_by_key(|facet| facet.cell);
        Self { facets, rule: FacetRule::new(metric) }
    }

    /// Facets of a range of cells.
    pub fn of_cells(&self, cells: &Range<usize>) -> &[Facet] {
        let first_from = |cell: usize| self.facets.partition_point(|at| at.cell.index() < cell);
        &self.facets[first_from(cells.start)..first_from(cells.end)]
    }

    /// Adds the term of a facet to the raw matrix of its cell, which is stored by columns.
    pub fn add_to_matrix(
        &self,
        facet: &Facet,
        input: CellInput<'_, D>,
        local: LocalLayout<D>,
        matrix: &mut [f64],
    ) {
        let size = local.n_local();
        self.rule.for_each_point(input.mesh, facet, |at| {
            for a in 0..at.phi.len() {
                for b in 0..at.phi.len() {
                    for i in 0..D {
                        let weight = input.terms.viscosity * at.phi[a] * at.grad_phi[b][i];
                        for j in 0..D {
                            matrix[local.velocity(b, j) * size + local.velocity(a, i)] -=
                                weight * at.normal_ds[j];
                        }
                    }
                }
            }
        });
    }

    /// Adds the term of a facet to the raw residual of its cell.
    pub fn add_to_residual(
        &self,
        facet: &Facet,
        input: CellInput<'_, D>,
        local: LocalLayout<D>,
        residual: &mut [f64],
    ) {
        let CellInput { mesh, terms, fields } = input;
        let nodes = mesh.cell(facet.cell);
        self.rule.for_each_point(mesh, facet, |at| {
            let gradient: SMatrix<f64, D, D> =
                nodes.iter().zip(at.grad_phi).fold(SMatrix::zeros(), |sum, (&node, grad)| {
                    sum + fields.velocity[node] * grad.transpose()
                });
            let traction = gradient.transpose() * at.normal_ds * terms.viscosity;
            for (a, phi) in at.phi.iter().enumerate() {
                for i in 0..D {
                    residual[local.velocity(a, i)] -= traction[i] * phi;
                }
            }
        });
    }
}
