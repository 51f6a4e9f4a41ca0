//! `MassMatrix`: the projection of a scalar onto a new mesh.

use alewife_mesh::Mesh;

use super::equation::{Carrier, Equation, Step};
use super::field::Scalar;
use crate::algebra::LinearError;
use crate::space::Metric;

/// Solves M d = m for the values d at the nodes whose integrals with all test functions are m, so that the amount of a
/// scalar is that of the old mesh.
pub struct MassMatrix<const D: usize> {
    scalar: Scalar<D>,
    equation: Equation<D>,
}

impl<const D: usize> MassMatrix<D> {
    /// On a mesh, no value of which is held.
    #[must_use]
    pub fn new(mesh: &Mesh<D>, metric: Metric) -> Self {
        let scalar = Scalar {
            name: String::new(),
            diffusivity: 0.0,
            conditions: mesh.boundaries.iter().map(|_| None).collect(),
            source: None,
            initial: Box::new(|_, _| 0.0),
            scale: None,
        };
        let equation = Equation::new(&scalar, mesh, metric);
        Self { scalar, equation }
    }

    /// d for m on a configuration of the mesh.
    ///
    /// # Errors
    /// When the system has no solution, as for numbers that are not finite.
    pub fn solve(&mut self, mesh: &Mesh<D>, missed: &[f64]) -> Result<Vec<f64>, LinearError> {
        let carrier = Carrier { mesh, velocity: &[], time: 0.0 };
        let step = Step { rate: 1.0, history: &[] };
        self.equation.solve_for(&self.scalar, carrier, step, missed)
    }
}
