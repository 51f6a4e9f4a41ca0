//! Open sides: what the symmetric stress has too much where developed flow leaves, and what fluid that enters brings.
//!
//! With the stress 2 mu D(u) a free side means sigma n = 0. A developed flow leaves undisturbed
//! when mu (grad u) n - p n = 0 instead, so the part mu (grad u)^T n is taken off again:
//! - int_side mu d_i u_j n_j v_i ds. Of a local viscosity mu is that at the point, linearised where it has a tangent.
//!
//! Fluid that enters at a velocity c . n < 0 brings kinetic energy rho |c . n| u^2 / 2. A side that is stabilised against it
//! has the traction rho beta min(c . n, 0) u beside its own: - int_side rho beta min(c . n, 0) u . v ds, which takes all
//! of that energy at beta = 1/2 (Esmaily Moghadam et al. 2011,
//! Bertoglio et al. 2017).

use std::ops::Range;

use alewife_mesh::{Facet, Mesh, Point};
use nalgebra::SMatrix;

use super::kernel::{CellInput, LocalLayout};
use super::local_viscosity::{BasisAt, PointViscosity};
use super::terms::Convection;
use crate::space::{FacetPoint, FacetRule, Metric};

/// A side with terms of its own in the equations of the fluid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OpenSide {
    /// Number of the boundary.
    pub boundary: usize,
    /// Whether its traction is that of a developed flow, mu du/dn - p n = 0, rather than zero.
    pub is_developed: bool,
    /// Part beta of the momentum of fluid that enters which a traction takes (1); 0 without stabilisation.
    pub backflow: f64,
}

/// Facets of open sides.
#[derive(Debug, Clone)]
pub(super) struct OpenSides<const D: usize> {
    /// In the order of their cells.
    facets: Vec<OpenFacet>,
    rule: FacetRule<D>,
    metric: Metric,
}

/// A facet of an open side.
#[derive(Debug, Clone, Copy)]
pub(super) struct OpenFacet {
    pub facet: Facet,
    side: OpenSide,
}

impl<const D: usize> OpenSides<D> {
    /// The facets of these sides.
    pub fn new(mesh: &Mesh<D>, sides: &[OpenSide], metric: Metric) -> Self {
        let open = |&facet: &Facet| {
            let side = sides.iter().find(|side| side.boundary == facet.boundary.index())?;
            Some(OpenFacet { facet, side: *side })
        };
        let mut facets: Vec<_> = mesh.facets.iter().filter_map(open).collect();
        facets.sort_by_key(|at| at.facet.cell);
        Self { facets, rule: FacetRule::new(metric), metric }
    }

