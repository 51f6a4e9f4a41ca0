//! `MassRows`: what iterations may leave of the rows of pressures, beside what they may leave of all rows.

use super::scaled::{Iterate, Scaled};

/// What iterations in single precision reduce a residual to at most; the next one is computed in double
/// precision.
pub(super) const CYCLE: f64 = 1e-3;
/// Part of the tolerance that they are to reach, since their own residual is not exact.
pub(super) const AIM: f64 = 0.8;

/// Most times that iterations continue for these rows, and what they are to leave of the residual each time.
const ROUNDS: usize = 4;
const ROUND: f64 = 0.3;
/// Times the tolerance that a correction of these rows may leave in all rows.
const LOSS: f64 = 10.0;

/// A limit for the rows of pressures.
///
/// A residual that is small in the norm of all rows may be large in these, of which each is the volume that a part of
/// the fluid gains or loses. They are corrected as a fractional step does it (@chorin1968), which makes the residual of
/// the others two to four times as large; iterations continue where that is too much.
pub(super) struct MassRows {
    /// Largest sum of the sizes of these rows.
    limit: f64,
    has_held_pressure: bool,
    /// Norm of the residual of all rows that is small enough.
    tolerance: f64,
    /// What iterations are to come to next.
    pub goal: f64,
    rounds: usize,
}

impl MassRows {
    /// A limit beside a tolerance.
    pub fn new(limit: f64, has_held_pressure: bool, tolerance: f64) -> Self {
        Self { limit, has_held_pressure, tolerance, goal: tolerance, rounds: 0 }
    }

    /// Whether an iterate that has come to the goal, with a residual of the norm `reached`, is within the limit, with
    /// these rows corrected if need be. If not, there is another goal.
    pub fn is_met(
        &mut self,
        system: &mut Scaled<'_>,
        rhs: &[f64],
        iterate: &mut Iterate,
        reached: &mut f64,
    ) -> bool {
        let over = |system: &Scaled<'_>, iterate: &Iterate| {
            system.mass(&iterate.residual, self.has_held_pressure) / self.limit
        };
        let excess = over(system, iterate);
        if excess <= 1.0 {
            return true;
        }
        if self.rounds == ROUNDS {
            tracing::debug!(excess, "rounding leaves more of the mass than wanted");
            return true;
        }
        let part = (AIM / excess).max(CYCLE);
        if let Some(better) = system.without_divergence(iterate, rhs, *reached, part) {
            let (norm, left) = (system.norm(&better.residual), over(system, &better));
            tracing::trace!(excess, left, before = *reached, after = norm, "mass");
            if left < excess && norm <= LOSS * self.tolerance {
                (*iterate, *reached) = (better, norm);
                if left <= 1.0 && norm <= self.tolerance {
                    return true;
                }
            }
        }
        self.goal = ROUND * self.goal.min(*reached);
        self.rounds += 1;
        false
    }
}
