//! Unknowns of a state and components of all nodes, one from the other.

use super::pose::Pose;
use crate::solid::build::Solid;

/// A direction of a search.
#[derive(Debug, Clone)]
pub(in crate::solid) struct Direction {
    /// By all components, to first order.
    pub all: Vec<f64>,
    /// By the unknowns.
    pub free: Vec<f64>,
}

impl<const D: usize> Solid<D> {
    /// Its rigid parts in a state; none where it has none.
    pub(in crate::solid) fn pose<'a>(&'a self, state: &'a [f64]) -> Option<Pose<'a, D>> {
        (!self.ties.is_empty()).then(|| Pose::new(&self.ties, state))
    }

    /// A list of all components along the unknowns of a state.
    pub(in crate::solid) fn free(&self, state: &[f64], all: &[f64]) -> Vec<f64> {
        let mut free = self.pattern.free(all);
        if let Some(pose) = self.pose(state) {
            pose.add_free(all, &mut free);
        }
        free
    }

    /// How all components move with the unknowns of a state, to first order.
    pub(in crate::solid) fn all(&self, state: &[f64], free: &[f64]) -> Vec<f64> {
        let mut all = self.pattern.all(free);
        if let Some(pose) = self.pose(state) {
            pose.add_all(free, &mut all);
        }
        all
    }

    /// A direction of a state by its unknowns.
    pub(in crate::solid) fn direction(&self, state: &[f64], free: Vec<f64>) -> Direction {
        Direction { all: self.all(state, &free), free }
    }

    /// The state so far against a direction; rigid parts turn in full.
    pub(in crate::solid) fn against(
        &self,
        state: &[f64],
        direction: &Direction,
        length: f64,
    ) -> Vec<f64> {
        let pairs = state.iter().zip(&direction.all);
        let mut next: Vec<f64> = pairs.map(|(x, step)| x - length * step).collect();
        if let Some(pose) = self.pose(state) {
            let free: Vec<f64> = direction.free.iter().map(|step| -length * step).collect();
            pose.place(&free, &mut next);
        }
        next
    }
}
