//! `Numbering`: what the unknowns of a linear system were numbered for.

use std::ops::Range;

use super::super::linear_system::SolverChoice;
use super::super::problem::Problem;
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

/// The unknowns that rates of the coordinates of each body depend on, which couple with each other.
pub(super) fn blocks_of_bodies<const D: usize>(
    problem: &Problem<D>,
    layout: &DofLayout<D>,
    constraints: &AffineConstraints,
) -> Vec<Vec<u32>> {
    let ranges = problem.coordinates().into_iter().filter(|own| !own.is_empty());
    let block = |own: Range<usize>| {
        let rows = own.flat_map(|coordinate| constraints.row(layout.rate(coordinate)));
        let mut unknowns: Vec<u32> = rows.map(|term| term.unknown).collect();
        unknowns.sort_unstable();
        unknowns.dedup();
        unknowns
    };
    ranges.map(block).collect()
}
