//! `Episode`: what an environment remembers besides the motion: its random numbers, targets, the last action.

use super::reason::Reason;
use crate::case::SplitMix64;

/// An episode, and what the next ones are drawn from.
pub(super) struct Episode {
    pub random: SplitMix64,
    /// Number of the sample of the case.
    pub sample: usize,
    pub targets: Box<[f64]>,
    /// The last action, clipped.
    pub action: Box<[f64]>,
    pub n_decisions: usize,
    pub reason: Reason,
}

impl Episode {
    /// None yet, by a seed.
    pub fn new(n_targets: usize, n_actions: usize, seed: u64) -> Self {
        Self {
            random: SplitMix64(mixed(seed)),
            sample: 0,
            targets: vec![0.0; n_targets].into(),
            action: vec![0.0; n_actions].into(),
            n_decisions: 0,
            reason: Reason::End,
        }
    }

    /// Draws from a seed from now on.
    pub fn seed(&mut self, seed: u64) {
        self.random = SplitMix64(mixed(seed));
    }

    pub fn is_over(&self) -> bool {
        self.reason != Reason::Goes
    }

    /// Takes over an action, clipped to -1 and 1.
    pub fn act(&mut self, action: &[f64]) {
        for (own, value) in self.action.iter_mut().zip(action) {
            *own = value.clamp(-1.0, 1.0);
        }
        self.n_decisions += 1;
    }
}

/// Neighbouring seeds as numbers far from each other (@steele2014).
fn mixed(seed: u64) -> u64 {
    let z = (seed ^ (seed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
