//! `SurfaceGaps`: the surfaces of all bodies and walls, and where they are close.

use std::collections::HashSet;
use std::sync::Arc;

use alewife_mesh::Point;
use nalgebra::Vector3;

use super::broad_phase::{Ball, BroadPhase, combinations};
use super::encounter::{Encounter, Facing};
use super::pair::blend_weights;
use super::surface::ContactSurface;
use super::{ContactPair, Gaps, MinimumGap, Partner, Section, Sections};
use crate::body::{Modes, Pose, in_space, on_mesh};

/// Bodies up to which all gaps are looked at to find the smallest one.
const FEW_BODIES: usize = 16;

/// Distance of the centre of a round body from its centre of mass over its radius that is rounding.
const ROUNDING: f64 = 1e-12;

/// A body's surface in its own frame.
#[derive(Debug, Clone)]
pub(super) struct BodySolid<const D: usize, S> {
    name: String,
    surface: S,
    /// Centre of mass in the frame of the surface (m).
    centroid: Point<D>,
    /// No point is farther from the centre of mass (m).
    reach: f64,
    thickness: f64,
    /// What its points move with, of a body with coordinates.
    sections: Option<Arc<dyn Sections>>,
}

/// A side of the domain that is a wall.
#[derive(Debug, Clone)]
pub(super) struct WallSide<W> {
    /// Its number.
    pub side: usize,
    /// Its name.
    pub name: String,
    /// Its surface.
    pub wall: W,
}

/// Surfaces of bodies and walls that may come into contact, exactly.
#[derive(Debug, Clone)]
pub struct SurfaceGaps<const D: usize, S: ContactSurface<D>> {
    bodies: Vec<BodySolid<D, S>>,
    walls: Vec<WallSide<S::Wall>>,
    /// Lengths after which the domain repeats (m).
    periods: [Option<f64>; D],
    modes: Modes,
    /// Pairs of bodies that share a pivot, the smaller number first: they are always close.
    joined: HashSet<[usize; 2]>,
}

impl<const D: usize, S: ContactSurface<D>> BodySolid<D, S> {
    /// A body with its surface, the centre of mass in the frame of that (m).
    pub(super) fn new(name: String, surface: S, centroid: Point<D>) -> Self {
        let (reach, thickness) = (surface.reach() + centroid.norm(), surface.thickness());
        Self { name, surface, centroid, reach, thickness, sections: None }
    }

    /// The surface with the body in a pose, moved away by a vector (m).
    fn placed(&self, pose: &Pose, away: &Point<D>) -> S {
        self.surface.placed(pose, &self.centroid, away)
    }
}

impl<const D: usize, S: ContactSurface<D>> SurfaceGaps<D, S> {
    /// Bodies that move in these modes, in a domain that repeats after these lengths (m).
    pub(super) fn of(
        bodies: Vec<BodySolid<D, S>>,
        walls: Vec<WallSide<S::Wall>>,
        periods: [Option<f64>; D],
        modes: Modes,
    ) -> Self {
        Self { bodies, walls, periods, modes, joined: HashSet::new() }
    }

    /// Gives a body another surface, its origin the centre of mass.
    pub fn deform(&mut self, body: usize, surface: S) {
        let name = std::mem::take(&mut self.bodies[body].name);
        self.bodies[body] = BodySolid::new(name, surface, Point::zeros());
    }

    /// Gives a body with coordinates another surface, as [`Self::deform`] does, whose points move with sections: its thickness
    /// stays what it was.
    pub fn bend(&mut self, body: usize, surface: S, sections: Arc<dyn Sections>) {
        let bent = &mut self.bodies[body];
        bent.reach = surface.reach();
        (bent.surface, bent.centroid) = (surface, Point::zeros());
        bent.sections = Some(sections);
    }

    /// What moves with a point of a body in a pose, from its centre of mass (m).
    fn section(&self, body: usize, pose: &Pose, lever: &Vector3<f64>) -> Option<Section> {
        let sections = self.bodies[body].sections.as_ref()?;
        Some(sections.at(&pose.to_body(lever))?.seen_from(pose))
    }

    /// Leaves the gaps of pairs of bodies that share a pivot out of account.
    #[must_use]
    pub fn with_joined(mut self, pairs: impl Iterator<Item = [usize; 2]>) -> Self {
        self.joined = pairs.map(|[one, other]| [one.min(other), one.max(other)]).collect();
        self
    }

