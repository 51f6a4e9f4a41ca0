//! Basis values, physical gradients and weights at the quadrature points of one cell.
//!
//! x(X) = sum_a x_a phi_a(X) on curved cells, the affine map of the vertices on the others. In
//! axisymmetric problems dx carries the ring's length 2 pi r, so that integrals are those of the
//! whole body of revolution.

use alewife_mesh::{CellId, Mesh, Point};
use nalgebra::{SMatrix, SVector};

use super::adjugate::adjugate;
use super::basis::{p1_gradients, p1_values};
use super::element::Element;
use super::metric::Metric;
use super::quadrature::{Rule, simplex_rule};

/// Values of the bases at the points of a rule.
#[derive(Debug, Clone)]
struct BasisTable<const D: usize> {
    rule: Rule<D>,
    phi: Vec<Vec<f64>>,
    grad_phi: Vec<Vec<SVector<f64, D>>>,
    psi: Vec<Vec<f64>>,
    barycentric: Vec<Vec<f64>>,
}

impl<const D: usize> BasisTable<D> {
    fn new(element: &Element<D>, degree: usize) -> Self {
        let rule = simplex_rule(degree);
        let phi = rule.points.iter().map(element.phi).collect();
        let grad_phi = rule.points.iter().map(element.grad_phi).collect();
        let psi = rule.points.iter().map(element.psi).collect();
        let barycentric = rule.points.iter().map(p1_values).collect();
        Self { rule, phi, grad_phi, psi, barycentric }
    }
}

/// Basis tables for affine and curved cells, made once a run.
#[derive(Debug, Clone)]
pub struct Tables<const D: usize> {
    affine: BasisTable<D>,
    curved: BasisTable<D>,
    element: Element<D>,
    metric: Metric,
}

impl<const D: usize> Tables<D> {
    /// Tables of the P2-P1 element: exact for the convection term on affine cells, and of higher
    /// degree on curved cells, where the integrands are rational.
    #[must_use]
    pub fn new(metric: Metric) -> Self {
        let element = Element::QUADRATIC;
        Self {
            affine: BasisTable::new(&element, element.affine_degree() + metric.ring_degree()),
            curved: BasisTable::new(&element, element.curved_degree()),
            element,
            metric,
        }
    }

    /// The quadrature rule of curved or of straight cells.
    #[must_use]
    pub fn rule(&self, curved: bool) -> &Rule<D> {
        if curved { &self.curved.rule } else { &self.affine.rule }
    }

    /// The bases.
    #[must_use]
    pub fn element(&self) -> &Element<D> {
        &self.element
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
    /// Basis of the velocity, one value a node of the cell.
    pub phi: &'a [f64],
    /// Basis of the pressure, one value a pressure node of the cell.
    pub psi: &'a [f64],
    /// Gradients of the velocity's basis (1/m).
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

/// The map x(X) of a cell at one point.
#[derive(Debug, Clone, Copy)]
pub(super) struct CellMap<const D: usize> {
    /// dx_i / dX_j (m).
    pub jacobian: SMatrix<f64, D, D>,
    /// Its determinant (m^D).
    pub determinant: f64,
    /// Transpose of its inverse (1/m).
    inverse_transposed: SMatrix<f64, D, D>,
}

impl<const D: usize> CellMap<D> {
    /// The map given by positions of nodes and the gradients of their basis at the point.
    pub fn new(nodes: &[Point<D>], gradients: &[SVector<f64, D>]) -> Self {
        let jacobian = nodes
            .iter()
            .zip(gradients)
            .fold(SMatrix::zeros(), |sum, (node, gradient)| sum + node * gradient.transpose());
        let rows = std::array::from_fn(|i| std::array::from_fn(|j| [jacobian[(i, j)]]));
        let (mut cofactors, mut determinant) = ([[[0.0]; D]; D], [0.0]);
        adjugate(&rows, &mut cofactors, &mut determinant);
        let [determinant] = determinant;
        let inverse_transposed = SMatrix::from_fn(|i, j| cofactors[j][i][0] / determinant);
        Self { jacobian, determinant, inverse_transposed }
    }

    /// The gradient (1/m) of a function from that in reference coordinates.
    pub fn gradient(&self, reference: &SVector<f64, D>) -> SVector<f64, D> {
        self.inverse_transposed * reference
    }
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
        let affine = (!curved).then(|| CellMap::new(&self.corners[..=D], &p1_gradients()));
        for q in 0..table.rule.points.len() {
            let map = affine.unwrap_or_else(|| CellMap::new(&self.corners, &table.grad_phi[q]));
            self.grad_phi.clear();
            self.grad_phi.extend(table.grad_phi[q].iter().map(|gradient| map.gradient(gradient)));
            let position = if curved {
                weighted_sum(&self.corners, &table.phi[q])
            } else {
                weighted_sum(&self.corners[..=D], &table.barycentric[q])
            };
            visit(&PointValues {
                phi: &table.phi[q],
                psi: &table.psi[q],
                grad_phi: &self.grad_phi,
                dx: table.rule.weights[q] * map.determinant * tables.metric.ring(&position),
                position,
            });
        }
    }
}

/// The straight simplex of a cell.
#[derive(Debug, Clone, PartialEq)]
pub struct StraightCell<const D: usize> {
    /// Measure (m^D), negative when it is inverted.
    pub measure: f64,
    /// Gradients (1/m) of its D + 1 linear basis functions.
    pub gradients: Vec<SVector<f64, D>>,
}

/// The straight simplex of a cell.
#[must_use]
pub fn straight_cell<const D: usize>(mesh: &Mesh<D>, cell: CellId) -> StraightCell<D> {
    let corners: Vec<_> = mesh.cell_vertices(cell).iter().map(|&node| mesh.nodes[node]).collect();
    let reference = p1_gradients();
    let map = CellMap::new(&corners, &reference);
    let factorial: usize = (1..=D).product();
    let gradients = reference.iter().map(|gradient| map.gradient(gradient)).collect();
    StraightCell { measure: map.determinant / factorial as f64, gradients }
}

/// sum_i weight_i point_i.
pub(super) fn weighted_sum<const D: usize>(points: &[Point<D>], weights: &[f64]) -> Point<D> {
    points.iter().zip(weights).fold(Point::zeros(), |sum, (point, weight)| sum + point * *weight)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gradient_in_space_gives_the_derivative_along_each_reference_axis() {
        let nodes = [[2.0, 1.0, 0.3], [-0.5, 3.0, 0.2], [0.1, -0.4, 1.5], [0.0, 0.0, 0.0]]
            .map(Point::<3>::from);
        let gradients = p1_gradients::<3>();
        let map = CellMap::new(&nodes, &gradients);
        assert!((map.determinant - map.jacobian.determinant()).abs() < 1e-13);
        for (gradient, reference) in gradients.iter().map(|at| (map.gradient(at), at)) {
            assert!((map.jacobian.transpose() * gradient - reference).norm() < 1e-13);
        }
    }
}
