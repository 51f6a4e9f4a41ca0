//! The pieces of a first step, and of steps in which rates jump.

use super::{NEAR, Piece};
use crate::case::{Scheme, Unsteady};
use crate::run::simulation::Simulation;

/// The first step is made in pieces of 1/128, 1/128, 1/64, ... 1/2 of it: the only first-order
/// piece is so short that it does not lower the order of the whole.
const START_PIECES: u32 = 7;

/// The pieces of a step to a time (s), cut where rates of gaits jump, the next one last.
pub(super) fn pieces<const D: usize>(
    settings: &Unsteady,
    simulation: &Simulation<D>,
    target: f64,
) -> Vec<Piece> {
    let state = &simulation.state;
    let near = NEAR * settings.step;
    let jumps = simulation.problem.rate_discontinuities.as_ref();
    let within = jumps.map_or_else(Vec::new, |jumps| jumps(state.time + near, target - near));
    let is_start = state.last_step == 0.0 || simulation.is_at_discontinuity(near);
    cut(settings, within, [state.time, target], is_start)
}

/// The pieces of a step from one time to another (s), cut where rates jump, the next one last; `is_start` where nothing is
/// before that counts.
pub(super) fn cut(
    settings: &Unsteady,
    jumps: Vec<f64>,
    [from, target]: [f64; 2],
    mut is_start: bool,
) -> Vec<Piece> {
    let (mut at, mut ends) = (from, jumps);
    ends.push(target);
    let mut pieces = Vec::new();
    for end in ends {
        let sizes = start_pieces(settings.scheme, is_start, end - at);
        pieces.extend(
            sizes
                .into_iter()
                .enumerate()
                .map(|(nth, size)| Piece { size, is_restart: is_start && nth == 0 }),
        );
        (at, is_start) = (end, true);
    }
    pieces.reverse();
    pieces
}

/// Sizes of the pieces in which a step is made.
pub(super) fn start_pieces(scheme: Scheme, is_start: bool, step: f64) -> Vec<f64> {
    if is_start && scheme == Scheme::Bdf2 {
        let part = |piece: u32| step / f64::from(1u32 << piece);
        std::iter::once(START_PIECES).chain((1..=START_PIECES).rev()).map(part).collect()
    } else {
        vec![step]
    }
}

/// The first piece of a run (s).
pub(in crate::run) fn first_piece(settings: &Unsteady) -> f64 {
    let step = settings.step.min(settings.end);
    start_pieces(settings.scheme, true, step).first().copied().unwrap_or(step)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{Convection, Initial};

    #[test]
    fn steps_end_at_the_end_and_never_more_than_double() {
        let settings = Unsteady {
            step: 0.1,
            end: 0.95,
            scheme: Scheme::Bdf2,
            convection: Convection::Extrapolated,
            initial: Initial::Rest,
            until: None,
            adaptive: None,
        };
        assert_eq!(settings.n_steps(), 10);
        let pieces = start_pieces(settings.scheme, true, 0.1);
        assert!((pieces.iter().sum::<f64>() - 0.1).abs() < 1e-14);
        for pair in pieces.windows(2) {
            assert!(pair[1] / pair[0] <= 2.0 + 1e-12);
        }
    }
}
