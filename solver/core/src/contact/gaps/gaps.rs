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
    fn max_step_fraction(&self, from: &[Pose], to: &[Pose]) -> f64;

    /// The part of a displacement, at most 1, that leaves half of the smallest gap: halved as often as that asks for.
    /// `poses_at` gives the poses of all bodies after a part of it.
    fn part_that_keeps_open(&self, poses_at: &dyn Fn(f64) -> Vec<Pose>) -> f64 {
        let gap_at = |part: f64| {
            self.minimum_gap(&poses_at(part)).map_or(f64::INFINITY, |minimum| minimum.gap)
        };
        let kept = KEPT_GAP * gap_at(0.0);
        let mut part = 1.0;
        while gap_at(part) < kept && part > SMALLEST_PART {
            part *= 0.5;
        }
        part
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

    /// The bodies that may come nearer than `range` (m) to anything when each moves from its pose
    /// in `from` no farther than `margin` times the displacement to that in `to`, ascending.
    fn candidate_bodies(&self, from: &[Pose], to: &[Pose], margin: f64, range: f64) -> Vec<usize> {
        let bounds = (0..self.n_bodies())
            .map(|body| margin * self.displacement_bound(body, &from[body], &to[body]));
        let farthest = bounds.fold(0.0, f64::max);
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
