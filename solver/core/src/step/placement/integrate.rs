//! Where bodies get to with the velocities of a step, and where they are taken to be in its next pass.

use super::anderson::Passes;
use super::placed_bodies::Placement;
use crate::body::Pose;
use crate::coupling::Solution;
use crate::step::context::StepContext;
use crate::step::error::StepError;

impl<const D: usize> StepContext<'_, D> {
    /// Bodies at poses with these coordinates.
    ///
    /// # Errors
    /// When these give a body no shape.
    pub fn placement(
        &self,
        mut poses: Vec<Pose>,
        mut coordinates: Vec<f64>,
    ) -> Result<Placement, StepError> {
        let problem = self.stepper.problem;
        problem.follow_attachments(&poses, &mut coordinates);
        problem.follow_coordinates(&mut poses, &coordinates);
        let shapes = self.history.shapes.with_coordinates(&problem.bodies, &coordinates)?;
        Ok(Placement { poses, coordinates, shapes })
    }

    /// Where bodies get to with the velocities of a solution at the new time.
    ///
    /// # Errors
    /// When a body has no shape there.
    pub fn integrate(&self, solution: &Solution<D>) -> Result<Placement, StepError> {
        let coordinates = self.history.coordinates_with(self.state, &solution.rates);
        self.placement(self.integrated_poses(&solution.twists), coordinates)
    }

    /// Where bodies are in the next pass after one for a placement has reached another one.
    ///
    /// # Errors
    /// When passes grow, or a body has no shape there.
    pub fn next_placement(
        &self,
        solved_at: &Placement,
        reached: Placement,
        passes: &mut Passes,
    ) -> Result<Placement, StepError> {
        if reached.coordinates.is_empty() {
            return Ok(reached);
        }
        let next = passes.next(&solved_at.coordinates, &reached.coordinates);
        let coordinates = next.ok_or(StepError::PosesDiverge)?;
        self.placement(reached.poses, coordinates)
    }
}
