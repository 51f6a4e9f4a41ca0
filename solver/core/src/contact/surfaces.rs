//! `Surfaces`: outlines of all bodies and walls, and where they are close at given places.

use alewife_mesh::{
    Closest, Domain, Outline, PlacedShape, Point, Wall, closest, closest_features, closest_to_wall,
    on_meridian, thickness, wall_features,
};
use nalgebra::Rotation2;

use super::feature::weigh;
use super::{ContactError, Feature, Partner, Place};

/// A body's outline in its own frame.
#[derive(Debug, Clone)]
struct Surface {
    name: String,
    outline: Outline,
    /// Centre of mass in the body's own frame (m).
    centroid: Point<2>,
    /// No point is farther from the centre of mass (m).
    reach: f64,
    thickness: f64,
}

/// Outlines and walls that may come into contact.
#[derive(Debug, Clone)]
pub struct Surfaces {
    bodies: Vec<Surface>,
    /// Number, name and shape of each side that is a wall.
    walls: Vec<(usize, &'static str, Wall)>,
    /// Periods along x and y (m).
    periods: [Option<f64>; 2],
    is_axisymmetric: bool,
    /// Pairs of bodies on one pivot, the smaller number first: they are always close.
    joined: Vec<(usize, usize)>,
}

/// The smallest of all gaps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeastGap {
    /// A body.
    pub body: usize,
    /// What it faces.
    pub partner: Partner,
    /// The gap (m), negative where they overlap.
    pub gap: f64,
}

