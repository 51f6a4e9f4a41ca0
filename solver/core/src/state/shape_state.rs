//! `ShapeState`: the coordinates of bodies that have some beside their poses, at two levels.

use serde::{Deserialize, Serialize};

/// Coordinates of all bodies together, and how their rates change.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ShapeState {
    /// At present.
    pub now: Vec<f64>,
    /// One step before.
    pub before: Vec<f64>,
    /// Rates of change of their rates.
    pub accelerations: Vec<f64>,
}

impl ShapeState {
    /// At rest with these coordinates.
    #[must_use]
    pub fn at_rest(coordinates: Vec<f64>) -> Self {
        let accelerations = vec![0.0; coordinates.len()];
        Self { before: coordinates.clone(), now: coordinates, accelerations }
    }

    /// Whether it has so many coordinates.
    #[must_use]
    pub fn is_of(&self, n_coordinates: usize) -> bool {
        [&self.now, &self.before, &self.accelerations].iter().all(|all| all.len() == n_coordinates)
    }
}
