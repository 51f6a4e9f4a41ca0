//! Vorticity dv/dx - du/dy at the P2 nodes: the mean over the cells around each node.
//!
//! Inside a cell the velocity is u(x(X)) = sum_i u_i phi_i(X), so grad u = J^-T grad_X u with
//! J = dx/dX. It jumps from cell to cell; a picture wants one value a node.

use alewife_mesh::{Mesh, Point};

/// Reference coordinates (X, Y) of the six nodes of a triangle.
const NODES: [[f64; 2]; 6] =
    [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]];

/// Vorticity at the P2 nodes (1/s), positive counter-clockwise.
///
/// On the half plane of an axisymmetric flow it is the component along the azimuth that makes a
/// right-handed frame with x and y.
///
/// # Shape
/// `velocity` and the result have one entry a node of `mesh`.
pub fn nodal_vorticity(mesh: &Mesh<2>, velocity: &[Point<2>]) -> Vec<f64> {
    let mut sum = vec![0.0; mesh.n_nodes()];
    let mut n_cells = vec![0_u32; mesh.n_nodes()];
    for cell in 0..mesh.n_cells() {
        let nodes = mesh.cell(cell);
        for (place, &node) in NODES.iter().zip(nodes) {
            let gradients = reference_gradients(*place);
            // Rows of `position` and `speed`: derivatives along X and Y.
            let (mut position, mut speed) = ([[0.0; 2]; 2], [[0.0; 2]; 2]);
            for (gradient, &other) in gradients.iter().zip(nodes) {
                let (x, u) = (&mesh.nodes[other as usize], &velocity[other as usize]);
                for along in 0..2 {
                    for component in 0..2 {
                        position[along][component] += gradient[along] * x[component];
                        speed[along][component] += gradient[along] * u[component];
                    }
                }
            }
            let [[x_x, y_x], [x_y, y_y]] = position;
            let [[u_x, v_x], [u_y, v_y]] = speed;
            let det_jacobian = x_x * y_y - x_y * y_x;
            let dv_dx = (y_y * v_x - y_x * v_y) / det_jacobian;
            let du_dy = (x_x * u_y - x_y * u_x) / det_jacobian;
            sum[node as usize] += dv_dx - du_dy;
            n_cells[node as usize] += 1;
        }
    }
    sum.iter().zip(&n_cells).map(|(sum, &n)| sum / f64::from(n.max(1))).collect()
}

/// Gradients of the six quadratic shape functions at a reference place.
///
/// With l_0 = 1 - X - Y, l_1 = X, l_2 = Y: l_i (2 l_i - 1) at vertex i, 4 l_i l_j between i and j.
fn reference_gradients([x, y]: [f64; 2]) -> [[f64; 2]; 6] {
    let l = [1.0 - x - y, x, y];
    let grad_l = [[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]];
    let vertex = |i: usize| grad_l[i].map(|g: f64| (4.0 * l[i] - 1.0) * g);
    let middle = |i: usize, j: usize| {
        [0, 1].map(|along| 4.0 * (l[i] * grad_l[j][along] + l[j] * grad_l[i][along]))
    };
    [vertex(0), vertex(1), vertex(2), middle(0, 1), middle(1, 2), middle(2, 0)]
}

#[cfg(test)]
mod tests {
    use super::super::tests::two_triangles;
    use super::*;

    #[test]
    fn vorticity_of_a_quadratic_velocity_is_exact_on_straight_cells() {
        let mesh = two_triangles();
        let velocity: Vec<_> =
            mesh.nodes.iter().map(|x| Point::<2>::new(-x.y * x.y, x.x * x.y)).collect();
        for (x, vorticity) in mesh.nodes.iter().zip(nodal_vorticity(&mesh, &velocity)) {
            assert!((vorticity - 3.0 * x.y).abs() < 1e-13);
        }
    }

    #[test]
    fn a_rigid_turn_has_twice_its_rate_on_curved_cells_too() {
        let mut mesh = two_triangles();
        // The bottom bulges: isoparametric cells still carry linear fields exactly.
        mesh.nodes[4] = Point::<2>::new(0.5, -0.1);
        mesh.curved[0] = true;
        let velocity: Vec<_> = mesh.nodes.iter().map(|x| Point::<2>::new(-x.y, x.x)).collect();
        for vorticity in nodal_vorticity(&mesh, &velocity) {
            assert!((vorticity - 2.0).abs() < 1e-13);
        }
    }
}
