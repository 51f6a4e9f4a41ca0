//! Norms of the difference between a solution and an exact one.

use alewife_core::coupling::Solution;
use alewife_core::space::{CellValues, Metric, Tables};
use alewife_mesh::{Mesh, Point};
use nalgebra::SMatrix;

use crate::exact::Exact;

/// Errors of one solution.
#[derive(Debug, Clone, Copy)]
pub struct Errors {
    /// L2 norm of the velocity error.
    pub velocity: f64,
    /// L2 norm of the error of the velocity gradient.
    pub gradient: f64,
    /// L2 norm of the pressure error, without its mean.
    pub pressure: f64,
}

/// Errors of a solution at a time.
#[must_use]
pub fn errors<const D: usize>(
    mesh: &Mesh<D>,
    solution: &Solution<D>,
    exact: &dyn Exact<D>,
    time: f64,
    metric: Metric,
) -> Errors {
    let tables = Tables::new(metric);
    let mut workspace = CellValues::default();
    let (mut velocity_sum, mut gradient_sum) = (0.0, 0.0);
    let (mut volume, mut shift, mut square) = (0.0, 0.0, 0.0);
    for cell in mesh.cell_ids() {
        let nodes = mesh.cell(cell);
        workspace.for_each_point(&tables, mesh, cell, |at| {
            let mut velocity = Point::<D>::zeros();
            let mut gradient = SMatrix::<f64, D, D>::zeros();
            for (a, &node) in nodes.iter().enumerate() {
                velocity += solution.velocity[node] * at.phi[a];
                gradient += solution.velocity[node] * at.grad_phi[a].transpose();
            }
            let pressure: f64 =
                nodes.iter().zip(at.psi).map(|(&node, psi)| solution.pressure[node] * psi).sum();
            let place = at.position;
            velocity_sum += (velocity - exact.velocity(&place, time)).norm_squared() * at.dx;
            let mut expected = SMatrix::<f64, D, D>::zeros();
            // Central differences are exact to 1e-9 here, far below the errors measured.
            let step = 1e-5;
            for axis in 0..D {
                let mut shift = Point::<D>::zeros();
                shift[axis] = step;
                let ahead = exact.velocity(&(place + shift), time);
                let behind = exact.velocity(&(place - shift), time);
                expected.set_column(axis, &((ahead - behind) / (2.0 * step)));
            }
            gradient_sum += (gradient - expected).norm_squared() * at.dx;
            let difference = pressure - exact.pressure(&place, time);
            volume += at.dx;
            shift += difference * at.dx;
            square += difference * difference * at.dx;
        });
    }
    Errors {
        velocity: velocity_sum.sqrt(),
        gradient: gradient_sum.sqrt(),
        pressure: (square - shift * shift / volume).max(0.0).sqrt(),
    }
}
