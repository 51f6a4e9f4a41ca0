//! The load of the fluid on a boundary by integrating its stress: a cross-check of lower order.

use alewife_mesh::{Mesh, Point};
use nalgebra::SMatrix;

use crate::body::Wrench;
use crate::flow::{Fields, for_each_facet_point};
use crate::space::{Metric, interval_rule, p1_values, triangle_side_point};

/// A boundary whose stress is integrated.
#[derive(Debug, Clone, Copy)]
pub(super) struct Surface<'a> {
    pub mesh: &'a Mesh<2>,
    pub boundary: usize,
    pub viscosity: f64,
    pub metric: Metric,
}

impl Surface<'_> {
    /// Visits the quadrature points of the boundary: place (m), - sigma n ds with n out of the fluid,
    /// the force on the body (N), and velocity of the fluid (m/s).
    pub fn for_each_force(
        &self,
        fields: &Fields<'_, 2>,
        mut visit: impl FnMut(&Point<2>, &Point<2>, &Point<2>),
    ) {
        let rule = interval_rule(4);
        let mesh = self.mesh;
        for facet in mesh.facets.iter().filter(|facet| facet.boundary.index() == self.boundary) {
            let nodes = mesh.cell(facet.cell);
            for_each_facet_point(mesh, facet, &rule, self.metric, |at| {
                let mut velocity = Point::<2>::zeros();
                let mut gradient = SMatrix::<f64, 2, 2>::zeros();
                for (a, &node) in nodes.iter().enumerate() {
                    let nodal = fields.velocity[node];
                    velocity += nodal * at.phi[a];
                    gradient += nodal * at.grad_phi[a].transpose();
                }
                let psi = p1_values(&triangle_side_point(usize::from(facet.side), at.s));
                let pressure: f64 =
                    nodes.iter().zip(&psi).map(|(&node, psi)| fields.pressure[node] * psi).sum();
                let traction = (gradient + gradient.transpose()) * at.normal_ds * self.viscosity
                    - at.normal_ds * pressure;
                visit(&at.position, &-traction, &velocity);
            });
        }
    }
}

/// Force and torque about `center` of the fluid on a boundary:
/// F = - int sigma n ds with n out of the fluid.
#[must_use]
pub fn surface_load(
    mesh: &Mesh<2>,
    boundary: usize,
    fields: &Fields<'_, 2>,
    viscosity: f64,
    metric: Metric,
    center: Point<2>,
) -> Wrench {
    let mut load = Wrench::default();
    let surface = Surface { mesh, boundary, viscosity, metric };
    surface.for_each_force(fields, |place, force, _| {
        let lever = place - center;
        load.force += metric.total_force(force);
        load.torque += metric.total_torque(&lever, force);
    });
    load
}
