//! `CellPoints`: weights and gradients at the quadrature points of all cells of a solid at rest.

mod quadrature;
mod stiffness;

use alewife_mesh::Point;

use self::quadrature::{gradients, rule, shapes};
pub(super) use self::stiffness::CellMatrix;

use super::SolidError;
use super::mesh::{Frame, Order, SolidMesh};
use crate::material::Tensor;

/// Nodes of a cell at most.
pub(super) const MAX_NODES: usize = 10;

/// Components of the places of a cell at most.
pub(super) const MAX_PLACES: usize = 3 * MAX_NODES;

/// Unknowns of a cell at most: its places, and pressures at its vertices.
pub(super) const MAX_UNKNOWNS: usize = MAX_PLACES + 4;

/// What is integrated at rest: a body is deformed, its cells at rest remain.
#[derive(Debug, Clone)]
pub(super) struct CellPoints<const D: usize> {
    /// Quadrature points of a cell.
    pub n_points: usize,
    /// Nodes of a cell.
    pub n_local: usize,
    /// Shape functions at the points of a cell, point after point.
    pub shapes: Vec<f64>,
    /// Barycentric coordinates of the points of a cell.
    pub shares: Vec<[f64; 4]>,
    /// Volume (m3, in the plane m2) of each point of each cell.
    pub weights: Vec<f64>,
    /// Gradients (1/m) of the shape functions, node after node for each point of each cell.
    pub gradients: Vec<Point<D>>,
    /// Distances from the axis (m) of all points; empty where there is none.
    pub radii: Vec<f64>,
}

/// A quadrature point of a cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct At<'a, const D: usize> {
    /// Its volume.
    pub weight: f64,
    /// Gradients of the nodes.
    pub gradients: &'a [Point<D>],
    /// Shape functions of the nodes.
    pub shapes: &'a [f64],
    /// Its barycentric coordinates: shares of the vertices.
    pub shares: &'a [f64],
    /// One over the distance from the axis; zero where there is none.
    pub curvature: f64,
}

impl<const D: usize> At<'_, D> {
    /// The gradient of a field with these values at the nodes, with its part along the hoop.
    pub(super) fn gradient(&self, values: &[Point<D>]) -> Tensor {
        let mut gradient = Tensor::zeros();
        for (value, slope) in values.iter().zip(self.gradients) {
            for i in 0..D {
                for j in 0..D {
                    gradient[(i, j)] += value[i] * slope[j];
                }
            }
        }
        if self.curvature > 0.0 {
            let radial = values.iter().zip(self.shapes).map(|(value, shape)| value[1] * shape);
            gradient[(2, 2)] = radial.sum::<f64>() * self.curvature;
        }
        gradient
    }

    /// The deformation gradient of nodes at these places.
    pub(super) fn deformation(&self, places: &[Point<D>]) -> Tensor {
        let mut deformation = self.gradient(places);
        if D == 2 && self.curvature == 0.0 {
            deformation[(2, 2)] = 1.0;
        }
        deformation
    }

    /// Adds the forces of a stress on the nodes.
    pub(super) fn add_forces(&self, stress: &Tensor, forces: &mut [f64]) {
        for (a, slope) in self.gradients.iter().enumerate() {
            for i in 0..D {
                let along: f64 = (0..D).map(|j| stress[(i, j)] * slope[j]).sum();
                forces[a * D + i] += self.weight * along;
            }
            if self.curvature > 0.0 {
                let hoop = stress[(2, 2)] * self.shapes[a] * self.curvature;
                forces[a * D + 1] += self.weight * hoop;
            }
        }
    }
}

impl<const D: usize> CellPoints<D> {
    /// The points of a mesh.
    pub(super) fn new(mesh: &SolidMesh<D>, frame: Frame) -> Result<Self, SolidError> {
        let is_axis = frame == Frame::Axis;
        let rule = rule::<D>(mesh.order, is_axis);
        let n_local = mesh.n_local();
        let mut points = Self {
            n_points: rule.len(),
            n_local,
            shapes: rule.iter().flat_map(|p| shapes::<D>(mesh.order, p.at)).collect(),
            shares: rule.iter().map(|p| p.at).collect(),
            weights: Vec::new(),
            gradients: Vec::new(),
            radii: Vec::new(),
        };
        for (number, cell) in mesh.cells.chunks_exact(n_local).enumerate() {
            let places: Vec<Point<D>> = cell.iter().map(|node| mesh.nodes[*node]).collect();
            for (k, point) in rule.iter().enumerate() {
                let local = &points.shapes[k * n_local..(k + 1) * n_local];
                let map = slopes(mesh.order, point.at, &places);
                let determinant = map.jacobian.determinant();
                let Some(inverse) = map.jacobian.try_inverse().filter(|_| determinant > 0.0) else {
                    return Err(SolidError::Cell(number));
                };
                let slope = |local: &Point<D>| -> Point<D> {
                    Point::from_fn(|i, _| (0..D).map(|j| inverse[(j, i)] * local[j]).sum())
                };
                let mut weight = point.weight * determinant / if D == 2 { 2.0 } else { 6.0 };
                if is_axis {
                    let radius: f64 = places.iter().zip(local).map(|(x, shape)| x[1] * shape).sum();
                    if radius <= 0.0 {
                        return Err(SolidError::Cell(number));
                    }
                    weight *= std::f64::consts::TAU * radius;
                    points.radii.push(radius);
                }
                points.weights.push(weight);
                points.gradients.extend(map.gradients.iter().map(slope));
            }
        }
        Ok(points)
    }

    /// A point of a cell.
    pub(super) fn at(&self, cell: usize, point: usize) -> At<'_, D> {
        let number = cell * self.n_points + point;
        let local = self.n_local;
        At {
            weight: self.weights[number],
            gradients: &self.gradients[number * local..(number + 1) * local],
            shapes: &self.shapes[point * local..(point + 1) * local],
            shares: &self.shares[point][..=D],
            curvature: self.radii.get(number).map_or(0.0, |radius| 1.0 / radius),
        }
    }
}

/// The map from the reference cell at a point.
struct Slopes<const D: usize> {
    /// Derivatives of the place by the reference coordinates; in the plane the third is one.
    jacobian: Tensor,
    /// Gradients of the shape functions in the reference cell.
    gradients: Vec<Point<D>>,
}

/// The map of a cell with nodes at these places.
fn slopes<const D: usize>(order: Order, at: [f64; 4], places: &[Point<D>]) -> Slopes<D> {
    let barycentric: Vec<Point<D>> = (0..=D)
        .map(|i| Point::from_fn(|j, _| if i == 0 { -1.0 } else { f64::from(u8::from(i == j + 1)) }))
        .collect();
    let gradients = gradients::<D>(order, at, &barycentric);
    let mut jacobian = Tensor::zeros();
    for (place, gradient) in places.iter().zip(&gradients) {
        for i in 0..D {
            for j in 0..D {
                jacobian[(i, j)] += place[i] * gradient[j];
            }
        }
    }
    if D == 2 {
        jacobian[(2, 2)] = 1.0;
    }
    Slopes { jacobian, gradients }
}
