//! Open sides with mu du/dn - p n = 0: what the symmetric stress has too much there.
//!
//! With the stress 2 mu D(u) a free side means sigma n = 0. A developed flow leaves undisturbed
//! when mu (grad u) n - p n = 0 instead, so the part mu (grad u)^T n is taken off again:
//! - int_side mu d_i u_j n_j v_i ds. Of a local viscosity mu is that at the point, linearised where it has a tangent.

use std::ops::Range;

use alewife_mesh::{Facet, Mesh, Point};
use nalgebra::SMatrix;

use super::kernel::{CellInput, LocalLayout};
use super::local_viscosity::{BasisAt, PointViscosity};
use crate::space::{FacetPoint, FacetRule, Metric};

/// Facets of open sides.
#[derive(Debug, Clone)]
pub(super) struct OpenSides<const D: usize> {
    /// In the order of their cells.
    facets: Vec<Facet>,
    rule: FacetRule<D>,
    metric: Metric,
}

impl<const D: usize> OpenSides<D> {
    /// The facets of these boundaries.
    pub fn new(mesh: &Mesh<D>, boundaries: &[usize], metric: Metric) -> Self {
        let is_open = |facet: &&Facet| boundaries.contains(&facet.boundary.index());
        let mut facets: Vec<_> = mesh.facets.iter().filter(is_open).copied().collect();
        facets.sort_by_key(|facet| facet.cell);
        Self { facets, rule: FacetRule::new(metric), metric }
    }

    /// Facets of a range of cells.
    pub fn of_cells(&self, cells: &Range<usize>) -> &[Facet] {
        let first_from = |cell: usize| self.facets.partition_point(|at| at.cell.index() < cell);
        &self.facets[first_from(cells.start)..first_from(cells.end)]
    }

    fn viscosity(
        &self,
        input: CellInput<'_, D>,
        facet: &Facet,
        at: &FacetPoint<'_, D>,
    ) -> PointViscosity<D> {
        input.terms.viscosity.at(BasisAt {
            metric: self.metric,
            nodes: input.mesh.cell(facet.cell),
            phi: at.phi,
            grad_phi: at.grad_phi,
            position: &at.position,
        })
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
            let viscosity = self.viscosity(input, facet, at);
            let traction = viscosity.gradient.transpose() * at.normal_ds;
            for a in 0..at.phi.len() {
                for b in 0..at.phi.len() {
                    let stretch = self.metric.hoop_strain(&Point::repeat(at.phi[b]), &at.position);
                    for i in 0..D {
                        let weight = viscosity.value * at.phi[a] * at.grad_phi[b][i];
                        for j in 0..D {
                            let entry =
                                &mut matrix[local.velocity(b, j) * size + local.velocity(a, i)];
                            *entry -= weight * at.normal_ds[j];
                            if viscosity.slope != 0.0 {
                                let stretch = if j == Metric::RADIAL { stretch } else { 0.0 };
                                let product = viscosity.product(j, &at.grad_phi[b], stretch);
                                *entry -= viscosity.slope * product * at.phi[a] * traction[i];
                            }
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
        let CellInput { mesh, fields, .. } = input;
        let nodes = mesh.cell(facet.cell);
        self.rule.for_each_point(mesh, facet, |at| {
            let gradient: SMatrix<f64, D, D> =
                nodes.iter().zip(at.grad_phi).fold(SMatrix::zeros(), |sum, (&node, grad)| {
                    sum + fields.velocity[node] * grad.transpose()
                });
            let viscosity = self.viscosity(input, facet, at);
            let mut traction = gradient.transpose() * at.normal_ds * viscosity.value;
            if viscosity.slope != 0.0 {
                let velocity: Point<D> =
                    nodes.iter().zip(at.phi).map(|(&node, phi)| fields.velocity[node] * *phi).sum();
                let hoop = self.metric.hoop_strain(&velocity, &at.position);
                let change = viscosity.change(&gradient, hoop);
                traction += viscosity.gradient.transpose() * at.normal_ds * change;
            }
            for (a, phi) in at.phi.iter().enumerate() {
                for i in 0..D {
                    residual[local.velocity(a, i)] -= traction[i] * phi;
                }
            }
        });
    }
}
