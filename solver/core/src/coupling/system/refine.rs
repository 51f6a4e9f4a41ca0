//! The solution that follows from free unknowns, and what iterations have left of it.

use alewife_mesh::Point;

use super::super::error::SolveError;
use super::super::solution::Solution;
use super::{Configuration, FluidSystem};
use crate::timing::Timing;

impl<const D: usize> FluidSystem<D> {
    /// Reduces the residual of a solution to `reduction` (1) of what it is, by the matrix that was assembled last.
    ///
    /// # Errors
    /// When the system cannot be solved.
    pub fn refine(
        &mut self,
        at: &Configuration<'_, D>,
        solution: &Solution<D>,
        reduced: &[f64],
        reduction: f64,
        timing: &mut Timing,
    ) -> Result<Solution<D>, SolveError> {
        let mut free = at.constraints.pick(&self.pinned(solution).to_raw(self.modes));
        let mut step: Vec<f64> = reduced.iter().map(|value| -value).collect();
        self.linear.solve(&mut step, Some(reduction), timing)?;
        free.iter_mut().zip(&step).for_each(|(value, correction)| *value += correction);
        self.next_solution(at, solution, free, timing)
    }

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
