//! Basis values, physical gradients and weights at the quadrature points of one cell.
//!
//! x(X) = sum_a x_a phi_a(X) on curved cells, the affine map of the vertices on the others. In
//! axisymmetric problems dx carries the ring's length 2 pi r, so that integrals are those of the whole body
//! of revolution.

use alewife_mesh::{CellId, Mesh, Point};
use nalgebra::{SMatrix, SVector};

use super::basis::{p1_gradients, p1_values, p2_gradients, p2_values};
use super::metric::Metric;
use super::quadrature::{Rule, simplex_rule};

/// Values of the bases at the points of a rule.
#[derive(Debug, Clone)]
struct BasisTable<const D: usize> {
    rule: Rule<D>,
    phi: Vec<Vec<f64>>,
    grad_phi: Vec<Vec<SVector<f64, D>>>,
    psi: Vec<Vec<f64>>,
}

impl<const D: usize> BasisTable<D> {
    fn new(degree: usize) -> Self {
        let rule = simplex_rule(degree);
        let phi = rule.points.iter().map(p2_values).collect();
        let grad_phi = rule.points.iter().map(p2_gradients).collect();
        let psi = rule.points.iter().map(p1_values).collect();
        Self { rule, phi, grad_phi, psi }
    }
}

/// Basis tables for affine and curved cells, made once a run.
#[derive(Debug, Clone)]
pub struct Tables<const D: usize> {
    affine: BasisTable<D>,
    curved: BasisTable<D>,
    metric: Metric,
}

impl<const D: usize> Tables<D> {
    /// Tables exact for the convection term on affine cells (degree 5; 6 with the factor r), and
    /// of degree 8 on curved cells, where the integrands are rational.
    #[must_use]
    pub fn new(metric: Metric) -> Self {
        let affine = BasisTable::new(5 + metric.ring_degree());
        Self { affine, curved: BasisTable::new(8), metric }
    }

    /// The quadrature rule of curved or of straight cells.
    #[must_use]
    pub fn rule(&self, curved: bool) -> &Rule<D> {
        if curved { &self.curved.rule } else { &self.affine.rule }
    }

    /// The metric that dx belongs to.
    #[must_use]
    pub fn metric(&self) -> Metric {
        self.metric
    }
}

/// All that a term needs at one quadrature point.
#[derive(Debug, Clone)]
pub struct PointValues<'a, const D: usize> {
    /// Quadratic basis (velocity), one value a node.
    pub phi: &'a [f64],
    /// Linear basis (pressure), one value a vertex.
    pub psi: &'a [f64],
    /// Gradients of the quadratic basis (1/m).
    pub grad_phi: &'a [SVector<f64, D>],
    /// Quadrature weight mapped to the cell (m^D; m^3 in axisymmetric problems).
    pub dx: f64,
    /// Position (m).
    pub position: Point<D>,
}

/// Workspace that visits the quadrature points of one cell after the other.
#[derive(Debug, Clone, Default)]
pub struct CellValues<const D: usize> {
    grad_phi: Vec<SVector<f64, D>>,
    corners: Vec<Point<D>>,
}

/// Jacobian dx_i/dX_j of the map given by node positions and reference gradients.
fn jacobian<const D: usize>(
    nodes: &[Point<D>],
    gradients: &[SVector<f64, D>],
) -> SMatrix<f64, D, D> {
    nodes
        .iter()
        .zip(gradients)
        .fold(SMatrix::zeros(), |sum, (node, gradient)| sum + node * gradient.transpose())
}

/// Determinant and transposed inverse of a 2x2 or 3x3 matrix.
fn invert<const D: usize>(matrix: &SMatrix<f64, D, D>) -> (f64, SMatrix<f64, D, D>) {
    let mut cofactor = SMatrix::<f64, D, D>::zeros();
    let m = |i: usize, j: usize| matrix[(i % D, j % D)];
    for i in 0..D {
        for j in 0..D {
            cofactor[(i, j)] = if D == 2 {
                let sign = if i == j { 1.0 } else { -1.0 };
                sign * m(i + 1, j + 1)
            } else {
                m(i + 1, j + 1) * m(i + 2, j + 2) - m(i + 1, j + 2) * m(i + 2, j + 1)
            };
        }
    }
    let determinant = (0..D).map(|j| matrix[(0, j)] * cofactor[(0, j)]).sum();
    (determinant, cofactor / determinant)
}

