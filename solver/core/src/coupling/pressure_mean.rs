//! `PressureMean`: the mean of the pressure, and the net flux that an enclosed fluid cannot take.

use alewife_mesh::{CellId, Mesh, NodeId, Point};

use super::problem::Problem;
use super::surface::RestPlaces;
use crate::flow::integrate_basis;
use crate::space::{CellValues, Tables};

/// Weights of the pressures in their mean over the fluid.
#[derive(Debug)]
pub(super) struct PressureMean {
    /// int psi dx of each vertex.
    weights: Vec<f64>,
}

impl PressureMean {
    /// Integrates over a mesh.
    pub(super) fn new<const D: usize>(mesh: &Mesh<D>, tables: &Tables<D>) -> Self {
        let mut weights = vec![0.0; mesh.n_vertices];
        integrate_basis(mesh, tables, D + 1, |at| at.psi, &mut weights);
        Self { weights }
    }

    /// Subtracts their sum from the residuals of the pressures, by the weights.
    ///
    /// Boundary values interpolated on curved sides may carry a tiny net flux, which an enclosed
    /// incompressible fluid cannot take: distributed evenly it is not left to the one vertex whose pressure
    /// is fixed.
    pub(super) fn make_compatible(&self, residuals: &mut [f64]) {
        let flux: f64 = residuals.iter().sum();
        let volume: f64 = self.weights.iter().sum();
        for (value, weight) in residuals.iter_mut().zip(&self.weights) {
            *value -= flux * weight / volume;
        }
    }

    /// The mean of what each vertex has.
    pub(super) fn mean(&self, of: impl Fn(usize) -> f64) -> f64 {
        let volume: f64 = self.weights.iter().sum();
        let weighted = self.weights.iter().enumerate();
        weighted.map(|(vertex, weight)| of(vertex) * weight).sum::<f64>() / volume
    }

    /// Shifts a pressure to zero mean.
    pub(super) fn center(&self, pressure: &mut [f64]) {
        let mean = self.mean(|vertex| pressure[vertex]);
        for pressure in pressure {
            *pressure -= mean;
        }
    }

    /// The derivative by a pressure from that by what [`Self::center`] makes of it.
    pub(super) fn before_centering(&self, derivative: &mut [f64]) {
        let volume: f64 = self.weights.iter().sum();
        let by_level: f64 = derivative.iter().sum();
        for (value, weight) in derivative.iter_mut().zip(&self.weights) {
            *value -= by_level * weight / volume;
        }
    }
}

/// The weight of the velocity of a node on bodies with coordinates in the sum of the continuity equations, which is also the
/// residual there by a pressure of one (m2; m planar).
#[derive(Debug)]
pub(super) struct FluxWeight<const D: usize> {
    /// The node.
    pub node: NodeId,
    /// Its weight.
    pub weight: Point<D>,
}

/// The weights of all nodes on bodies with coordinates, copies of them across periodic sides included; none in a fluid that is
/// not enclosed.
pub(super) fn flux_weights<const D: usize>(
    problem: &Problem<D>,
    mesh: &Mesh<D>,
    tables: &Tables<D>,
    rest_places: &RestPlaces,
) -> Vec<FluxWeight<D>> {
    if !problem.is_enclosed() || rest_places.is_empty() {
        return Vec::new();
    }
    let mut weights: Vec<Option<Point<D>>> = vec![None; mesh.n_nodes()];
    for node in rest_places.keys() {
        weights[node.index()] = Some(Point::<D>::zeros());
    }
    for pair in mesh.periodic.iter().filter(|pair| rest_places.contains_key(&pair.original)) {
        weights[pair.copy.index()] = Some(Point::<D>::zeros());
    }
    let mut workspace = CellValues::default();
    for cell in (0..mesh.n_cells()).map(CellId::new) {
        let nodes = mesh.cell(cell);
        if nodes.iter().all(|node| weights[node.index()].is_none()) {
            continue;
        }
        workspace.for_each_point(tables, mesh, cell, |at| {
            for (node, (gradient, value)) in nodes.iter().zip(at.grad_phi.iter().zip(at.phi)) {
                let Some(weight) = &mut weights[node.index()] else { continue };
                for axis in 0..D {
                    let mut alone = Point::<D>::zeros();
                    alone[axis] = *value;
                    let divergence =
                        gradient[axis] + tables.metric().hoop_strain(&alone, &at.position);
                    weight[axis] -= divergence * at.dx;
                }
            }
        });
    }
    let all = weights.into_iter().enumerate();
    let of_node = |(node, weight): (usize, Option<Point<D>>)| {
        Some(FluxWeight { node: NodeId::new(node), weight: weight? })
    };
    all.filter_map(of_node).collect()
}
