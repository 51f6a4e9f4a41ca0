//! `InitialLevels`: the flow a state begins with.

use alewife_mesh::Point;

use crate::body::Pose;
use crate::coupling::Solution;

/// The two levels of a flow that is known at the start.
#[derive(Debug, Clone)]
pub struct InitialLevels<const D: usize> {
    /// At the start.
    pub now: Solution<D>,
    /// One step before.
    pub previous: Solution<D>,
    /// Positions of the nodes one step before, seen from the frame (m); by default those at the start.
    pub nodes_before: Option<Vec<Point<D>>>,
    /// Poses one step before; by default those at the start.
    pub previous_poses: Option<Vec<Pose>>,
}

impl<const D: usize> InitialLevels<D> {
    /// Both levels the same.
    #[must_use]
    pub fn steady(flow: Solution<D>) -> Self {
        Self { now: flow.clone(), previous: flow, nodes_before: None, previous_poses: None }
    }
}