    /// The surfaces of all bodies in their poses.
    fn surfaces(&self, poses: &[Pose]) -> Vec<S> {
        let unmoved = Point::zeros();
        self.bodies.iter().zip(poses).map(|(body, pose)| body.placed(pose, &unmoved)).collect()
    }

    /// Vectors by which the second body stands beside itself where the first may meet it (m).
    fn images(&self, poses: &[Pose], body: usize, other: usize) -> Vec<Point<D>> {
        let between = center::<D>(&poses[body]) - center(&poses[other]);
        let steps = std::array::from_fn(|axis| match self.periods[axis] {
            None => vec![0.0],
            Some(length) => {
                let near = (between[axis] / length).round();
                [near, near + 1.0, near - 1.0].map(|k| k * length).to_vec()
            }
        });
        let mut images = combinations(&steps);
        // A body meets its own images on one side only: the other side is the same contact
        let is_ahead = |away: &Point<D>| {
            away.iter().rev().find(|along| **along != 0.0).is_some_and(|along| *along > 0.0)
        };
        images.retain(|away| body != other || is_ahead(away));
        images
    }

    fn are_joined(&self, body: usize, other: usize) -> bool {
        self.joined.contains(&[body, other])
    }

    /// For each body those from it on that may be nearer than `range` (m), itself among them.
    fn neighbours(&self, surfaces: &[S], range: f64) -> Vec<Vec<usize>> {
        let ball = |surface: &S| Ball { center: surface.center(), radius: surface.reach() };
        let phase = BroadPhase::new(surfaces.iter().map(ball).collect(), self.periods);
        (0..surfaces.len()).map(|body| phase.neighbours(body, range)).collect()
    }

    /// Visits each body with its neighbours, which are given, and then with the walls.
    fn for_each_encounter(
        &self,
        poses: &[Pose],
        surfaces: &[S],
        neighbours: &[Vec<usize>],
        mut visit: impl FnMut(&Encounter<'_, D, S>),
    ) {
        for (body, surface) in surfaces.iter().enumerate() {
            for &other in neighbours[body].iter().filter(|other| !self.are_joined(body, **other)) {
                let partner = Partner::Body(other);
                for away in self.images(poses, body, other) {
                    let facing = Facing::Body(self.bodies[other].placed(&poses[other], &away));
                    visit(&Encounter { body, surface, partner, away, facing });
                }
            }
            for WallSide { side, wall, .. } in &self.walls {
                let (partner, away) = (Partner::Wall(*side), Point::zeros());
                visit(&Encounter { body, surface, partner, away, facing: Facing::Wall(wall) });
            }
        }
    }

    /// The smallest gap, those between bodies farther apart than `range` (m) left out.
    fn minimum_gap_within(&self, poses: &[Pose], surfaces: &[S], range: f64) -> Option<MinimumGap> {
        let neighbours = self.neighbours(surfaces, range);
        let mut least: Option<MinimumGap> = None;
        self.for_each_encounter(poses, surfaces, &neighbours, |met| {
            if least.is_some_and(|least| least.gap <= met.gap_bound()) {
                return;
            }
            let gap = met.gap();
            if least.is_none_or(|least| gap < least.gap) {
                least = Some(MinimumGap { body: met.body, partner: met.partner, gap });
            }
        });
        least
    }

    /// Appends the close pairs of points of a body and its partner with gaps below `range` (m).
    fn append(
        &self,
        pairs: &mut Vec<ContactPair>,
        poses: &[Pose],
        met: &Encounter<'_, D, S>,
        range: f64,
    ) {
        let Encounter { body, partner, away, .. } = *met;
        let mut size = self.bodies[body].surface.reach();
        if let Partner::Body(other) = partner {
            size = size.min(self.bodies[other].surface.reach());
        }
        let first = pairs.len();
        pairs.extend(met.points(range).into_iter().map(|at| {
            let lever = at.first - poses[body].center;
            let (other, other_section) = match partner {
                Partner::Body(other) => {
                    let lever = at.second - in_space(&away) - poses[other].center;
                    (lever, self.section(other, &poses[other], &lever))
                }
                Partner::Wall(_) => (Vector3::zeros(), None),
            };
            ContactPair {
                body,
                partner,
                gap: at.gap,
                normal: at.normal,
                levers: [lever, other],
                sections: [self.section(body, &poses[body], &lever), other_section],
                curvatures: at.curvatures,
                weight: 1.0,
                modes: self.modes,
            }
        }));
        blend_weights(&mut pairs[first..], size, range);
    }
}

impl<const D: usize, S: ContactSurface<D>> Gaps for SurfaceGaps<D, S> {
    fn n_bodies(&self) -> usize {
        self.bodies.len()
    }

