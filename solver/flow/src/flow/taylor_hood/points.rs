//! Batches of quadrature points of a cell, in arrays of fixed size that fill vector registers.
//!
//! Fields are evaluated with one point a lane, sums over test functions made with one node a lane.
//! D is the dimension, N the nodes of a cell; P is N and Q the number of points, both rounded up
//! to whole registers. What is beyond N is zero; points beyond the rule have no weight.

use std::f64::consts::TAU;

use alewife_mesh::{CellId, Mesh, NodeId, Point};
use pulp::Simd;

use super::lanes::{add_product, add_scaled, product, scaled};
use crate::space::{Element, Metric, Rule, adjugate, n_lagrange_nodes, p1_values};

/// Values of the bases at some points of a rule, in reference coordinates.
#[derive(Debug, Clone)]
pub struct PointTable<const D: usize, const N: usize, const P: usize, const Q: usize> {
    /// Weights of the rule.
    weights: [f64; Q],
    /// Basis of the velocity at a point: one node a lane.
    pub phi: [[f64; P]; Q],
    /// Its gradients at a point, by axis.
    pub gradients: [[[f64; P]; D]; Q],
    /// Basis of the velocity of a node: one point a lane.
    pub phi_of_node: [[f64; Q]; N],
    /// Its gradients, by axis.
    pub gradients_of_node: [[[f64; Q]; D]; N],
    /// Basis of the pressure of a node, of which there are `N_PRESSURES`: one point a lane.
    pub psi_of_node: [[f64; Q]; N],
    /// Barycentric coordinate of a vertex, of which there are D + 1: one point a lane.
    barycentric: [[f64; Q]; N],
}

impl<const D: usize, const N: usize, const P: usize, const Q: usize> PointTable<D, N, P, Q> {
    /// Pressure nodes of a cell.
    pub const N_PRESSURES: usize = {
        let mut degree = 1;
        while n_lagrange_nodes(D, degree) < N {
            degree += 1;
        }
        assert!(n_lagrange_nodes(D, degree) == N, "no degree has this number of nodes");
        n_lagrange_nodes(D, degree - 1)
    };

    /// The table of all points of a rule, at most Q.
    pub fn of_all(element: &Element<D>, rule: &Rule<D>) -> Self {
        assert!(rule.points.len() <= Q, "the rule does not fit its table");
        Self::new(element, &rule.points, &rule.weights)
    }

    /// Tables of all points of a rule, Q of them in each.
    pub fn batches(element: &Element<D>, rule: &Rule<D>) -> Vec<Self> {
        let points = rule.points.chunks(Q);
        points.zip(rule.weights.chunks(Q)).map(|(at, w)| Self::new(element, at, w)).collect()
    }

    /// The table of at most Q points.
    fn new(element: &Element<D>, points: &[Point<D>], weights: &[f64]) -> Self {
        let mut table = Self {
            weights: [0.0; Q],
            phi: [[0.0; P]; Q],
            gradients: [[[0.0; P]; D]; Q],
            phi_of_node: [[0.0; Q]; N],
            gradients_of_node: [[[0.0; Q]; D]; N],
            psi_of_node: [[0.0; Q]; N],
            barycentric: [[0.0; Q]; N],
        };
        table.weights[..weights.len()].copy_from_slice(weights);
        for q in 0..Q {
            let point = points.get(q).unwrap_or(&points[0]);
            let (phi, gradients) = ((element.phi)(point), (element.grad_phi)(point));
            for node in 0..N {
                table.phi[q][node] = phi[node];
                table.phi_of_node[node][q] = phi[node];
                for axis in 0..D {
                    table.gradients[q][axis][node] = gradients[node][axis];
                    table.gradients_of_node[node][axis][q] = gradients[node][axis];
                }
            }
            let psi = (element.psi)(point);
            for node in 0..Self::N_PRESSURES {
                table.psi_of_node[node][q] = psi[node];
            }
            for (vertex, coordinate) in p1_values(point).into_iter().enumerate() {
                table.barycentric[vertex][q] = coordinate;
            }
        }
        table
    }

    /// A field with the basis of the velocity at the points, from its values at the nodes.
    #[inline(always)]
    pub fn velocity<S: Simd>(&self, nodal: &[f64; N]) -> [f64; Q] {
        let mut field = [0.0; Q];
        for node in 0..N {
            add_product::<S, Q>(&mut field, &self.phi_of_node[node], nodal[node]);
        }
        field
    }

    /// A field with the basis of the pressure at the points, from its values at the nodes, the first
    /// `N_PRESSURES` of `nodal`.
    #[inline(always)]
    pub fn pressure<S: Simd>(&self, nodal: &[f64; N]) -> [f64; Q] {
        let mut field = [0.0; Q];
        for node in 0..Self::N_PRESSURES {
            add_product::<S, Q>(&mut field, &self.psi_of_node[node], nodal[node]);
        }
        field
    }

    /// A linear field at the points, from its values at the vertices, the first D + 1 of `nodal`.
    #[inline(always)]
    fn linear<S: Simd>(&self, nodal: &[f64; N]) -> [f64; Q] {
        let mut field = [0.0; Q];
        for vertex in 0..=D {
            add_product::<S, Q>(&mut field, &self.barycentric[vertex], nodal[vertex]);
        }
        field
    }

