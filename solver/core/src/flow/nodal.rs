//! Values at the P2 nodes of what is not given there: vorticity and pressure.

use alewife_mesh::{Mesh, Point, Simplex, map_quadratic};

/// Reference coordinates (X, Y) of the six nodes of a triangle.
const NODES: [[f64; 2]; 6] =
    [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]];

/// Vorticity dv/dx - du/dy at the P2 nodes (1/s), positive counter-clockwise.
///
/// Inside a cell the velocity is u(x(X)) = sum_i u_i phi_i(X), so grad u = J^-T grad_X u with
/// J = dx/dX. It jumps from cell to cell; a picture wants one value a node: the mean over the
/// cells around it.
///
/// On the half plane of an axisymmetric flow it is the component along the azimuth that makes a
/// right-handed frame with x and y.
///
/// # Shape
/// `velocity` and the result have one entry a node of `mesh`.
#[must_use]
pub fn nodal_vorticity(mesh: &Mesh<2>, velocity: &[Point<2>]) -> Vec<f64> {
    let mut sum = vec![0.0; mesh.n_nodes()];
    let mut n_cells = vec![0_u32; mesh.n_nodes()];
    for nodes in mesh.cells() {
        let positions: [_; 6] = std::array::from_fn(|i| mesh.nodes[nodes[i]]);
        let velocities: [_; 6] = std::array::from_fn(|i| velocity[nodes[i]]);
        for (&node, place) in nodes.iter().zip(NODES) {
            // Velocity and position are the same kind of field: columns d/dX and d/dY of both.
            let [x_x, x_y] = map_quadratic(&positions, place).columns;
            let [u_x, u_y] = map_quadratic(&velocities, place).columns;
            let det_jacobian = x_x.perp(&x_y);
            let dv_dx = (x_y.y * u_x.y - x_x.y * u_y.y) / det_jacobian;
            let du_dy = (x_x.x * u_y.x - x_y.x * u_x.x) / det_jacobian;
            sum[node] += dv_dx - du_dy;
            n_cells[node] += 1;
        }
    }
    sum.iter().zip(&n_cells).map(|(sum, &n)| sum / f64::from(n.max(1))).collect()
}

/// Pressure (Pa) at the P2 nodes: it is linear in a cell, so that its value on an edge lies between
/// those of the ends.
///
/// # Shape
/// `at_vertices` has one entry a vertex of `mesh`, the result one a node.
#[must_use]
pub fn nodal_pressure<const D: usize>(mesh: &Mesh<D>, at_vertices: &[f64]) -> Vec<f64> {
    let mut pressure = vec![0.0; mesh.n_nodes()];
    pressure[..mesh.n_vertices].copy_from_slice(&at_vertices[..mesh.n_vertices]);
    for edge in mesh.cell_ids().flat_map(|cell| mesh.cell_edges(cell)) {
        let [start, end] = edge.ends.map(|vertex| at_vertices[vertex]);
        for (&node, parameter) in edge.inner.iter().zip(Simplex::<D>::EDGE_PARAMETERS) {
            pressure[node] = (1.0 - parameter) * start + parameter * end;
        }
    }
    pressure
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::sample_mesh::{bent, two_simplices};

    #[test]
    fn vorticity_of_a_quadratic_velocity_is_exact_on_straight_cells() {
        let mesh = two_simplices::<2>();
        let velocity: Vec<_> =
            mesh.nodes.iter().map(|x| Point::<2>::new(-x.y * x.y, x.x * x.y)).collect();
        for (x, vorticity) in mesh.nodes.iter().zip(nodal_vorticity(&mesh, &velocity)) {
            assert!((vorticity - 3.0 * x.y).abs() < 1e-13);
        }
    }

    #[test]
    fn a_rigid_turn_has_twice_its_rate_on_curved_cells_too() {
        // Isoparametric cells carry linear fields exactly.
        let mesh = bent(two_simplices::<2>(), 0.05);
        let velocity: Vec<_> = mesh.nodes.iter().map(|x| Point::<2>::new(-x.y, x.x)).collect();
        for vorticity in nodal_vorticity(&mesh, &velocity) {
            assert!((vorticity - 2.0).abs() < 1e-13);
        }
    }

    fn a_linear_pressure_is_exact<const D: usize>() {
        let mesh = two_simplices::<D>();
        let exact: Vec<f64> = mesh.nodes.iter().map(|x| 1.0 + x[0] - 3.0 * x[D - 1]).collect();
        let nodal = nodal_pressure(&mesh, &exact[..mesh.n_vertices]);
        assert!(nodal.iter().zip(&exact).all(|(p, exact)| (p - exact).abs() < 1e-14));
    }

    #[test]
    fn a_linear_pressure_is_exact_at_every_node() {
        a_linear_pressure_is_exact::<2>();
        a_linear_pressure_is_exact::<3>();
    }
}