impl<const D: usize> CellValues<D> {
    /// Calls `visit` at each quadrature point of a cell.
    pub fn for_each_point(
        &mut self,
        tables: &Tables<D>,
        mesh: &Mesh<D>,
        cell: CellId,
        mut visit: impl FnMut(&PointValues<'_, D>),
    ) {
        let curved = mesh.curved[cell];
        let table = if curved { &tables.curved } else { &tables.affine };
        self.corners.clear();
        self.corners.extend(mesh.cell(cell).iter().map(|&node| mesh.nodes[node]));
        let affine = (!curved).then(|| invert(&jacobian(&self.corners[..=D], &p1_gradients())));
        for q in 0..table.rule.points.len() {
            let (determinant, inverse_transposed) =
                affine.unwrap_or_else(|| invert(&jacobian(&self.corners, &table.grad_phi[q])));
            self.grad_phi.clear();
            self.grad_phi.extend(table.grad_phi[q].iter().map(|grad| inverse_transposed * grad));
            let position = if curved {
                weighted_sum(&self.corners, &table.phi[q])
            } else {
                weighted_sum(&self.corners[..=D], &table.psi[q])
            };
            visit(&PointValues {
                phi: &table.phi[q],
                psi: &table.psi[q],
                grad_phi: &self.grad_phi,
                dx: table.rule.weights[q] * determinant * tables.metric.ring(&position),
                position,
            });
        }
    }

    /// Physical gradients of the quadratic basis and the Jacobian at a reference point of a cell.
    #[must_use]
    pub fn at(
        mesh: &Mesh<D>,
        cell: CellId,
        xi: &SVector<f64, D>,
    ) -> (Vec<f64>, Vec<SVector<f64, D>>, SMatrix<f64, D, D>, Point<D>) {
        let corners: Vec<_> = mesh.cell(cell).iter().map(|&node| mesh.nodes[node]).collect();
        let (phi, reference) = (p2_values(xi), p2_gradients(xi));
        let map = jacobian(&corners, &reference);
        let (_, inverse_transposed) = invert(&map);
        let position = weighted_sum(&corners, &phi);
        (phi, reference.iter().map(|grad| inverse_transposed * grad).collect(), map, position)
    }
}

/// Measure (m^D) of a cell's straight simplex, negative when it is inverted, and the gradients
/// (1/m) of its D + 1 linear basis functions.
#[must_use]
pub fn simplex_gradients<const D: usize>(
    mesh: &Mesh<D>,
    cell: CellId,
) -> (f64, Vec<SVector<f64, D>>) {
    let corners: Vec<_> = mesh.cell_vertices(cell).iter().map(|&node| mesh.nodes[node]).collect();
    let reference = p1_gradients();
    let (determinant, inverse_transposed) = invert(&jacobian(&corners, &reference));
    let factorial: usize = (1..=D).product();
    let gradients = reference.iter().map(|gradient| inverse_transposed * gradient).collect();
    (determinant / factorial as f64, gradients)
}

/// sum_i weight_i point_i.
fn weighted_sum<const D: usize>(points: &[Point<D>], weights: &[f64]) -> Point<D> {
    points.iter().zip(weights).fold(Point::zeros(), |sum, (point, weight)| sum + point * *weight)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_inverse_is_the_inverse() {
        let two = SMatrix::<f64, 2, 2>::new(2.0, 1.0, -0.5, 3.0);
        let (determinant, inverse_transposed) = invert(&two);
        assert!((determinant - 6.5).abs() < 1e-14);
        assert!((two.transpose() * inverse_transposed - SMatrix::identity()).norm() < 1e-14);
        let three = SMatrix::<f64, 3, 3>::new(2.0, 1.0, 0.3, -0.5, 3.0, 0.2, 0.1, -0.4, 1.5);
        let (determinant, inverse_transposed) = invert(&three);
        assert!((determinant - three.determinant()).abs() < 1e-13);
        assert!((three.transpose() * inverse_transposed - SMatrix::identity()).norm() < 1e-13);
    }
}
