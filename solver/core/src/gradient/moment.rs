//! `Moment`: when a flow without inertia is, and where its bodies are.

use crate::body::Pose;
use crate::coupling::Problem;

/// When a flow without inertia is, and where its bodies are.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Moment {
    /// Time of what the poses of bodies that hang on others follow from (s).
    pub time: f64,
    /// Time of their rates, of gaits and of boundary values (s): within the step where rates jump at its beginning.
    pub rates_at: f64,
    /// Poses of all bodies in the laboratory; of those that hang on others what is free counts. Nothing for those of the
    /// case.
    pub poses: Option<Vec<Pose>>,
}

impl Moment {
    /// The bodies as the case has them.
    pub const START: Self = Self { time: 0.0, rates_at: 0.0, poses: None };

    /// The poses of the bodies of a problem.
    pub fn poses<const D: usize>(&self, problem: &Problem<D>) -> Vec<Pose> {
        match &self.poses {
            None => problem.bodies.iter().map(|body| body.pose).collect(),
            Some(poses) => {
                let mut poses = poses.clone();
                problem.apply_joints(&mut poses, self.time);
                poses
            }
        }
    }
}
