//! The load of the fluid on a boundary by integrating its stress: a cross-check of lower order.

use alewife_mesh::{Mesh, Point};
use nalgebra::{SMatrix, Vector3};

use crate::body::Wrench;
use crate::flow::{Fields, for_each_facet_point};
use crate::space::{interval_rule, p1_values, triangle_side_point};

/// Force and torque about `center` of the fluid on a boundary:
/// F = - int sigma n ds with n out of the fluid.
#[must_use]
pub fn surface_load(
    mesh: &Mesh<2>,
    boundary: usize,
    fields: &Fields<'_, 2>,
    viscosity: f64,
    axisymmetric: bool,
    center: Point<2>,
) -> Wrench {
    let rule = interval_rule(4);
    let mut load = Wrench::default();
    for facet in mesh.facets.iter().filter(|facet| usize::from(facet.boundary) == boundary) {
        let nodes = mesh.cell(facet.cell as usize);
        for_each_facet_point(mesh, facet, &rule, axisymmetric, |at| {
            let gradient: SMatrix<f64, 2, 2> =
                nodes.iter().zip(&at.grad_phi).fold(SMatrix::zeros(), |sum, (&node, grad)| {
                    sum + fields.velocity[node as usize] * grad.transpose()
                });
            let psi = p1_values(&triangle_side_point(usize::from(facet.side), at.s));
            let pressure: f64 =
                nodes.iter().zip(&psi).map(|(&node, psi)| fields.pressure[node as usize] * psi).sum();
            let traction = (gradient + gradient.transpose()) * at.normal_ds * viscosity
                - at.normal_ds * pressure;
            let lever = at.position - center;
            // Turned about the axis, radial forces cancel and in-plane torques vanish.
            if axisymmetric {
                load.force.x -= traction[0];
            } else {
                load.force -= Vector3::new(traction[0], traction[1], 0.0);
                load.torque.z -= lever[0] * traction[1] - lever[1] * traction[0];
            }
        });
    }
    load
}
