//! Open sides with mu du/dn - p n = 0: what the symmetric stress has too much there.
//!
//! With the stress 2 mu D(u) a free side means sigma n = 0. A developed flow leaves undisturbed
//! when mu (grad u) n - p n = 0 instead, so the part mu (grad u)^T n is taken off again:
//! - int_side mu d_i u_j n_j v_i ds.

use alewife_mesh::{Facet, Mesh, Point, Simplex};
use nalgebra::SMatrix;

use super::cell_terms::LocalLayout;
use crate::space::{CellValues, Metric, Rule, triangle_side_point};

/// Values at one quadrature point of a boundary facet.
#[derive(Debug, Clone)]
pub struct FacetPoint<const D: usize> {
    /// Quadratic basis of the cell.
    pub phi: Vec<f64>,
    /// Its gradients (1/m).
    pub grad_phi: Vec<Point<D>>,
    /// Outward normal of the fluid times the length of the facet's piece (m; m2 revolved).
    pub normal_ds: Point<D>,
    /// Position (m).
    pub position: Point<D>,
    /// Parameter along the side, from 0 to 1.
    pub s: f64,
}

/// Visits the quadrature points of a boundary facet of a planar mesh.
pub fn for_each_facet_point(
    mesh: &Mesh<2>,
    facet: &Facet,
    rule: &Rule<1>,
    metric: Metric,
    mut visit: impl FnMut(&FacetPoint<2>),
) {
    let side = usize::from(facet.side);
    let along = triangle_side_point(side, 1.0) - triangle_side_point(side, 0.0);
    for (point, weight) in rule.points.iter().zip(&rule.weights) {
        let xi = triangle_side_point(side, point[0]);
        let (phi, grad_phi, map, position) = CellValues::at(mesh, facet.cell, &xi);
        let tangent: Point<2> = map * along;
        // Cells run counter-clockwise, so the outward normal is to the right of the side.
        let normal_ds =
            Point::<2>::new(tangent[1], -tangent[0]) * (weight * metric.ring(&position));
        visit(&FacetPoint { phi, grad_phi, normal_ds, position, s: point[0] });
    }
}

/// Adds the term to a cell's raw matrix (column length `size`) or, given velocities, its residual.
pub(super) fn add_open_side(
    mesh: &Mesh<2>,
    facet: &Facet,
    rule: &Rule<1>,
    metric: Metric,
    viscosity: f64,
    matrix: Option<(&mut [f64], usize)>,
    residual: Option<(&mut [f64], &[Point<2>])>,
) {
    const D: usize = 2;
    let local = LocalLayout::<D, { Simplex::<D>::N_NODES }>::velocity;
    let nodes = mesh.cell(facet.cell);
    let mut matrix = matrix;
    let mut residual = residual;
    for_each_facet_point(mesh, facet, rule, metric, |at| {
        if let Some((matrix, size)) = matrix.as_mut() {
            for a in 0..nodes.len() {
                for b in 0..nodes.len() {
                    for i in 0..D {
                        let weight = viscosity * at.phi[a] * at.grad_phi[b][i];
                        for j in 0..D {
                            matrix[local(b, j) * *size + local(a, i)] -= weight * at.normal_ds[j];
                        }
                    }
                }
            }
        }
        if let Some((residual, velocity)) = residual.as_mut() {
            let gradient: SMatrix<f64, D, D> =
                nodes.iter().zip(&at.grad_phi).fold(SMatrix::zeros(), |sum, (&node, grad)| {
                    sum + velocity[node] * grad.transpose()
                });
            let traction = gradient.transpose() * at.normal_ds * viscosity;
            for a in 0..nodes.len() {
                for i in 0..D {
                    residual[local(a, i)] -= traction[i] * at.phi[a];
                }
            }
        }
    });
}
