//! The terms of a cell in plain loops over points and nodes, as the test of the kernels.

use std::ops::Range;

use alewife_mesh::{CellId, Point};
use nalgebra::SMatrix;

use crate::flow::kernel::{CellInput, CellKernel, LocalLayout};
use crate::flow::local_viscosity::{BasisAt, PointViscosity};
use crate::flow::terms::Convection;
use crate::space::{CellValues, DofLayout, Metric, PointValues, Tables};

/// A kernel that is its equations, and slow.
#[derive(Debug)]
pub struct PlainKernel<const D: usize> {
    pub tables: Tables<D>,
    pub local: LocalLayout<D>,
}

/// The fields of a system at a point.
struct FieldsAt<const D: usize> {
    velocity: Point<D>,
    /// gradient\[(i, j)\] = d_j u_i.
    gradient: SMatrix<f64, D, D>,
    pressure: f64,
    history: Point<D>,
    convecting_velocity: Point<D>,
}

impl<const D: usize> FieldsAt<D> {
    fn new(input: CellInput<'_, D>, cell: CellId, at: &PointValues<'_, D>) -> Self {
        let CellInput { mesh, terms, fields } = input;
        let sum = |values: &[Point<D>]| {
            let nodes = mesh.cell(cell).iter().zip(at.phi);
            nodes.fold(Point::zeros(), |sum: Point<D>, (&node, phi)| {
                sum + values.get(node.index()).map_or(Point::zeros(), |value| value * *phi)
            })
        };
        let nodes = mesh.cell(cell).iter().zip(at.grad_phi);
        let gradient = nodes.fold(SMatrix::zeros(), |sum: SMatrix<f64, D, D>, (&node, grad)| {
            sum + fields.velocity[node] * grad.transpose()
        });
        let nodes = DofLayout::pressure_nodes(mesh, cell).iter().zip(at.psi);
        Self {
            velocity: sum(fields.velocity),
            gradient,
            pressure: nodes.map(|(&node, psi)| fields.pressure[node] * psi).sum(),
            history: sum(terms.history),
            convecting_velocity: sum(terms.convecting_velocity),
        }
    }
}

impl<const D: usize> PlainKernel<D> {
    /// 1 / r in the equations of component `axis`, where they have it.
    fn hoop(&self, axis: usize, at: &PointValues<'_, D>) -> f64 {
        let has_hoop = self.tables.metric().is_revolved() && axis == Metric::RADIAL;
        if has_hoop { 1.0 / at.position[axis] } else { 0.0 }
    }

    fn viscosity(
        &self,
        input: CellInput<'_, D>,
        cell: CellId,
        at: &PointValues<'_, D>,
    ) -> PointViscosity<D> {
        input.terms.viscosity.at(BasisAt {
            metric: self.tables.metric(),
            nodes: input.mesh.cell(cell),
            phi: at.phi,
            grad_phi: at.grad_phi,
            position: &at.position,
        })
    }

