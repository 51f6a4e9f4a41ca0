//! Closest points of outlines with each other and with walls, on the exact curves.
//!
//! Every close pair of features is found, not one per pair of bodies: bodies that are not convex
//! touch twice. Results depend on nothing but the input, to the last bit.

mod arc;
mod closest_points;
mod corners;
mod pairs;
mod wall;

pub use closest_points::Closest;
use closest_points::{by_points, least};
pub use wall::Wall;

use std::borrow::Cow;

use crate::{Outline, Point};

/// All places where two outlines are nearer to each other than `range` (m).
///
/// In the order of their places on the first outline, each once. Outlines that overlap always give
/// at least one feature with a gap of zero or less; its normal leads the first body out of the
/// second.
#[must_use]
pub fn closest_features(first: &Outline, second: &Outline, range: f64) -> Vec<Closest> {
    if first.least_gap(second.center()) - second.reach() >= range {
        return Vec::new();
    }
    if let Some(closest) = between_discs(first, second) {
        return if closest.gap < range { vec![closest] } else { Vec::new() };
    }
    if first.is_polygon() && second.is_polygon() {
        return corners::features(first, second, range);
    }
    let (first, second) = (&smooth(first), &smooth(second));
    let deepest = overlap_depth(first, second);
    let mut found = match deepest {
        Some(deepest) => vec![deepest],
        None => pairs::features(first, second, range.max(shallow(first, second))),
    };
    found.retain(|at| at.gap < range);
    found
}

/// All places where an outline is nearer to a wall than `range` (m), or behind it.
#[must_use]
pub fn wall_features(outline: &Outline, wall: &Wall, range: f64) -> Vec<Closest> {
    if wall.gap(outline.center()) - outline.reach() >= range {
        return Vec::new();
    }
    if outline.is_polygon() {
        return corners::wall_features(outline, wall, range);
    }
    wall::features(outline, wall, range)
}

/// The nearest points of two outlines; where they overlap, the deepest.
#[must_use]
pub fn closest(first: &Outline, second: &Outline) -> Closest {
    if let Some(closest) = between_discs(first, second) {
        return closest;
    }
    if first.is_polygon() && second.is_polygon() {
        let found = corners::features(first, second, f64::INFINITY);
        return least(&found).unwrap_or_else(|| by_points(first, second));
    }
    let (first, second) = (&smooth(first), &smooth(second));
    if let Some(deepest) = overlap_depth(first, second) {
        return deepest;
    }
    // Feet of perpendiculars, to and fro, end at some distance; the least one is not above it
    let mut foot = first.nearest(second.center()).point;
    for _ in 0..4 {
        foot = first.nearest(second.nearest(foot).point).point;
    }
    let above = second.nearest(foot).gap.abs() * (1.0 + 1e-6) + shallow(first, second);
    let found = pairs::features(first, second, above);
    least(&found).unwrap_or_else(|| by_points(first, second))
}

/// The nearest points of an outline and a wall; behind the wall, the deepest.
#[must_use]
pub fn closest_to_wall(outline: &Outline, wall: &Wall) -> Closest {
    let found = wall_features(outline, wall, f64::INFINITY);
    least(&found).unwrap_or_else(|| {
        // A round body in the middle of a round wall: every point is as near
        let place = outline.at(0.0)[0];
        let gap = wall.gap(place);
        let normal = (outline.center() - place).normalize();
        let curvatures = [0.0; 2];
        let second = place - normal * gap;
        Closest { first: place, second, normal, gap, parameters: [0.0; 2], curvatures }
    })
}

/// Whether two bodies share a point.
#[must_use]
pub fn overlap(first: &Outline, second: &Outline) -> bool {
    if first.least_gap(second.center()) > second.reach() {
        return false;
    }
    closest_features(first, second, shallow(first, second)).iter().any(|at| at.gap <= 0.0)
}

