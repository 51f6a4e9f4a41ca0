//! `PlanarGaps`: outlines of all bodies and walls, and where they are close.

use std::collections::HashSet;

use alewife_mesh::{Domain, Outline, PlacedShape, Point, Wall, on_meridian, thickness};
use nalgebra::{Rotation2, Vector3};

use super::broad_phase::{BroadPhase, Circle};
use super::encounter::{Encounter, Surface};
use super::pair::blend_weights;
use super::{ContactError, ContactPair, Curvatures, Gaps, MinimumGap, Partner};
use crate::body::{Modes, Pose};

/// Bodies up to which all gaps are looked at to find the smallest one.
const FEW_BODIES: usize = 16;

/// A body's outline in its own frame.
#[derive(Debug, Clone)]
struct BodyOutline {
    name: String,
    outline: Outline,
    /// Centre of mass in the body's own frame (m).
    centroid: Point<2>,
    /// No point is farther from the centre of mass (m).
    reach: f64,
    thickness: f64,
}

/// A side of the domain that is a wall.
#[derive(Debug, Clone)]
struct WallSide {
    side: usize,
    name: &'static str,
    wall: Wall,
}

/// Outlines and walls that may come into contact; the exact curves, in the plane or on the axis.
#[derive(Debug, Clone)]
pub struct PlanarGaps {
    bodies: Vec<BodyOutline>,
    walls: Vec<WallSide>,
    /// Periods along x and y (m).
    periods: [Option<f64>; 2],
    is_axisymmetric: bool,
    /// Pairs of bodies on one pivot, the smaller number first: they are always close.
    joined: HashSet<[usize; 2]>,
}

impl PlanarGaps {
    /// Outlines of bodies and the sides of a domain that are walls; the poses of the shapes do not
    /// count.
    ///
    /// # Errors
    /// [`ContactError::Outline`] for a shape without outline, [`ContactError::NoWall`] for a side
    /// that is the axis or periodic.
    pub fn new(
        domain: &Domain,
        walls: &[usize],
        bodies: &[PlacedShape],
    ) -> Result<Self, ContactError> {
        let walls = walls.iter().map(|&side| {
            let name = domain.sides().get(side).copied();
            let wall = name.and_then(|_| domain.wall(side));
            name.zip(wall)
                .map(|(name, wall)| WallSide { side, name, wall })
                .ok_or(ContactError::NoWall { side })
        });
        let bodies = bodies.iter().map(|body| {
            let outline = Outline::new(body)?;
            let centroid = body.shape.moments().map_or(Point::<2>::zeros(), |m| m.centroid);
            let (reach, thickness) = (outline.reach() + centroid.norm(), thickness(&outline));
            Ok(BodyOutline { name: body.name.clone(), outline, centroid, reach, thickness })
        });
        let longest = |axis: usize| {
            let lengths = domain.images().into_iter().map(|image| image[axis]);
            Some(lengths.fold(0.0, f64::max)).filter(|length| *length > 0.0)
        };
        Ok(Self {
            bodies: bodies.collect::<Result<_, ContactError>>()?,
            walls: walls.collect::<Result<_, _>>()?,
            periods: [longest(0), longest(1)],
            is_axisymmetric: domain.is_axisymmetric(),
            joined: HashSet::new(),
        })
    }

    /// Gives a body another outline, its origin the centre of mass.
    pub fn deform(&mut self, body: usize, outline: Outline) {
        let surface = &mut self.bodies[body];
        (surface.reach, surface.thickness) = (outline.reach(), thickness(&outline));
        (surface.outline, surface.centroid) = (outline, Point::<2>::zeros());
    }

    /// Leaves the gaps of pairs of bodies that share a pivot out of account.
    #[must_use]
    pub fn with_joined(mut self, pairs: impl Iterator<Item = [usize; 2]>) -> Self {
        self.joined = pairs.map(|[one, other]| [one.min(other), one.max(other)]).collect();
        self
    }

    /// The outlines of all bodies in their poses.
    fn outlines(&self, poses: &[Pose]) -> Vec<Outline> {
        let unmoved = Point::<2>::zeros();
        self.bodies.iter().zip(poses).map(|(body, pose)| body.outline_at(pose, unmoved)).collect()
    }