    fn add_matrix(
        &self,
        input: CellInput<'_, D>,
        cell: CellId,
        at: &PointValues<'_, D>,
        matrix: &mut [f64],
    ) {
        let (terms, local) = (input.terms, self.local);
        let fields = FieldsAt::new(input, cell, at);
        let viscosity = self.viscosity(input, cell, at);
        let mut add = |row: usize, column: usize, value: f64| {
            matrix[column * local.n_local() + row] += value * at.dx;
        };
        let in_frame = terms.convection == Convection::NewtonInFrame;
        let is_newton = in_frame || terms.convection == Convection::Newton;
        for a in 0..at.phi.len() {
            for i in 0..D {
                let row = local.velocity(a, i);
                for b in 0..at.phi.len() {
                    let (phi, grad) = (at.phi[a] * at.phi[b], [at.grad_phi[a], at.grad_phi[b]]);
                    let mut shared = terms.density * terms.rate * phi;
                    if terms.convection != Convection::None {
                        let carried = fields.convecting_velocity.dot(&grad[1]);
                        shared += terms.density * carried * at.phi[a];
                    }
                    shared += viscosity.value * grad[0].dot(&grad[1]);
                    add(row, local.velocity(b, i), shared);
                    let hoop = self.hoop(i, at).powi(2);
                    add(row, local.velocity(b, i), 2.0 * viscosity.value * phi * hoop);
                    for j in 0..D {
                        let mut coupled = viscosity.value * grad[0][j] * grad[1][i];
                        let [tested, tried] = [(a, i), (b, j)].map(|(node, axis)| {
                            let stretch = at.phi[node] * self.hoop(axis, at);
                            viscosity.product(axis, &at.grad_phi[node], stretch)
                        });
                        coupled += viscosity.slope * tested * tried;
                        if is_newton {
                            coupled += terms.density * phi * fields.gradient[(i, j)];
                        }
                        add(row, local.velocity(b, j), coupled);
                    }
                }
                for (v, psi) in at.psi.iter().enumerate() {
                    let divergence = at.grad_phi[a][i] + at.phi[a] * self.hoop(i, at);
                    add(row, local.pressure(v), -psi * divergence);
                    add(local.pressure(v), row, -psi * divergence);
                }
                for j in 0..if in_frame { local.n_frame } else { 0 } {
                    let reaction = terms.density * at.phi[a] * fields.gradient[(i, j)];
                    add(row, local.frame(j), -reaction);
                }
            }
        }
    }

    fn add_residual(
        &self,
        input: CellInput<'_, D>,
        cell: CellId,
        at: &PointValues<'_, D>,
        residual: &mut [f64],
    ) {
        let (terms, local) = (input.terms, self.local);
        let fields = FieldsAt::new(input, cell, at);
        let change = fields.velocity * terms.rate
            + fields.history
            + fields.gradient * fields.convecting_velocity;
        let force = change * terms.density;
        let rate = fields.gradient + fields.gradient.transpose();
        let viscosity = self.viscosity(input, cell, at);
        let hoop = self.tables.metric().hoop_strain(&fields.velocity, &at.position);
        let change = viscosity.change(&fields.gradient, hoop);
        let stress = rate * viscosity.value + viscosity.strain * change
            - SMatrix::identity() * fields.pressure;
        let mut divergence = fields.gradient.trace();
        for i in 0..D {
            let hoop_strain = fields.velocity[i] * self.hoop(i, at);
            let hoop_stress =
                2.0 * (viscosity.value * hoop_strain + change * viscosity.hoop) - fields.pressure;
            divergence += hoop_strain;
            for a in 0..at.phi.len() {
                let tested = force[i] * at.phi[a]
                    + (stress * at.grad_phi[a])[i]
                    + hoop_stress * at.phi[a] * self.hoop(i, at);
                residual[local.velocity(a, i)] += tested * at.dx;
            }
        }
        for (v, psi) in at.psi.iter().enumerate() {
            residual[local.pressure(v)] -= psi * divergence * at.dx;
        }
    }
}

impl<const D: usize> CellKernel<D> for PlainKernel<D> {
    fn layout(&self) -> LocalLayout<D> {
        self.local
    }

    fn matrices(
        &self,
        input: CellInput<'_, D>,
        cells: Range<usize>,
        stride: usize,
        matrices: &mut [f64],
    ) {
        matrices.fill(0.0);
        for (cell, matrix) in cells.map(CellId::new).zip(matrices.chunks_exact_mut(stride)) {
            CellValues::default().for_each_point(&self.tables, input.mesh, cell, |at| {
                self.add_matrix(input, cell, at, matrix);
            });
        }
    }

    fn residuals(&self, input: CellInput<'_, D>, cells: Range<usize>, residuals: &mut [f64]) {
        residuals.fill(0.0);
        let size = self.local.n_fluid();
        for (cell, residual) in cells.map(CellId::new).zip(residuals.chunks_exact_mut(size)) {
            CellValues::default().for_each_point(&self.tables, input.mesh, cell, |at| {
                self.add_residual(input, cell, at, residual);
            });
        }
    }
}