/// How far a body can be moved without passing through the thinnest part of an outline (m): the
/// smallest diameter of an ellipse, of the circles inside a spline that touch it twice, the least distance
/// of opposite sides of a polygon.
#[must_use]
pub fn thickness(outline: &Outline) -> f64 {
    /// Samples between two points of a spline, enough to see its narrow places to a few per cent.
    const SAMPLES: usize = 4;
    /// More than the rounding of a product.
    const NEAR: f64 = 1.0 + 1e-12;
    if let Some(thickness) = outline.thickness_of_polygon() {
        return thickness;
    }
    if outline.is_ellipse() {
        return 2.0
            * (0..4).fold(f64::INFINITY, |least, quarter| {
                least.min((outline.evaluate(quarter, 0.0)[0] - outline.center()).norm())
            });
    }
    let breaks = outline.breaks();
    let samples: Vec<[Point<2>; 3]> = breaks
        .windows(2)
        .flat_map(|ends| {
            let step = (ends[1] - ends[0]) / SAMPLES as f64;
            (0..SAMPLES).map(move |i| ends[0] + step * i as f64)
        })
        .map(|parameter| outline.at(parameter))
        .collect();
    let mut thinnest = f64::INFINITY;
    for [at, slope, _] in &samples {
        let inward = Point::<2>::new(-slope.y, slope.x).normalize();
        for [other, ..] in &samples {
            let way = other - at;
            let (depth, squared) = (inward.dot(&way), way.norm_squared());
            // Most are far from the thinnest place, and need no division
            if depth > 0.0 && squared <= thinnest * depth * NEAR {
                thinnest = thinnest.min(squared / depth);
            }
        }
    }
    thinnest
}

/// Features of bodies on the axis of an axisymmetric problem: those in the half plane y >= 0.
///
/// A feature on the axis gets its normal along it. One away from the axis is a ring.
#[must_use]
pub fn on_meridian(mut features: Vec<Closest>) -> Vec<Closest> {
    /// Distance from the axis over that between the points' curvature centres.
    const ON_AXIS: f64 = 1e-9;
    for at in &mut features {
        let size = at.curvatures.iter().fold(0.0f64, |most, k| most.max(k.abs()));
        if (at.first.y * size).abs() < ON_AXIS {
            at.first.y = 0.0;
            at.second.y = 0.0;
            at.normal = Point::<2>::new(at.normal.x.signum(), 0.0);
        }
    }
    features.retain(|at| at.first.y >= 0.0);
    features
}

/// An outline with a tangent that turns continuously: corners of a polygon face what is smooth as bends do.
fn smooth(outline: &Outline) -> Cow<'_, Outline> {
    outline.blunted().map_or(Cow::Borrowed(outline), Cow::Owned)
}

/// Depth (m) down to which an overlap is seen as a feature of its own.
fn shallow(first: &Outline, second: &Outline) -> f64 {
    0.02 * first.reach().min(second.reach())
}

/// Closed form for two discs.
fn between_discs(first: &Outline, second: &Outline) -> Option<Closest> {
    let (r, s) = (first.circle_radius()?, second.circle_radius()?);
    let between = first.center() - second.center();
    // Discs about the same centre part along x
    let normal = between.try_normalize(0.0).unwrap_or_else(|| Point::<2>::new(1.0, 0.0));
    Some(Closest {
        first: first.center() - normal * r,
        second: second.center() + normal * s,
        normal,
        gap: between.norm() - (r + s),
        parameters: [first.parameter_towards(-normal), second.parameter_towards(normal)],
        curvatures: [1.0 / r, 1.0 / s],
    })
}

/// The deepest place where outlines cross or hold one another; shallow overlaps are left to
/// [`pairs::features`].
fn overlap_depth(first: &Outline, second: &Outline) -> Option<Closest> {
    if first.least_gap(second.center()) > second.reach() {
        return None;
    }
    let holds = |one: &Outline, other: &Outline| one.nearest(other.at(0.0)[0]).gap <= 0.0;
    if !(arc::outlines_cross(first, second) || holds(first, second) || holds(second, first)) {
        return None;
    }
    // With curves of finite curvature a deep place is one of opposite normals, if there is any
    let depth = 2.0 * first.reach().min(second.reach());
    let mut found = pairs::features(first, second, depth);
    found.retain(|at| at.gap <= 0.0);
    Some(least(&found).unwrap_or_else(|| by_points(first, second)))
}
