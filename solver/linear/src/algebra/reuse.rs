//! `ReusePolicy`: when factors of an earlier matrix are tried as a preconditioner.

use crate::multifrontal::Analysis;

/// Most iterations with the factors of an earlier matrix.
const MAX_ITERATIONS: usize = 20;
/// A residual within this factor of its tolerance is always worth a trial.
const NEAR: f64 = 1e3;
/// Systems that are factorised without a trial after the first one that failed.
const FIRST_PAUSE: usize = 2;
/// Most of them, after many in a row.
const LONGEST_PAUSE: usize = 256;

/// Compares what iterations and factorisations cost, and pauses after trials that failed.
#[derive(Debug)]
pub(super) struct ReusePolicy {
    /// Time of a factorisation by its operations (ns).
    factorisation_cost: f64,
    /// Time of one iteration by its operations (ns).
    iteration_cost: f64,
    /// Systems still to be factorised without a trial.
    remaining_pause: usize,
    /// The pause after the next failure.
    next_pause: usize,
}

impl ReusePolicy {
    /// The policy for a matrix with `n_entries` stored entries.
    pub fn new(analysis: &Analysis, n_entries: usize) -> Self {
        let iteration_cost = analysis.substitution_cost() + 2.0 * n_entries as f64;
        Self::from_costs(analysis.factorisation_cost(), iteration_cost)
    }

    /// The policy for given times of a factorisation and of an iteration (ns).
    pub fn from_costs(factorisation_cost: f64, iteration_cost: f64) -> Self {
        Self { factorisation_cost, iteration_cost, remaining_pause: 0, next_pause: FIRST_PAUSE }
    }

    /// Iterations that take as long as a factorisation with its one solve.
    pub fn affordable_iterations(&self) -> usize {
        let ratio = self.factorisation_cost / self.iteration_cost;
        (1..=MAX_ITERATIONS).take_while(|&iterations| iterations as f64 <= ratio).count()
    }

    /// Whether to try the factors at hand on a residual that has to fall by a factor of `reduction`.
    pub fn is_worth_a_trial(&mut self, reduction: f64) -> bool {
        if reduction > NEAR && self.remaining_pause > 0 {
            self.remaining_pause -= 1;
            return false;
        }
        self.affordable_iterations() > 1
    }

    /// What remains of the present pause, and the pause after the next failure.
    pub fn pauses(&self) -> [usize; 2] {
        [self.remaining_pause, self.next_pause]
    }

    /// Sets the pauses to those of an earlier solver.
    pub fn set_pauses(&mut self, [remaining, next]: [usize; 2]) {
        (self.remaining_pause, self.next_pause) =
            (remaining, next.clamp(FIRST_PAUSE, LONGEST_PAUSE));
    }

    /// Takes note of a trial that converged.
    pub fn succeeded(&mut self) {
        self.next_pause = FIRST_PAUSE;
    }

    /// Takes note of a trial that did not converge.
    pub fn failed(&mut self) {
        self.remaining_pause = self.next_pause;
        self.next_pause = (2 * self.next_pause).min(LONGEST_PAUSE);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_iterations_as_a_factorisation_pays_for() {
        for (factorisation, iterations) in [(0.5, 0), (1.0, 1), (6.9, 6), (1e9, MAX_ITERATIONS)] {
            let policy = ReusePolicy::from_costs(factorisation, 1.0);
            assert_eq!(policy.affordable_iterations(), iterations);
        }
    }

    #[test]
    fn pauses_grow_with_failures_and_end_with_a_success() {
        let mut policy = ReusePolicy::from_costs(10.0, 1.0);
        let far = 2.0 * NEAR;
        let mut pause_after = |converges: bool| {
            if converges {
                policy.succeeded()
            } else {
                policy.failed()
            }
            (0..).take_while(|_| !policy.is_worth_a_trial(far)).count()
        };
        let pauses = [false, false, false, true, false].map(&mut pause_after);
        assert_eq!(pauses, [2, 4, 8, 0, 2]);
        for _ in 0..20 {
            pause_after(false);
        }
        assert_eq!(pause_after(false), LONGEST_PAUSE);
    }

    #[test]
    fn what_is_nearly_solved_is_tried_during_a_pause() {
        let mut policy = ReusePolicy::from_costs(10.0, 1.0);
        policy.failed();
        assert!(policy.is_worth_a_trial(0.5 * NEAR));
        assert!(!policy.is_worth_a_trial(2.0 * NEAR));
    }
}