    /// Vectors by which the second body stands beside itself where the first may meet it (m).
    fn images(&self, poses: &[Pose], body: usize, other: usize) -> Vec<Point<2>> {
        let between = center(&poses[body]) - center(&poses[other]);
        let steps = |axis: usize| match self.periods[axis] {
            None => vec![0.0],
            Some(length) => {
                let near = (between[axis] / length).round();
                [near, near + 1.0, near - 1.0].map(|k| k * length).to_vec()
            }
        };
        let mut images = Vec::new();
        for y in steps(1) {
            images.extend(steps(0).iter().map(|x| Point::<2>::new(*x, y)));
        }
        // A body meets its own images on one side only: the other side is the same contact
        images.retain(|away| body != other || away.y > 0.0 || (away.y == 0.0 && away.x > 0.0));
        images
    }

    fn are_joined(&self, body: usize, other: usize) -> bool {
        self.joined.contains(&[body, other])
    }

    /// For each body those from it on that may be nearer than `range` (m), itself among them.
    fn neighbours(&self, outlines: &[Outline], range: f64) -> Vec<Vec<usize>> {
        let circle =
            |outline: &Outline| Circle { center: outline.center(), radius: outline.reach() };
        let phase = BroadPhase::new(outlines.iter().map(circle).collect(), self.periods);
        (0..outlines.len()).map(|body| phase.neighbours(body, range)).collect()
    }

