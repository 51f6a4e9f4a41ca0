//! `Numbering`: what the unknowns of a linear system were numbered for.

use super::super::linear_system::SolverChoice;
use crate::algebra::AffineConstraints;
use crate::body::Modes;
use crate::space::DofLayout;

/// What the numbering of a linear system was made for.
#[derive(Debug, Clone)]
pub(super) struct Numbering {
    /// The solver that was asked for.
    pub choice: SolverChoice,
    /// The body whose velocity is an unknown of the convection, if any.
    pub frame: Option<usize>,
    /// Whether each rigid velocity is an unknown itself.
    pub is_free: Vec<bool>,
}

/// Whether each rigid velocity is an unknown itself, body by body.
pub(super) fn free_velocities<const D: usize>(
    layout: &DofLayout<D>,
    n_bodies: usize,
    modes: Modes,
    constraints: &AffineConstraints,
) -> Vec<bool> {
    let raw = (0..n_bodies).flat_map(|body| (0..modes.len()).map(move |mode| (body, mode)));
    raw.map(|(body, mode)| constraints.unknown(layout.rigid(body, mode)).is_some()).collect()
}
