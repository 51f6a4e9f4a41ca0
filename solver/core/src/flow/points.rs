//! All quadrature points of a cell at once, in arrays of fixed size that fill vector registers.
//!
//! Fields are evaluated with one point a lane, sums over test functions made with one node a lane.
//! D is the dimension, N the nodes of a cell; P is N and Q the number of points, both rounded up
//! to whole registers. What is beyond N is zero; points beyond the rule have no weight.

use std::f64::consts::TAU;

use alewife_mesh::{CellId, Mesh, NodeId, Point};
use pulp::Simd;

use crate::space::{Metric, Rule, p1_values, p2_gradients, p2_values};

/// x y + z, fused where that is one instruction.
#[inline(always)]
pub(super) fn multiply_add<S: Simd>(x: f64, y: f64, z: f64) -> f64 {
    if S::IS_SCALAR { x * y + z } else { x.mul_add(y, z) }
}

/// sum += x y, lane by lane.
#[inline(always)]
pub(super) fn add_product<S: Simd, const L: usize>(sum: &mut [f64; L], x: &[f64; L], y: f64) {
    for lane in 0..L {
        sum[lane] = multiply_add::<S>(x[lane], y, sum[lane]);
    }
}

/// sum += x y z, lane by lane.
#[inline(always)]
pub(super) fn add_scaled<S: Simd, const L: usize>(sum: &mut [f64; L], x: &[f64; L], y: &[f64; L]) {
    for lane in 0..L {
        sum[lane] = multiply_add::<S>(x[lane], y[lane], sum[lane]);
    }
}

/// x y, lane by lane.
#[inline(always)]
pub(super) fn product<const L: usize>(x: &[f64; L], y: &[f64; L]) -> [f64; L] {
    let mut result = [0.0; L];
    for lane in 0..L {
        result[lane] = x[lane] * y[lane];
    }
    result
}

/// x y, lane by lane.
#[inline(always)]
pub(super) fn scaled<const L: usize>(x: &[f64; L], y: f64) -> [f64; L] {
    let mut result = [0.0; L];
    for lane in 0..L {
        result[lane] = x[lane] * y;
    }
    result
}

/// Values of the bases at the points of a rule, in reference coordinates.
#[derive(Debug, Clone)]
pub(super) struct PointTable<const D: usize, const N: usize, const P: usize, const Q: usize> {
    /// Weights of the rule.
    weights: [f64; Q],
    /// Quadratic basis at a point: one node a lane.
    pub phi: [[f64; P]; Q],
    /// Its gradients at a point, by axis.
    pub gradients: [[[f64; P]; D]; Q],
    /// Quadratic basis of a node: one point a lane.
    pub phi_of_node: [[f64; Q]; N],
    /// Its gradients, by axis.
    pub gradients_of_node: [[[f64; Q]; D]; N],
    /// Linear basis of a vertex, of which there are D + 1: one point a lane.
    pub psi_of_vertex: [[f64; Q]; N],
}

impl<const D: usize, const N: usize, const P: usize, const Q: usize> PointTable<D, N, P, Q> {
    /// The table of a rule with at most Q points.
    pub fn new(rule: &Rule<D>) -> Self {
        assert!(rule.points.len() <= Q && N <= P, "the rule does not fit its table");
        let mut table = Self {
            weights: [0.0; Q],
            phi: [[0.0; P]; Q],
            gradients: [[[0.0; P]; D]; Q],
            phi_of_node: [[0.0; Q]; N],
            gradients_of_node: [[[0.0; Q]; D]; N],
            psi_of_vertex: [[0.0; Q]; N],
        };
        table.weights[..rule.weights.len()].copy_from_slice(&rule.weights);
        for q in 0..Q {
            let point = rule.points.get(q).unwrap_or(&rule.points[0]);
            let (phi, gradients) = (p2_values(point), p2_gradients(point));
            for node in 0..N {
                table.phi[q][node] = phi[node];
                table.phi_of_node[node][q] = phi[node];
                for axis in 0..D {
                    table.gradients[q][axis][node] = gradients[node][axis];
                    table.gradients_of_node[node][axis][q] = gradients[node][axis];
                }
            }
            for (vertex, psi) in p1_values(point).into_iter().enumerate() {
                table.psi_of_vertex[vertex][q] = psi;
            }
        }
        table
    }