    /// Visits each body with its neighbours, which are given, and then with the walls.
    fn for_each_encounter(
        &self,
        poses: &[Pose],
        outlines: &[Outline],
        neighbours: &[Vec<usize>],
        mut visit: impl FnMut(&Encounter<'_>),
    ) {
        for (body, outline) in outlines.iter().enumerate() {
            for &other in neighbours[body].iter().filter(|other| !self.are_joined(body, **other)) {
                let partner = Partner::Body(other);
                for away in self.images(poses, body, other) {
                    let surface =
                        Surface::Outline(self.bodies[other].outline_at(&poses[other], away));
                    visit(&Encounter { body, outline, partner, away, surface });
                }
            }
            for WallSide { side, wall, .. } in &self.walls {
                let (partner, away) = (Partner::Wall(*side), Point::<2>::zeros());
                visit(&Encounter { body, outline, partner, away, surface: Surface::Wall(wall) });
            }
        }
    }

    /// The smallest gap, those between bodies farther apart than `range` (m) left out.
    fn minimum_gap_within(
        &self,
        poses: &[Pose],
        outlines: &[Outline],
        range: f64,
    ) -> Option<MinimumGap> {
        let neighbours = self.neighbours(outlines, range);
        let mut least: Option<MinimumGap> = None;
        self.for_each_encounter(poses, outlines, &neighbours, |met| {
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
        met: &Encounter<'_>,
        range: f64,
    ) {
        let Encounter { body, partner, away, .. } = *met;
        let points = met.features(range);
        let points = if self.is_axisymmetric { on_meridian(points) } else { points };
        let mut size = self.bodies[body].outline.reach();
        if let Partner::Body(other) = partner {
            size = size.min(self.bodies[other].outline.reach());
        }
        let first = pairs.len();
        pairs.extend(points.into_iter().map(|at| {
            let lever = at.first - center(&poses[body]);
            let other = match partner {
                Partner::Body(other) => at.second - away - center(&poses[other]),
                Partner::Wall(_) => Point::<2>::zeros(),
            };
            ContactPair {
                body,
                partner,
                gap: at.gap,
                normal: in_space(at.normal),
                levers: [lever, other].map(in_space),
                curvatures: Curvatures::Curves(at.curvatures),
                weight: 1.0,
                modes: self.modes(),
            }
        }));
        blend_weights(&mut pairs[first..], size, range);
    }
}

impl Gaps for PlanarGaps {
    fn n_bodies(&self) -> usize {
        self.bodies.len()
    }

    fn modes(&self) -> Modes {
        if self.is_axisymmetric { Modes::AXISYMMETRIC } else { Modes::PLANAR }
    }

    fn body_name(&self, body: usize) -> &str {
        &self.bodies[body].name
    }

    fn partner_name(&self, partner: Partner) -> &str {
        match partner {
            Partner::Body(body) => self.body_name(body),
            Partner::Wall(side) => {
                let wall = self.walls.iter().find(|wall| wall.side == side);
                wall.map_or("", |wall| wall.name)
            }
        }
    }

    fn reach(&self, body: usize) -> f64 {
        self.bodies[body].reach
    }

    /// Order: bodies, then images, then the first outline's parameter; walls of a body last.
    fn pairs(&self, poses: &[Pose], range: f64) -> Vec<ContactPair> {
        let outlines = self.outlines(poses);
        let neighbours = self.neighbours(&outlines, range);
        let mut pairs = Vec::new();
        self.for_each_encounter(poses, &outlines, &neighbours, |met| {
            self.append(&mut pairs, poses, met, range);
        });
        pairs
    }

    fn minimum_gap(&self, poses: &[Pose]) -> Option<MinimumGap> {
        let outlines = self.outlines(poses);
        let smallest = self.bodies.iter().map(|body| body.reach).fold(f64::INFINITY, f64::min);
        let near = if outlines.len() > FEW_BODIES { smallest } else { f64::INFINITY };
        // No gap beyond the range is below one within it
        for range in [near, 4.0 * near, 16.0 * near] {
            let least = self.minimum_gap_within(poses, &outlines, range);
            if least.is_some_and(|least| least.gap <= range) {
                return least;
            }
        }
        self.minimum_gap_within(poses, &outlines, f64::INFINITY)
    }

    fn minimum_gap_among(&self, poses: &[Pose], bodies: &[usize]) -> Option<f64> {
        let unmoved = Point::<2>::zeros();
        let mut least: Option<f64> = None;
        for (nth, &one) in bodies.iter().enumerate() {
            let outline = self.bodies[one].outline_at(&poses[one], unmoved);
            let is_apart = |other: &&usize| !self.are_joined(one.min(**other), one.max(**other));
            for &other in bodies[nth + 1..].iter().filter(is_apart) {
                for away in self.images(poses, one, other) {
                    let surface =
                        Surface::Outline(self.bodies[other].outline_at(&poses[other], away));
                    let partner = Partner::Body(other);
                    let met = Encounter { body: one, outline: &outline, partner, away, surface };
                    if least.is_none_or(|least| met.gap_bound() < least) {
                        let gap = met.gap();
                        least = Some(least.map_or(gap, |least| least.min(gap)));
                    }
                }
            }
        }
        least
    }

    /// Half the thickness of the thinner body; walls are half planes, which cannot be crossed.
    fn max_step_fraction(&self, from: &[Pose], to: &[Pose]) -> f64 {
        let bounds: Vec<f64> = (0..self.n_bodies())
            .map(|body| self.displacement_bound(body, &from[body], &to[body]))
            .collect();
        let circle = |body: usize| Circle {
            center: center(&from[body]),
            radius: self.bodies[body].reach + bounds[body],
        };
        let circles = (0..self.n_bodies()).map(circle).collect();
        let phase = BroadPhase::new(circles, self.periods);
        let mut fraction = 1.0f64;
        for body in 0..self.n_bodies() {
            for other in phase.neighbours(body, 0.0) {
                let (one, two) = (&self.bodies[body], &self.bodies[other]);
                let both = bounds[body] + bounds[other];
                let near = self.images(from, body, other).into_iter().any(|away| {
                    let between = center(&from[body]) - center(&from[other]) - away;
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

impl BodyOutline {
    /// The outline of the body in a pose, moved away by a vector (m).
    fn outline_at(&self, pose: &Pose, away: Point<2>) -> Outline {
        let angle = pose.angle();
        let offset = Rotation2::new(angle) * self.centroid;
        self.outline.placed_at(center(pose) - offset + away, angle)
    }
}

fn center(pose: &Pose) -> Point<2> {
    Point::<2>::new(pose.center.x, pose.center.y)
}

fn in_space(vector: Point<2>) -> Vector3<f64> {
    Vector3::new(vector.x, vector.y, 0.0)
}

#[cfg(test)]
mod tests;
