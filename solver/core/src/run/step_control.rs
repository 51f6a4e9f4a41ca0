//! `StepControl`: where the control of the step size is.

use serde::{Deserialize, Serialize};

/// A piece of a step.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Piece {
    /// Its size (s).
    pub size: f64,
    /// Whether rates jump at its beginning, so that what was before does not count.
    pub is_restart: bool,
}

/// Where the control of the step size is.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct StepControl {
    /// The step proposed by its error (s), none before the first or with fixed steps.
    pub proposed_step: Option<f64>,
    /// Pieces of the present step that are still to be made, the next one last.
    pub pieces: Vec<Piece>,
    /// The longest next step that bodies in contact allow (s), where any are.
    pub contact_step: Option<f64>,
}
