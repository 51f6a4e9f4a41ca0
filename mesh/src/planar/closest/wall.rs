//! `Wall`: a side of the domain that bodies cannot pass, and where an outline comes close to it.

use super::arc::{Arc, Circle, Range, angle_between, apart, wrapped};
use super::closest_points::Closest;
use crate::planar::vector::cross;
use crate::{Domain, Outline, Point};

/// A wall with the fluid on one side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Wall {
    /// A straight wall.
    Line {
        /// A point on it (m).
        point: Point<2>,
        /// Unit normal into the fluid.
        normal: Point<2>,
    },
    /// A circle, or the meridian of a ball, with the fluid inside.
    Circle {
        /// Centre (m).
        center: Point<2>,
        /// Radius (m).
        radius: f64,
    },
}

impl Domain {
    /// The wall along a side; `None` for the axis, which is no surface, and for periodic sides.
    ///
    /// The sides of a box are taken as whole lines: the foot of a perpendicular from within the
    /// box is always between the ends of its side.
    #[must_use]
    pub fn wall(&self, side: usize) -> Option<Wall> {
        if self.is_periodic(side) {
            return None;
        }
        let line = |x: f64, y: f64, normal: [f64; 2]| {
            Some(Wall::Line { point: Point::<2>::new(x, y), normal: normal.into() })
        };
        match (self, side) {
            (Self::Box { min, .. }, 0) => line(min.x, min.y, [1.0, 0.0]),
            (Self::Box { max, .. }, 1) => line(max.x, max.y, [-1.0, 0.0]),
            (Self::Box { min, .. }, 2) => line(min.x, min.y, [0.0, 1.0]),
            (Self::Box { max, .. }, 3) => line(max.x, max.y, [0.0, -1.0]),
            (Self::Disc { center, radius }, 0) => {
                Some(Wall::Circle { center: *center, radius: *radius })
            }
            (Self::HalfDisc { center, radius }, 0) => {
                Some(Wall::Circle { center: Point::<2>::new(*center, 0.0), radius: *radius })
            }
            (Self::Cylinder { x, .. }, 0) => line(x[0], 0.0, [1.0, 0.0]),
            (Self::Cylinder { x, .. }, 1) => line(x[1], 0.0, [-1.0, 0.0]),
            (Self::Cylinder { radius, .. }, 2) => line(0.0, *radius, [0.0, -1.0]),
            _ => None,
        }
    }
}

impl Wall {
    /// Distance from a point (m), negative behind the wall.
    #[must_use]
    pub fn gap(&self, at: Point<2>) -> f64 {
        match self {
            Self::Line { point, normal } => (at - point).dot(normal),
            Self::Circle { center, radius } => radius - (at - center).norm(),
        }
    }

    /// Unit normal into the fluid at the place nearest to a point; along -x at a circle's centre.
    fn normal(&self, at: Point<2>) -> Point<2> {
        match self {
            Self::Line { normal, .. } => *normal,
            Self::Circle { center, .. } => {
                (center - at).try_normalize(0.0).unwrap_or_else(|| Point::<2>::new(-1.0, 0.0))
            }
        }
    }

    fn curvature(&self) -> f64 {
        match self {
            Self::Line { .. } => 0.0,
            Self::Circle { radius, .. } => -1.0 / radius,
        }
    }

    /// Where on the wall a place is: along it from its point (m), or the angle about its centre.
    fn parameter(&self, at: Point<2>) -> f64 {
        match self {
            Self::Line { point, normal } => cross(at - point, *normal),
            Self::Circle { center, .. } => (at.y - center.y).atan2(at.x - center.x),
        }
    }

    /// Contact data at a place of an outline whose normal is opposite to the wall's.
    pub(super) fn describe(&self, at: Point<2>, parameter: f64, curvature: f64) -> Closest {
        let (normal, gap) = (self.normal(at), self.gap(at));
        let second = at - normal * gap;
        Closest {
            first: at,
            second,
            normal,
            gap,
            parameters: [parameter, self.parameter(second)],
            curvatures: [curvature, self.curvature()],
        }
    }
}

