//! `Gaps`: what contact asks of the surfaces of bodies and walls, whatever their dimension.

use std::fmt::Debug;

use nalgebra::DVector;
use serde::{Deserialize, Serialize};

use super::{ContactPair, Partner};
use crate::body::{Mode, Modes, Pose};

/// Part of the smallest gap that is left at least when bodies are put nearer to each other.
const KEPT_GAP: f64 = 0.5;
/// Smallest part of a displacement that is tried.
const SMALLEST_PART: f64 = 1e-6;

/// The smallest of all gaps.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MinimumGap {
    /// A body.
    pub body: usize,
    /// What it faces.
    pub partner: Partner,
    /// The gap (m), negative where they overlap.
    pub gap: f64,
}

/// Surfaces of bodies and walls, and where they are close with bodies in given poses.
pub trait Gaps: Debug + Send + Sync {
    /// Number of bodies.
    fn n_bodies(&self) -> usize;

    /// The motions that bodies have.
    fn modes(&self) -> Modes;

    /// Name of a body.
    fn body_name(&self, body: usize) -> &str;

    /// Name of a body or wall.
    fn partner_name(&self, partner: Partner) -> &str;

    /// No point of a body is farther from its centre of mass (m).
    fn reach(&self, body: usize) -> f64;

    /// Whether the surface of a body looks the same however it is turned about its centre of mass: contact
    /// exerts no torque on it, and its turns change no gap.
    fn is_round(&self, body: usize) -> bool;

    /// All close pairs of points with gaps below `range` (m); surfaces that overlap always have one
    /// with a gap of zero or less.
    fn pairs(&self, poses: &[Pose], range: f64) -> Vec<ContactPair>;

    /// The smallest gap of all bodies and walls, however large; `None` where nothing can meet, as
    /// for one body without walls.
    fn minimum_gap(&self, poses: &[Pose]) -> Option<MinimumGap>;

    /// The smallest gap (m) between two of these bodies, those on one pivot left out, however large;
    /// `None` where there are no such two.
    fn minimum_gap_among(&self, poses: &[Pose], bodies: &[usize]) -> Option<f64>;

    /// The fraction, at most 1, of the displacements between poses within which no body can get to
    /// the far side of another.
    fn max_step_fraction(&self, from: &[Pose], to: &[Pose]) -> f64 {
        self.max_part_of(from, &self.displacement_bounds(from, to))
    }

    /// The same of displacements from poses by which no point of a body moves farther than these lengths (m).
    fn max_part_of(&self, from: &[Pose], bounds: &[f64]) -> f64;

    /// The part of a displacement, at most 1, that leaves half of the smallest gap: halved as often as that asks for.
    /// `poses_at` gives the poses of all bodies after a part of it.
    fn part_that_keeps_open(&self, poses_at: &dyn Fn(f64) -> Vec<Pose>) -> f64 {
        largest_open_part(|part| {
            self.minimum_gap(&poses_at(part)).map_or(f64::INFINITY, |minimum| minimum.gap)
        })
    }

    /// Length by which a component of a motion of a body counts as a displacement: the reach (m) for
    /// rotations, one for translations.
    fn length(&self, body: usize, mode: Mode) -> f64 {
        if mode.is_rotation() { self.reach(body) } else { 1.0 }
    }

    /// Largest component of the displacements (m, rad) of some bodies, as that of a point: body by body, and of
    /// each body motion by motion. Not a number where one of them is not.
    fn largest_displacement(
        &self,
        bodies: &[usize],
        modes: Modes,
        displacements: &DVector<f64>,
    ) -> f64 {
        let rows = bodies.iter().flat_map(|&body| modes.iter().map(move |mode| (body, mode)));
        let sizes = rows
            .zip(displacements)
            .map(|((body, mode), displacement)| (displacement * self.length(body, mode)).abs());
        sizes.fold(0.0, |most, one| if one > most || one.is_nan() { one } else { most })
    }

    /// How far a point of a body moves at most between two poses (m).
    fn displacement_bound(&self, body: usize, from: &Pose, to: &Pose) -> f64 {
        let displacement = to.displacement_from(from);
        let [distance, turn] = [0, 3].map(|first| displacement.fixed_rows::<3>(first).norm());
        distance + turn * self.reach(body)
    }

    /// The same of all bodies.
    fn displacement_bounds(&self, from: &[Pose], to: &[Pose]) -> Vec<f64> {
        let bound = |body: usize| self.displacement_bound(body, &from[body], &to[body]);
        (0..self.n_bodies()).map(bound).collect()
    }

    /// The bodies that may come nearer than `range` (m) to anything when each moves from its pose
    /// in `from` no farther than `margin` times the displacement to that in `to`, ascending.
    fn candidate_bodies(&self, from: &[Pose], to: &[Pose], margin: f64, range: f64) -> Vec<usize> {
        self.candidates_within(from, &self.displacement_bounds(from, to), margin, range)
    }

    /// The same where each moves no farther than `margin` times one of these lengths (m).
    fn candidates_within(
        &self,
        from: &[Pose],
        bounds: &[f64],
        margin: f64,
        range: f64,
    ) -> Vec<usize> {
        let farthest = bounds.iter().map(|bound| margin * bound).fold(0.0, f64::max);
        let mut candidates = Vec::new();
        for pair in self.pairs(from, range + 2.0 * farthest) {
            candidates.push(pair.body);
            if let Partner::Body(other) = pair.partner {
                candidates.push(other);
            }
        }
        candidates.sort_unstable();
        candidates.dedup();
        candidates
    }
}

/// The largest part, at most 1, of a displacement that leaves half of the smallest gap (m) at its start: halved as often as
/// that asks for.
pub fn largest_open_part(gap_at: impl Fn(f64) -> f64) -> f64 {
    let kept = KEPT_GAP * gap_at(0.0);
    let mut part = 1.0;
    while gap_at(part) < kept && part > SMALLEST_PART {
        part *= 0.5;
    }
    part
}
