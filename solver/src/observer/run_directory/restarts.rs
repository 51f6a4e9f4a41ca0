//! `Restarts`: how often in a row a run was restarted at one and the same step.

use serde::{Deserialize, Serialize};

/// Restarts in a row from one and the same step.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Restarts {
    /// The step.
    pub step: usize,
    /// How many.
    pub count: usize,
}

impl Restarts {
    /// With one more, from a step.
    #[must_use]
    pub fn next(self, step: usize) -> Self {
        let count = if step == self.step { self.count + 1 } else { 1 };
        Self { step, count }
    }
}