    /// Facets of a range of cells.
    pub fn of_cells(&self, cells: &Range<usize>) -> &[OpenFacet] {
        let first_from =
            |cell: usize| self.facets.partition_point(|at| at.facet.cell.index() < cell);
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

    /// Adds the terms of a facet to the raw matrix of its cell, which is stored by columns.
    pub fn add_to_matrix(
        &self,
        OpenFacet { facet, side }: &OpenFacet,
        input: CellInput<'_, D>,
        local: LocalLayout<D>,
        matrix: &mut [f64],
    ) {
        self.rule.for_each_point(input.mesh, facet, |at| {
            if side.is_developed {
                self.add_developed(facet, at, input, local, matrix);
            }
            if let Some(entering) = Entering::at(side, facet, at, input) {
                entering.add_to_matrix(at, input, local, matrix);
            }
        });
    }

    fn add_developed(
        &self,
        facet: &Facet,
        at: &FacetPoint<'_, D>,
        input: CellInput<'_, D>,
        local: LocalLayout<D>,
        matrix: &mut [f64],
    ) {
        let size = local.n_local();
        let viscosity = self.viscosity(input, facet, at);
        let traction = viscosity.gradient.transpose() * at.normal_ds;
        for a in 0..at.phi.len() {
            for b in 0..at.phi.len() {
                let stretch = self.metric.hoop_strain(&Point::repeat(at.phi[b]), &at.position);
                for i in 0..D {
                    let weight = viscosity.value * at.phi[a] * at.grad_phi[b][i];
                    for j in 0..D {
                        let entry = &mut matrix[local.velocity(b, j) * size + local.velocity(a, i)];
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
    }

    /// Adds the terms of a facet to the raw residual of its cell.
    pub fn add_to_residual(
        &self,
        OpenFacet { facet, side }: &OpenFacet,
        input: CellInput<'_, D>,
        local: LocalLayout<D>,
        residual: &mut [f64],
    ) {
        self.rule.for_each_point(input.mesh, facet, |at| {
            let mut traction = Point::<D>::zeros();
            if side.is_developed {
                traction += self.developed(facet, at, input);
            }
            if let Some(entering) = Entering::at(side, facet, at, input) {
                traction += entering.velocity * entering.mass;
            }
            for (a, phi) in at.phi.iter().enumerate() {
                for i in 0..D {
                    residual[local.velocity(a, i)] -= traction[i] * phi;
                }
            }
        });
    }

    /// mu (grad u)^T n ds.
    fn developed(
        &self,
        facet: &Facet,
        at: &FacetPoint<'_, D>,
        CellInput { mesh, fields, terms }: CellInput<'_, D>,
    ) -> Point<D> {
        let nodes = mesh.cell(facet.cell);
        let gradient: SMatrix<f64, D, D> =
            nodes.iter().zip(at.grad_phi).fold(SMatrix::zeros(), |sum, (&node, grad)| {
                sum + fields.velocity[node] * grad.transpose()
            });
        let viscosity = self.viscosity(CellInput { mesh, fields, terms }, facet, at);
        let mut traction = gradient.transpose() * at.normal_ds * viscosity.value;
        if viscosity.slope != 0.0 {
            let velocity = at.value(nodes, fields.velocity);
            let hoop = self.metric.hoop_strain(&velocity, &at.position);
            let change = viscosity.change(&gradient, hoop);
            traction += viscosity.gradient.transpose() * at.normal_ds * change;
        }
        traction
    }
}

/// Fluid that enters at a point of a side that takes its momentum.
struct Entering<const D: usize> {
    /// Velocity (m/s).
    velocity: Point<D>,
    /// rho beta min(c . n, 0) ds (kg/s; kg/(m s) planar).
    mass: f64,
    /// rho beta (kg/m3).
    density: f64,
}

impl<const D: usize> Entering<D> {
    /// None where the fluid leaves, or does not convect.
    fn at(
        side: &OpenSide,
        facet: &Facet,
        at: &FacetPoint<'_, D>,
        CellInput { mesh, terms, fields }: CellInput<'_, D>,
    ) -> Option<Self> {
        if side.backflow == 0.0 || terms.convection == Convection::None {
            return None;
        }
        let nodes = mesh.cell(facet.cell);
        let flux = at.value(nodes, terms.convecting_velocity).dot(&at.normal_ds);
        let density = terms.density * side.backflow;
        let velocity = at.value(nodes, fields.velocity);
        (flux < 0.0).then_some(Self { velocity, mass: density * flux, density })
    }

    fn add_to_matrix(
        &self,
        at: &FacetPoint<'_, D>,
        input: CellInput<'_, D>,
        local: LocalLayout<D>,
        matrix: &mut [f64],
    ) {
        let size = local.n_local();
        let convection = input.terms.convection;
        for (a, phi) in at.phi.iter().enumerate() {
            for i in 0..D {
                let row = local.velocity(a, i);
                // By the velocity of what convects, u less that of the frame
                let slope = self.density * self.velocity[i] * phi;
                for (b, other) in at.phi.iter().enumerate() {
                    matrix[local.velocity(b, i) * size + row] -= self.mass * phi * other;
                    if matches!(convection, Convection::Newton | Convection::NewtonInFrame) {
                        for j in 0..D {
                            matrix[local.velocity(b, j) * size + row] -=
                                slope * other * at.normal_ds[j];
                        }
                    }
                }
                if convection == Convection::NewtonInFrame {
                    for j in 0..local.n_frame {
                        matrix[local.frame(j) * size + row] += slope * at.normal_ds[j];
                    }
                }
            }
        }
    }
}