impl Surfaces {
    /// Outlines of bodies and the sides of a domain that are walls; places do not count.
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
                .map(|(name, wall)| (side, name, wall))
                .ok_or(ContactError::NoWall { side })
        });
        let bodies = bodies.iter().map(|body| {
            let outline = Outline::new(body)?;
            let centroid = body.shape.moments().map_or(Point::<2>::zeros(), |m| m.centroid);
            let (reach, thickness) = (outline.reach() + centroid.norm(), thickness(&outline));
            Ok(Surface { name: body.name.clone(), outline, centroid, reach, thickness })
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
            joined: Vec::new(),
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
    pub fn with_joined(mut self, pairs: impl Iterator<Item = (usize, usize)>) -> Self {
        self.joined = pairs.map(|(one, other)| (one.min(other), one.max(other))).collect();
        self
    }

    /// Number of bodies.
    #[must_use]
    pub fn n_bodies(&self) -> usize {
        self.bodies.len()
    }

    /// No point of a body is farther from its centre of mass (m).
    #[must_use]
    pub fn reach(&self, body: usize) -> f64 {
        self.bodies[body].reach
    }

    /// Name of a body.
    #[must_use]
    pub fn body_name(&self, body: usize) -> &str {
        &self.bodies[body].name
    }

    /// Name of a body or wall.
    #[must_use]
    pub fn partner_name(&self, partner: Partner) -> &str {
        match partner {
            Partner::Body(body) => self.body_name(body),
            Partner::Wall(side) => {
                let wall = self.walls.iter().find(|(known, ..)| *known == side);
                wall.map_or("", |(_, name, _)| name)
            }
        }
    }

    /// All places where bodies are nearer than `range` (m) to each other or to walls, with bodies
    /// at `places`; overlapping bodies always have one with a gap of zero or less.
    ///
    /// Order: bodies, then images, then the first outline's parameter; walls last.
    #[must_use]
    pub fn features(&self, places: &[Place], range: f64) -> Vec<Feature> {
        let outlines = self.outlines(places);
        let mut features: Vec<Feature> = Vec::new();
        let mut add = |body: usize, partner: Partner, away: Point<2>, found: Vec<Closest>| {
            let found = if self.is_axisymmetric { on_meridian(found) } else { found };
            let mut size = self.bodies[body].outline.reach();
            if let Partner::Body(other) = partner {
                size = size.min(self.bodies[other].outline.reach());
            }
            let first = features.len();
            features.extend(found.into_iter().map(|at| {
                let lever = at.first - center(&places[body]);
                let other = match partner {
                    Partner::Body(other) => at.second - away - center(&places[other]),
                    Partner::Wall(_) => Point::<2>::zeros(),
                };
                let (levers, is_axisymmetric) = ([lever, other], self.is_axisymmetric);
                Feature { body, partner, at, levers, weight: 1.0, is_axisymmetric }
            }));
            weigh(&mut features[first..], size, range);
        };
        for (body, outline) in outlines.iter().enumerate() {
            for other in body..outlines.len() {
                if self.joined.contains(&(body, other)) {
                    continue;
                }
                for away in self.images(places, body, other) {
                    let image =
                        shifted(&outlines[other], &self.bodies[other], &places[other], away);
                    let found = closest_features(outline, &image, range);
                    add(body, Partner::Body(other), away, found);
                }
            }
            for (side, _, wall) in &self.walls {
                let found = wall_features(outline, wall, range);
                add(body, Partner::Wall(*side), Point::<2>::zeros(), found);
            }
        }
        features
    }

    /// The smallest gap of all bodies and walls, however large; `None` for one body without walls.
    #[must_use]
    pub fn least_gap(&self, places: &[Place]) -> Option<LeastGap> {
        let outlines = self.outlines(places);
        let mut least: Option<LeastGap> = None;
        let mut offer = |body: usize, partner: Partner, bound: f64, gap: &dyn Fn() -> f64| {
            if least.is_some_and(|least| least.gap <= bound) {
                return;
            }
            let gap = gap();
            if least.is_none_or(|least| gap < least.gap) {
                least = Some(LeastGap { body, partner, gap });
            }
        };
        for (body, outline) in outlines.iter().enumerate() {
            for other in body..outlines.len() {
                if self.joined.contains(&(body, other)) {
                    continue;
                }
                for away in self.images(places, body, other) {
                    let image =
                        shifted(&outlines[other], &self.bodies[other], &places[other], away);
                    let bound = outline.least_gap(image.center()) - image.reach();
                    let gap = || closest(outline, &image).gap;
                    offer(body, Partner::Body(other), bound, &gap);
                }
            }
            for (side, _, wall) in &self.walls {
                let bound = wall.gap(outline.center()) - outline.reach();
                let gap = || closest_to_wall(outline, wall).gap;
                offer(body, Partner::Wall(*side), bound, &gap);
            }
        }
        least
    }

    /// The bodies that may come nearer than `range` (m) to anything when each moves from `from` to
    /// somewhere no farther than `margin` times its way to `to`, ascending.
    #[must_use]
    pub fn involved(&self, from: &[Place], to: &[Place], margin: f64, range: f64) -> Vec<usize> {
        let ways = (0..self.n_bodies()).map(|body| margin * self.way(body, &from[body], &to[body]));
        let farthest = ways.fold(0.0, f64::max);
        let mut involved = Vec::new();
        for feature in self.features(from, range + 2.0 * farthest) {
            involved.push(feature.body);
            if let Partner::Body(other) = feature.partner {
                involved.push(other);
            }
        }
        involved.sort_unstable();
        involved.dedup();
        involved
    }

    /// How far a point of a body moves at most between two places (m).
    pub(super) fn way(&self, body: usize, from: &Place, to: &Place) -> f64 {
        (center(to) - center(from)).norm() + (to[2] - from[2]).abs() * self.bodies[body].reach
    }

    /// The part of the ways between places which no body can take to the far side of another.
    ///
    /// Half the thickness of the thinner body; walls are half planes, which cannot be crossed.
    pub(super) fn passable(&self, from: &[Place], to: &[Place]) -> f64 {
        let ways: Vec<f64> =
            (0..self.n_bodies()).map(|body| self.way(body, &from[body], &to[body])).collect();
        let mut part = 1.0f64;
        for body in 0..self.n_bodies() {
            for other in body..self.n_bodies() {
                let (one, two) = (&self.bodies[body], &self.bodies[other]);
                let way = ways[body] + ways[other];
                let near = self.images(from, body, other).into_iter().any(|away| {
                    let between = center(&from[body]) - center(&from[other]) - away;
                    between.norm() < one.reach + two.reach + way
                });
                if near && way > 0.0 {
                    part = part.min(0.5 * one.thickness.min(two.thickness) / way);
                }
            }
        }
        part
    }

    fn outlines(&self, places: &[Place]) -> Vec<Outline> {
        let at = |(surface, place): (&Surface, &Place)| {
            shifted(&surface.outline, surface, place, Point::<2>::zeros())
        };
        self.bodies.iter().zip(places).map(at).collect()
    }

    /// Vectors by which the second body stands beside itself where the first may meet it (m).
    fn images(&self, places: &[Place], body: usize, other: usize) -> Vec<Point<2>> {
        let between = center(&places[body]) - center(&places[other]);
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
}

fn center(place: &Place) -> Point<2> {
    Point::<2>::new(place[0], place[1])
}

/// The outline of a body whose centre of mass is at a place, moved away by a vector (m).
fn shifted(outline: &Outline, body: &Surface, place: &Place, away: Point<2>) -> Outline {
    let offset = Rotation2::new(place[2]) * body.centroid;
    outline.placed_at(center(place) - offset + away, place[2])
}
