//! `Differences`: what complete solutions on moved meshes differ by, to compare gradients with.

use super::error::GradientError;
use super::flow::{BaseFlow, steady_flow, surface_loads, values};
use super::point::CasePoint;
use crate::step::SteadyFlow;

/// Solves for flows of a case with other numbers.
pub(super) struct Differences<const D: usize> {
    flow: BaseFlow<D>,
}

impl<const D: usize> Differences<D> {
    /// Takes over the flow of the case.
    pub fn new(flow: BaseFlow<D>) -> Self {
        Self { flow }
    }

    /// The flow of the case.
    pub fn flow(&self) -> &BaseFlow<D> {
        &self.flow
    }

    /// Central differences of the quantities between two points, each a step from the case.
    pub fn between(
        &mut self,
        [below, above]: &[CasePoint<D>; 2],
        step: f64,
    ) -> Result<Vec<f64>, GradientError> {
        let [below, above] = [self.solved(below)?, self.solved(above)?];
        Ok(above.iter().zip(&below).map(|(above, below)| (above - below) / (2.0 * step)).collect())
    }

    fn solved(&mut self, point: &CasePoint<D>) -> Result<Vec<f64>, GradientError> {
        let work = &mut self.flow.work;
        work.mesh.clone_from(&point.mesh);
        work.system.move_to(&point.problem, &point.mesh);
        let SteadyFlow { solution, residual, .. } = steady_flow(work, point)?;
        let loads = surface_loads(&work.system, point, &solution, &residual);
        Ok(values(self.flow.columns(), point, &solution, &loads.bodies))
    }
}
