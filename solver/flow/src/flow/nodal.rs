//! Values at the P2 nodes of what is not given there: vorticity and pressure.

use alewife_mesh::{Mesh, Point, Simplex, map_quadratic};
use nalgebra::{SMatrix, Vector3};

/// Reference coordinates of the nodes of a cell.
fn places<const D: usize>() -> impl Iterator<Item = [f64; D]> {
    let vertex = |vertex: usize| -> [f64; D] {
        std::array::from_fn(|axis| if axis + 1 == vertex { 1.0 } else { 0.0 })
    };
    let middle = move |[from, to]: [usize; 2]| -> [f64; D] {
        std::array::from_fn(|axis| f64::midpoint(vertex(from)[axis], vertex(to)[axis]))
    };
    (0..=D).map(vertex).chain(Simplex::<D>::EDGES.iter().map(move |edge| middle(*edge)))
}

/// Vorticity curl u at the P2 nodes (1/s); in the plane its part about z, dv/dx - du/dy, positive
/// counter-clockwise.
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
pub fn nodal_vorticity<const D: usize>(mesh: &Mesh<D>, velocity: &[Point<D>]) -> Vec<Vector3<f64>> {
    let mut sum = vec![Vector3::zeros(); mesh.n_nodes()];
    let mut n_cells = vec![0_u32; mesh.n_nodes()];
    let (mut positions, mut velocities) = (Vec::new(), Vec::new());
    for nodes in mesh.cells() {
        positions.clear();
        positions.extend(nodes.iter().map(|&node| mesh.nodes[node]));
        velocities.clear();
        velocities.extend(nodes.iter().map(|&node| velocity[node]));
        for (&node, place) in nodes.iter().zip(places::<D>()) {
            // Velocity and position are the same kind of field: columns d/dX of both
            let jacobian = SMatrix::from_columns(&map_quadratic(&positions, place).columns);
            let slopes = SMatrix::from_columns(&map_quadratic(&velocities, place).columns);
            let Some(inverse) = jacobian.try_inverse() else { continue };
            sum[node] += curl(&(slopes * inverse));
            n_cells[node] += 1;
        }
    }
    sum.iter().zip(&n_cells).map(|(sum, &n)| sum / f64::from(n.max(1))).collect()
}

/// Curl of a velocity with this gradient, row i column j du_i / dx_j.
fn curl<const D: usize>(gradient: &SMatrix<f64, D, D>) -> Vector3<f64> {
    let slope =
        |of: usize, along: usize| if of < D && along < D { gradient[(of, along)] } else { 0.0 };
    let about = |axis: usize| {
        let (next, after) = ((axis + 1) % 3, (axis + 2) % 3);
        slope(after, next) - slope(next, after)
    };
    Vector3::new(about(0), about(1), about(2))
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
            assert!((vorticity - Vector3::z() * 3.0 * x.y).norm() < 1e-13);
        }
    }

    fn a_rigid_turn_has_twice_its_rate<const D: usize>(rate: Vector3<f64>) {
        // Isoparametric cells carry linear fields exactly
        let mesh = bent(two_simplices::<D>(), 0.05);
        let turned = |x: &Point<D>| {
            let place = Vector3::from_fn(|axis, _| if axis < D { x[axis] } else { 0.0 });
            let velocity = rate.cross(&place);
            Point::<D>::from_fn(|axis, _| velocity[axis])
        };
        let velocity: Vec<_> = mesh.nodes.iter().map(turned).collect();
        for vorticity in nodal_vorticity(&mesh, &velocity) {
            assert!((vorticity - rate * 2.0).norm() < 1e-12);
        }
    }

    #[test]
    fn a_rigid_turn_has_twice_its_rate_on_curved_cells_too() {
        a_rigid_turn_has_twice_its_rate::<2>(Vector3::z() * 0.7);
        a_rigid_turn_has_twice_its_rate::<3>(Vector3::new(0.3, -1.1, 0.6));
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
