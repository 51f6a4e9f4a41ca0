//! `Placement`: where bodies get to in a step, poses and coordinates, with the shapes they have there.

mod anderson;

pub use self::anderson::Passes;
use super::context::StepContext;
use super::error::StepError;
use crate::body::Pose;
use crate::coupling::{BodyShapes, Solution};

/// Where bodies are at the new time.
#[derive(Debug, Clone)]
pub struct Placement {
    /// Poses, in the laboratory.
    pub poses: Vec<Pose>,
    /// Coordinates of all bodies that have some.
    pub coordinates: Vec<f64>,
    /// The shapes of the bodies.
    pub shapes: BodyShapes,
}

impl<const D: usize> StepContext<'_, D> {
    /// Bodies at poses with these coordinates.
    ///
    /// # Errors
    /// When these give a body no shape.
    pub fn placement(
        &self,
        mut poses: Vec<Pose>,
        coordinates: Vec<f64>,
    ) -> Result<Placement, StepError> {
        let problem = self.stepper.problem;
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