    /// A quadratic field at the points, from its values at the nodes.
    #[inline(always)]
    pub fn quadratic<S: Simd>(&self, nodal: &[f64; N]) -> [f64; Q] {
        let mut field = [0.0; Q];
        for node in 0..N {
            add_product::<S, Q>(&mut field, &self.phi_of_node[node], nodal[node]);
        }
        field
    }

    /// A linear field at the points, from its values at the vertices, the first D + 1 of `nodal`.
    #[inline(always)]
    pub fn linear<S: Simd>(&self, nodal: &[f64; N]) -> [f64; Q] {
        let mut field = [0.0; Q];
        for vertex in 0..=D {
            add_product::<S, Q>(&mut field, &self.psi_of_vertex[vertex], nodal[vertex]);
        }
        field
    }

    /// Derivative along a reference axis of a quadratic field at the points.
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
pub(super) struct CellPoints<const D: usize, const Q: usize> {
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
                position[axis] = table.quadratic::<S>(&corners[axis]);
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

    /// Physical gradients of the quadratic basis: by point, axis, node.
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

    /// Physical gradient of a quadratic field at the points, by axis.
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

/// Inverses and determinants of L matrices \[row\]\[column\]\[lane\] of size 2 or 3.
#[inline(always)]
fn invert<const D: usize, const L: usize>(
    matrix: &[[[f64; L]; D]; D],
    inverse: &mut [[[f64; L]; D]; D],
    determinant: &mut [f64; L],
) {
    for lane in 0..L {
        for i in 0..D {
            for j in 0..D {
                let (i1, i2, j1, j2) = ((i + 1) % D, (i + 2) % D, (j + 1) % D, (j + 2) % D);
                inverse[j][i][lane] = if D == 2 {
                    let sign = if i == j { 1.0 } else { -1.0 };
                    sign * matrix[i1][j1][lane]
                } else {
                    matrix[i1][j1][lane] * matrix[i2][j2][lane]
                        - matrix[i1][j2][lane] * matrix[i2][j1][lane]
                };
            }
        }
        determinant[lane] = 0.0;
        for j in 0..D {
            determinant[lane] += matrix[0][j][lane] * inverse[j][0][lane];
        }
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
pub(super) fn gather<const D: usize, const N: usize>(
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
pub(super) fn nodes_of<const D: usize, const N: usize>(
    mesh: &Mesh<D>,
    cell: CellId,
) -> &[NodeId; N] {
    mesh.cell(cell).first_chunk().expect("a cell has as many nodes as its element")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_inverse_is_the_inverse() {
        fn check<const D: usize>(matrix: [[f64; D]; D], determinant: f64) {
            let lanes = matrix.map(|row| row.map(|entry| [entry, 2.0 * entry]));
            let (mut inverse, mut found) = ([[[0.0; 2]; D]; D], [0.0; 2]);
            invert(&lanes, &mut inverse, &mut found);
            for lane in 0..2 {
                let factor = (lane + 1) as f64;
                let expected = determinant * factor.powi(D as i32);
                assert!((found[lane] - expected).abs() < 1e-13 * expected);
                for i in 0..D {
                    for j in 0..D {
                        let sum: f64 =
                            (0..D).map(|k| matrix[i][k] * factor * inverse[k][j][lane]).sum();
                        assert!((sum - f64::from(i == j)).abs() < 1e-14);
                    }
                }
            }
        }
        check([[2.0, 1.0], [-0.5, 3.0]], 6.5);
        check([[2.0, 1.0, 0.3], [-0.5, 3.0, 0.2], [0.1, -0.4, 1.5]], 9.9);
    }
}