    fn modes(&self) -> Modes {
        self.modes
    }

    fn body_name(&self, body: usize) -> &str {
        &self.bodies[body].name
    }

    fn partner_name(&self, partner: Partner) -> &str {
        match partner {
            Partner::Body(body) => self.body_name(body),
            Partner::Wall(side) => {
                let wall = self.walls.iter().find(|wall| wall.side == side);
                wall.map_or("", |wall| &wall.name)
            }
        }
    }

    fn reach(&self, body: usize) -> f64 {
        self.bodies[body].reach
    }

    fn is_round(&self, body: usize) -> bool {
        let BodySolid { surface, centroid, .. } = &self.bodies[body];
        surface.is_round() && centroid.norm() <= ROUNDING * surface.reach()
    }

    /// Order: bodies, then images, then the points of the first surface; walls of a body last.
    fn pairs(&self, poses: &[Pose], range: f64) -> Vec<ContactPair> {
        let surfaces = self.surfaces(poses);
        let neighbours = self.neighbours(&surfaces, range);
        let mut pairs = Vec::new();
        self.for_each_encounter(poses, &surfaces, &neighbours, |met| {
            self.append(&mut pairs, poses, met, range);
        });
        pairs
    }

    fn minimum_gap(&self, poses: &[Pose]) -> Option<MinimumGap> {
        let surfaces = self.surfaces(poses);
        let smallest = self.bodies.iter().map(|body| body.reach).fold(f64::INFINITY, f64::min);
        let near = if surfaces.len() > FEW_BODIES { smallest } else { f64::INFINITY };
        // No gap beyond the range is below one within it
        for range in [near, 4.0 * near, 16.0 * near] {
            let least = self.minimum_gap_within(poses, &surfaces, range);
            if least.is_some_and(|least| least.gap <= range) {
                return least;
            }
        }
        self.minimum_gap_within(poses, &surfaces, f64::INFINITY)
    }

    fn minimum_gap_among(&self, poses: &[Pose], bodies: &[usize]) -> Option<f64> {
        let unmoved = Point::zeros();
        let mut least: Option<f64> = None;
        for (nth, &one) in bodies.iter().enumerate() {
            let surface = self.bodies[one].placed(&poses[one], &unmoved);
            let is_apart = |other: &&usize| !self.are_joined(one.min(**other), one.max(**other));
            for &other in bodies[nth + 1..].iter().filter(is_apart) {
                for away in self.images(poses, one, other) {
                    let facing = Facing::Body(self.bodies[other].placed(&poses[other], &away));
                    let partner = Partner::Body(other);
                    let met = Encounter { body: one, surface: &surface, partner, away, facing };
                    if least.is_none_or(|least| met.gap_bound() < least) {
                        let gap = met.gap();
                        least = Some(least.map_or(gap, |least| least.min(gap)));
                    }
                }
            }
        }
        least
    }

    /// Half the thickness of the thinner body; walls end the domain and cannot be crossed.
    fn max_part_of(&self, from: &[Pose], bounds: &[f64]) -> f64 {
        let ball = |body: usize| Ball {
            center: center(&from[body]),
            radius: self.bodies[body].reach + bounds[body],
        };
        let balls = (0..self.n_bodies()).map(ball).collect();
        let phase = BroadPhase::new(balls, self.periods);
        let mut fraction = 1.0f64;
        for body in 0..self.n_bodies() {
            for other in phase.neighbours(body, 0.0) {
                let (one, two) = (&self.bodies[body], &self.bodies[other]);
                let both = bounds[body] + bounds[other];
                let near = self.images(from, body, other).into_iter().any(|away| {
                    let between = center::<D>(&from[body]) - center(&from[other]) - away;
                    between.norm() < one.reach + two.reach + both
                });
                if near && both > 0.0 {
                    fraction = fraction.min(0.5 * one.thickness.min(two.thickness) / both);
                }
            }
        }
        fraction
    }
}

fn center<const D: usize>(pose: &Pose) -> Point<D> {
    on_mesh(&pose.center)
}

#[cfg(test)]
mod tests;
