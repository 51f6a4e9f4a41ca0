//! `UniformFlows`: what changes the momentum of the fluid in a periodic domain, and nothing at its boundaries.

use alewife_mesh::{Mesh, Point, Simplex};
use nalgebra::{DMatrix, DVector};

use crate::flow::integrate_basis;
use crate::space::Tables;

/// Mean velocity of a flow over that of a uniform one below which it is rounding: walls leave none.
const HELD: f64 = 1e-3;

/// The divergence-free velocities nearest to uniform ones that are zero where velocities are given, on a mesh.
pub(super) struct UniformFlows<const D: usize> {
    /// int phi dx of each node (m3; m2 planar).
    integrals: Vec<f64>,
    /// One at the nodes for each coordinate (m/s).
    flows: Vec<Vec<Point<D>>>,
    /// Their factors by the integral of their sum.
    factors: DMatrix<f64>,
}

/// int phi dx of each node of a mesh (m3; m2 planar).
pub(super) fn node_integrals<const D: usize>(mesh: &Mesh<D>, tables: &Tables<D>) -> Vec<f64> {
    let mut integrals = vec![0.0; mesh.n_nodes()];
    integrate_basis(mesh, tables, Simplex::<D>::N_NODES, |at| at.phi, &mut integrals);
    integrals
}

/// The integral of a velocity (m/s at the nodes) by those of the basis functions (m4/s; m3/s planar).
pub(super) fn integral<const D: usize>(integrals: &[f64], velocity: &[Point<D>]) -> Point<D> {
    let nodes = integrals.iter().zip(velocity);
    nodes.fold(Point::<D>::zeros(), |sum, (integral, velocity)| sum + velocity * *integral)
}

impl<const D: usize> UniformFlows<D> {
    /// With the flows of some coordinates.
    pub fn new(integrals: Vec<f64>, flows: Vec<Vec<Point<D>>>) -> Self {
        let volume: f64 = integrals.iter().sum();
        let means: Vec<Point<D>> =
            flows.iter().map(|flow| integral(&integrals, flow) / volume).collect();
        let matrix = DMatrix::from_fn(flows.len(), flows.len(), |row, column| means[column][row]);
        let factors = matrix
            .pseudo_inverse(HELD)
            .map_or_else(|_| DMatrix::zeros(flows.len(), flows.len()), |inverse| inverse / volume);
        Self { integrals, flows, factors }
    }

    /// Adds what gives a velocity this integral, as far as boundaries leave it open.
    pub fn give(&self, wanted: &Point<D>, velocity: &mut [Point<D>]) {
        let missing = wanted - integral(&self.integrals, velocity);
        let missing = DVector::from_fn(self.flows.len(), |axis, _| missing[axis]);
        let factors = &self.factors * missing;
        for (flow, factor) in self.flows.iter().zip(&factors) {
            for (velocity, flow) in velocity.iter_mut().zip(flow) {
                *velocity += flow * *factor;
            }
        }
    }
}
