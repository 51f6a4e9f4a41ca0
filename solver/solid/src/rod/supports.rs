//! `Supports`: what holds the ends of a rod as a function of time.

use std::fmt;

use super::elastic::Rod;
use super::end::{End, Support};
use super::kinematics::Kinematics;
use crate::structure::Held;

/// How an end is held, and its pose P at a time (s).
pub struct HeldEnd<P> {
    /// Which end.
    pub end: End,
    /// How it is held.
    pub support: Support,
    /// Where, and with which rates.
    pub pose: Box<dyn Fn(f64) -> P + Send + Sync>,
}

impl<P> fmt::Debug for HeldEnd<P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("HeldEnd")
            .field("end", &self.end)
            .field("support", &self.support)
            .finish_non_exhaustive()
    }
}

/// The ends of a rod that are held.
#[derive(Debug)]
pub struct Supports<P>(pub Vec<HeldEnd<P>>);

impl<P> Supports<P> {
    /// Of a rod that moves freely.
    pub const FREE: Self = Self(Vec::new());

    /// One end that stays or moves as a function of time (s).
    pub fn one(
        end: End,
        support: Support,
        pose: impl Fn(f64) -> P + Send + Sync + 'static,
    ) -> Self {
        Self(vec![HeldEnd { end, support, pose: Box::new(pose) }])
    }

    /// A rod that is clamped where these clamp it.
    pub(super) fn clamp<K: Kinematics<N, S>, const N: usize, const S: usize>(
        &self,
        rod: Rod<K, N, S>,
    ) -> Rod<K, N, S> {
        let clamped = self.0.iter().filter(|held| held.support == Support::Clamped);
        clamped.fold(rod, |rod, held| rod.clamped(held.end))
    }

    /// The coordinates that are given at a time (s), ascending.
    pub(super) fn held(
        &self,
        time: f64,
        of_end: impl Fn(End, Support, &P) -> Vec<Held>,
    ) -> Vec<Held> {
        let given = |at: &HeldEnd<P>| of_end(at.end, at.support, &(at.pose)(time));
        let mut held: Vec<Held> = self.0.iter().flat_map(given).collect();
        held.sort_by_key(|given| given.coordinate);
        held
    }
}
