//! `Placed`: where bodies are in a step with contact.

use crate::body::Pose;
use crate::contact::Gaps;

/// Where bodies are.
pub(super) struct Placed {
    /// Poses of all bodies.
    pub poses: Vec<Pose>,
    /// Coordinates of all bodies that have some.
    pub coordinates: Vec<f64>,
    /// The gaps there, where bodies have coordinates.
    pub own_gaps: Option<Box<dyn Gaps>>,
}

impl Placed {
    /// The gaps there; those that are given where shapes stay as they are.
    pub fn gaps<'b>(&'b self, of_step: &'b dyn Gaps) -> &'b dyn Gaps {
        self.own_gaps.as_deref().unwrap_or(of_step)
    }
}
