//! `PressureMean`: the mean of the pressure, and the net flux that an enclosed fluid cannot take.

use alewife_mesh::Mesh;

use crate::flow::integrate_basis;
use crate::space::Tables;

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

    /// Shifts a pressure to zero mean.
    pub(super) fn center(&self, pressure: &mut [f64]) {
        let volume: f64 = self.weights.iter().sum();
        let weighted = pressure.iter().zip(&self.weights);
        let mean = weighted.map(|(pressure, weight)| pressure * weight).sum::<f64>() / volume;
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