    /// Derivative along a reference axis of a field with the basis of the velocity, at the points.
    #[inline(always)]
    pub fn derivative<S: Simd>(&self, nodal: &[f64; N], axis: usize) -> [f64; Q] {
        let mut field = [0.0; Q];
        for node in 0..N {
            add_product::<S, Q>(&mut field, &self.gradients_of_node[node][axis], nodal[node]);
        }
        field
    }
}

/// Where the quadrature points of one cell are, and how its coordinates change there.
pub struct CellPoints<const D: usize, const Q: usize> {
    /// Weights mapped to the cell (m^D; m^3 in axisymmetric problems).
    pub dx: [f64; Q],
    /// Positions (m), by axis.
    pub position: [[f64; Q]; D],
    /// inverse\[k\]\[i\] = dX_k / dx_i (1/m).
    pub inverse: [[[f64; Q]; D]; D],
}

impl<const D: usize, const Q: usize> CellPoints<D, Q> {
    /// The points of a cell whose nodes are at `corners` (by axis); `curved` as in the mesh.
    #[inline(always)]
    pub fn new<S: Simd, const N: usize, const P: usize>(
        table: &PointTable<D, N, P, Q>,
        corners: &[[f64; N]; D],
        curved: bool,
        metric: Metric,
    ) -> Self {
        // Loops, for `map` and `from_fn` of arrays need not be inlined, and so lose the dispatch.
        let mut position = [[0.0; Q]; D];
        let mut inverse = [[[0.0; Q]; D]; D];
        let mut determinant = [0.0; Q];
        if curved {
            let mut jacobian = [[[0.0; Q]; D]; D];
            for i in 0..D {
                for k in 0..D {
                    jacobian[i][k] = table.derivative::<S>(&corners[i], k);
                }
            }
            invert(&jacobian, &mut inverse, &mut determinant);
            for axis in 0..D {
                position[axis] = table.velocity::<S>(&corners[axis]);
            }
        } else {
            let mut jacobian = [[[0.0; 1]; D]; D];
            for i in 0..D {
                for k in 0..D {
                    jacobian[i][k][0] = corners[i][k + 1] - corners[i][0];
                }
            }
            let mut one_inverse = [[[0.0; 1]; D]; D];
            let mut one_determinant = [0.0; 1];
            invert(&jacobian, &mut one_inverse, &mut one_determinant);
            for k in 0..D {
                for i in 0..D {
                    inverse[k][i] = [one_inverse[k][i][0]; Q];
                }
                position[k] = table.linear::<S>(&corners[k]);
            }
            determinant = [one_determinant[0]; Q];
        }
        let mut dx = product(&table.weights, &determinant);
        if metric.is_revolved() {
            dx = product(&dx, &scaled(&position[Metric::RADIAL], TAU));
        }
        Self { dx, position, inverse }
    }

    /// Physical gradients of the basis of the velocity: by point, axis, node.
    #[inline(always)]
    pub fn gradients<S: Simd, const N: usize, const P: usize>(
        &self,
        table: &PointTable<D, N, P, Q>,
    ) -> [[[f64; P]; D]; Q] {
        let mut gradients = [[[0.0; P]; D]; Q];
        for q in 0..Q {
            for i in 0..D {
                for k in 0..D {
                    let change = self.inverse[k][i][q];
                    add_product::<S, P>(&mut gradients[q][i], &table.gradients[q][k], change);
                }
            }
        }
        gradients
    }

    /// Physical gradient of a field with the basis of the velocity at the points, by axis.
    #[inline(always)]
    pub fn gradient<S: Simd, const N: usize, const P: usize>(
        &self,
        table: &PointTable<D, N, P, Q>,
        nodal: &[f64; N],
    ) -> [[f64; Q]; D] {
        let mut gradient = [[0.0; Q]; D];
        for k in 0..D {
            let along = table.derivative::<S>(nodal, k);
            for i in 0..D {
                add_scaled::<S, Q>(&mut gradient[i], &along, &self.inverse[k][i]);
            }
        }
        gradient
    }
}

/// Inverses and determinants of L matrices \[row\]\[column\]\[lane\].
#[inline(always)]
fn invert<const D: usize, const L: usize>(
    matrix: &[[[f64; L]; D]; D],
    inverse: &mut [[[f64; L]; D]; D],
    determinant: &mut [f64; L],
) {
    adjugate(matrix, inverse, determinant);
    for lane in 0..L {
        let factor = 1.0 / determinant[lane];
        for i in 0..D {
            for j in 0..D {
                inverse[i][j][lane] *= factor;
            }
        }
    }
}

/// A vector field at the nodes of a cell, by axis.
#[inline(always)]
pub fn gather<const D: usize, const N: usize>(
    values: &[Point<D>],
    nodes: &[NodeId; N],
) -> [[f64; N]; D] {
    let mut gathered = [[0.0; N]; D];
    for (a, &node) in nodes.iter().enumerate() {
        let value = &values[node];
        for axis in 0..D {
            gathered[axis][a] = value[axis];
        }
    }
    gathered
}

/// The nodes of a cell.
#[inline(always)]
pub fn nodes_of<const D: usize, const N: usize>(mesh: &Mesh<D>, cell: CellId) -> &[NodeId; N] {
    mesh.cell(cell).first_chunk().expect("a cell has as many nodes as its element")
}
