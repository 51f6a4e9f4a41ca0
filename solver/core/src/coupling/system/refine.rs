//! The solution that follows from free unknowns.

use alewife_mesh::Point;

use super::super::error::SolveError;
use super::super::solution::Solution;
use super::{Configuration, FluidSystem};
use crate::timing::Timing;

impl<const D: usize> FluidSystem<D> {
    /// The solution with these free unknowns, those of the mean flow from the one before.
    pub(super) fn next_solution(
        &mut self,
        at: &Configuration<'_, D>,
        solution: &Solution<D>,
        mut free: Vec<f64>,
        timing: &mut Timing,
    ) -> Result<Solution<D>, SolveError> {
        let pressure_gradient =
            solution.pressure_gradient + self.meet_mean_velocity(at, &mut free, timing)?;
        let raw = at.constraints.expand(&free);
        if let Some(index) = raw.iter().position(|value| !value.is_finite()) {
            let node = (index / D).min(self.layout.n_nodes - 1);
            let near = at.mesh.nodes[node].as_slice().to_vec();
            return Err(SolveError::NotFinite { near });
        }
        let next = Solution::from_raw(&self.layout, self.modes, &raw);
        let mean = Point::<D>::from_fn(|axis, _| at.mean_flow.velocity(axis).unwrap_or(0.0));
        Ok(self.centered(Solution { pressure_gradient, ..next }, &mean))
    }
}
