//! Linear and quadratic Lagrange bases on the reference simplex.
//!
//! With barycentric coordinates l_0 = 1 - sum xi, l_i = xi_i: P1 is l_i; P2 is l_i (2 l_i - 1) at
//! the vertices and 4 l_i l_j at the mid node of edge (i, j), edges in VTK's order.

use alewife_mesh::Simplex;
use nalgebra::SVector;

fn barycentric<const D: usize>(xi: &SVector<f64, D>, vertex: usize) -> f64 {
    if vertex == 0 { 1.0 - xi.sum() } else { xi[vertex - 1] }
}

fn barycentric_gradient<const D: usize>(vertex: usize) -> SVector<f64, D> {
    if vertex == 0 {
        SVector::repeat(-1.0)
    } else {
        let mut gradient = SVector::zeros();
        gradient[vertex - 1] = 1.0;
        gradient
    }
}

/// Values of the D + 1 linear basis functions at reference point `xi`.
#[must_use]
pub fn p1_values<const D: usize>(xi: &SVector<f64, D>) -> Vec<f64> {
    (0..=D).map(|vertex| barycentric(xi, vertex)).collect()
}

/// Gradients of the D + 1 linear basis functions in reference coordinates.
#[must_use]
pub fn p1_gradients<const D: usize>() -> Vec<SVector<f64, D>> {
    (0..=D).map(barycentric_gradient).collect()
}

/// Values of the quadratic basis functions at reference point `xi`: vertices, then mid nodes.
#[must_use]
pub fn p2_values<const D: usize>(xi: &SVector<f64, D>) -> Vec<f64> {
    let at_vertices = (0..=D).map(|i| {
        let l = barycentric(xi, i);
        l * (2.0 * l - 1.0)
    });
    let at_edges =
        Simplex::<D>::EDGES.iter().map(|&[i, j]| 4.0 * barycentric(xi, i) * barycentric(xi, j));
    at_vertices.chain(at_edges).collect()
}

/// Gradients of the quadratic basis functions in reference coordinates at `xi`.
#[must_use]
pub fn p2_gradients<const D: usize>(xi: &SVector<f64, D>) -> Vec<SVector<f64, D>> {
    let at_vertices =
        (0..=D).map(|i| barycentric_gradient::<D>(i) * (4.0 * barycentric(xi, i) - 1.0));
    let at_edges = Simplex::<D>::EDGES.iter().map(|&[i, j]| {
        (barycentric_gradient::<D>(i) * barycentric(xi, j)
            + barycentric_gradient::<D>(j) * barycentric(xi, i))
            * 4.0
    });
    at_vertices.chain(at_edges).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check_lagrange<const D: usize>() {
        let mut nodes: Vec<SVector<f64, D>> =
            (0..=D).map(|i| SVector::from_fn(|axis, _| f64::from(axis + 1 == i))).collect();
        for &[i, j] in Simplex::<D>::EDGES {
            nodes.push((nodes[i] + nodes[j]) / 2.0);
        }
        for (i, node) in nodes.iter().enumerate() {
            for (j, value) in p2_values(node).into_iter().enumerate() {
                assert!((value - f64::from(i == j)).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn each_quadratic_function_is_one_at_its_node_and_zero_at_the_others() {
        check_lagrange::<2>();
        check_lagrange::<3>();
    }

    #[test]
    fn gradients_sum_to_zero_and_match_differences() {
        let xi = SVector::<f64, 3>::new(0.2, 0.3, 0.1);
        let gradients = p2_gradients(&xi);
        assert!(gradients.iter().sum::<SVector<f64, 3>>().norm() < 1e-14);
        let step = 1e-6;
        for k in 0..3 {
            let shift = SVector::<f64, 3>::ith(k, step);
            let (ahead, behind) = (p2_values(&(xi + shift)), p2_values(&(xi - shift)));
            for node in 0..10 {
                let slope = (ahead[node] - behind[node]) / (2.0 * step);
                assert!((slope - gradients[node][k]).abs() < 1e-9);
            }
        }
    }
}
