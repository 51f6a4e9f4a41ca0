//! How many pieces fixed steps are made in, where none is rejected.

use super::NEAR;
use super::fixed::{halves, longest_piece};
use super::start::cut;
use crate::case::Unsteady;

/// The pieces of all fixed steps of a run whose rates jump at these times (s), ascending: what a run makes where no step is
/// rejected and no contact asks for shorter ones.
pub(in crate::run) fn n_pieces(settings: &Unsteady, jumps: &[f64]) -> usize {
    let (n_steps, near) = (settings.n_steps(), NEAR * settings.step);
    let between = |from: f64, to: f64| {
        let first = jumps.partition_point(|jump| *jump <= from);
        let end = jumps.partition_point(|jump| *jump < to);
        &jumps[first..end.max(first)]
    };
    let (mut count, mut index, mut last) = (0, 0, 0.0);
    while index < n_steps {
        let start = index as f64 * settings.step;
        let target = (start + settings.step).min(settings.end);
        let is_start = last == 0.0 || !between(start - near, start + near).is_empty();
        let within = between(start + near, target - near);
        if !is_start && within.is_empty() && settings.step <= longest_piece(settings, last) {
            // Whole steps up to the one that a jump is at or within
            let jump = jumps[jumps.partition_point(|jump| *jump <= target - near)..].first();
            let next = jump.map_or(n_steps, |jump| settings.n_steps_to(*jump));
            let next = next.clamp(index + 1, n_steps);
            (count, index, last) = (count + next - index, next, settings.step);
            continue;
        }
        let mut to_do = cut(settings, within.to_vec(), [start, target], is_start);
        while let Some(piece) = to_do.pop() {
            if piece.is_restart {
                last = 0.0;
            }
            if piece.size > longest_piece(settings, last) {
                to_do.extend(halves(piece));
                continue;
            }
            (count, last) = (count + 1, piece.size);
        }
        index += 1;
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{Convection, Initial, Scheme};

    fn settings(step: f64, end: f64, scheme: Scheme) -> Unsteady {
        let (convection, initial) = (Convection::Extrapolated, Initial::Rest);
        Unsteady { step, end, scheme, convection, initial, until: None, adaptive: None }
    }

    #[test]
    fn first_steps_are_made_in_eight_pieces_where_rates_jump_too() {
        let bdf2 = settings(0.1, 1.0, Scheme::Bdf2);
        assert_eq!(n_pieces(&bdf2, &[]), 17);
        // At the end of a step the next one is in pieces; within one there is a piece before, and a step more after
        // the half of what is left
        assert_eq!(n_pieces(&bdf2, &[0.5]), 24);
        assert_eq!(n_pieces(&bdf2, &[0.02, 0.5]), 24 + 8 + 1);
        assert_eq!(n_pieces(&bdf2, &[0.55]), 17 + 8 + 1);
        assert_eq!(n_pieces(&settings(0.1, 1.0, Scheme::Rk3), &[0.5]), 10);
    }
}