/// All places where an outline comes nearer to a wall than `range` (m), or is behind it.
pub fn features(outline: &Outline, wall: &Wall, range: f64) -> Vec<Closest> {
    if let Some(radius) = outline.circle_radius() {
        let toward = -wall.normal(outline.center());
        let place = outline.center() + toward * radius;
        let parameter = outline.parameter_towards(toward);
        let mut only = wall.describe(place, parameter, 1.0 / radius);
        // The normal at the disc's centre is exact, also where its edge is at the wall's centre
        only.normal = -toward;
        only.gap = wall.gap(outline.center()) - radius;
        only.second = place + toward * only.gap;
        return if only.gap < range { vec![only] } else { Vec::new() };
    }
    let mut open = Arc::all_of(outline);
    let mut found: Vec<Closest> = Vec::new();
    while let Some(arc) = open.pop() {
        if is_hopeless(wall, &arc, range) {
            continue;
        }
        let bounds = regularity(wall, &arc);
        if bounds.high < 0.0 {
            continue;
        }
        if bounds.low > 0.0 || arc.is_smallest() {
            let at = foot(outline, wall, &arc).filter(|at| is_feature(at, range, outline));
            found.extend(at);
        } else {
            open.extend(arc.halves(outline));
        }
    }
    found.sort_by(|one, other| one.parameters[0].total_cmp(&other.parameters[0]));
    let period = outline.period();
    let mut distinct: Vec<Closest> = Vec::new();
    for at in found {
        let is_known =
            |known: &Closest| apart(at.parameters[0], known.parameters[0], period) <= 1e-6 * period;
        if !distinct.iter().any(is_known) {
            distinct.push(at);
        }
    }
    distinct
}

fn is_feature(at: &Closest, range: f64, outline: &Outline) -> bool {
    at.gap < range && at.regularity() >= -1e-9 / outline.reach()
}

/// Whether no place of a stretch is within range with its normal opposite to the wall's.
fn is_hopeless(wall: &Wall, arc: &Arc, range: f64) -> bool {
    // A gap is concave along a chord at straight and round walls, so least at an end
    if wall.gap(arc.start).min(wall.gap(arc.end)) - arc.bulge() > range {
        return true;
    }
    let Circle { center, radius } = arc.circle();
    let swing = match wall {
        Wall::Line { .. } => 0.0,
        Wall::Circle { center: middle, .. } => {
            let sine = radius / (center - middle).norm();
            if sine < 1.0 { sine.asin() } else { std::f64::consts::PI }
        }
    };
    let normal = wall.normal(center);
    // Counter-clockwise a body's own normal is -n where it runs along (n_y, -n_x)
    let turn = angle_between(arc.chord(), Point::<2>::new(normal.y, -normal.x));
    turn > arc.lean() + swing + 1e-12
}

/// Bounds of k1 + k2 + g k1 k2, with g the gap.
fn regularity(wall: &Wall, arc: &Arc) -> Range {
    let k1 = arc.curvature();
    if !(k1.low.is_finite() && k1.high.is_finite()) {
        return Range { low: f64::NEG_INFINITY, high: f64::INFINITY };
    }
    let Circle { center, radius } = arc.circle();
    let (gap, k2) = (wall.gap(center), wall.curvature());
    let factor = Range { low: 1.0 + k2 * (gap + radius), high: 1.0 + k2 * (gap - radius) };
    let factor = Range { low: factor.low.min(factor.high), high: factor.high.max(factor.low) };
    k1.times(factor).plus(Range { low: k2, high: k2 })
}

/// The place of a stretch whose tangent is that of the wall, by Newton kept inside a bracket.
fn foot(outline: &Outline, wall: &Wall, arc: &Arc) -> Option<Closest> {
    let rate = |s: f64| {
        let [at, first, _] = outline.at(s);
        first.dot(&wall.normal(at))
    };
    let margin = 0.25 * arc.width();
    let (mut low, mut high) = (arc.low - margin, arc.high + margin);
    // The gap falls before its least value and rises behind it
    if rate(low) > 0.0 || rate(high) < 0.0 {
        return None;
    }
    let mut s = arc.middle();
    for _ in 0..100 {
        let [at, first, second] = outline.at(s);
        let normal = wall.normal(at);
        let value = first.dot(&normal);
        if value > 0.0 {
            high = s;
        } else {
            low = s;
        }
        let bend = match wall {
            Wall::Line { .. } => 0.0,
            Wall::Circle { center, .. } => {
                let across = cross(normal, first);
                across * across / (at - center).norm()
            }
        };
        let newton = s - value / (second.dot(&normal) - bend);
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - s).abs() <= 1e-15 * outline.period() {
            s = next;
            break;
        }
        s = next;
    }
    let [at, first, second] = outline.at(s);
    let curvature = cross(first, second) / first.norm().powi(3);
    Some(wall.describe(at, wrapped(s, outline.period()), curvature))
}
