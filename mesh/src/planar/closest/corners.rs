//! Where corners of polygons face other polygons and walls.
//!
//! Between straight sides the distance is least at a corner of one of them. Of a flat side that lands on
//! another one both corners face it, the one that is farther away by the tilt, too: forces of both change
//! continuously as the body rocks. Corners that hardly turn face something only where they are nearest.

use std::f64::consts::PI;

use super::arc::{apart, wrapped};
use super::closest_points::{Closest, by_points, least};
use super::wall::Wall;
use crate::planar::outline::Corner;
use crate::planar::vector::cross;
use crate::{Outline, Point};

/// Angle by which the outline turns above which a corner faces what its sides face (rad).
const SHARP: f64 = PI / 12.0;

/// Angle below which it is no corner (rad).
const STRAIGHT: f64 = 1e-6;

/// Cosine of the angle to the normal of a side above which a sharp corner faces something.
const FACING: f64 = 0.5;

/// Curvature of a corner over one over the size of its body: its points stay where they are as it turns.
const CURVATURE: f64 = 1e6;

/// Sine of an angle that is rounding.
const ROUNDING: f64 = 1e-9;

/// All places where corners of two polygons face the other one more closely than `range` (m), in the
/// order of their places on the first; of polygons that overlap at least one with a gap of zero or less.
pub fn features(first: &Outline, second: &Outline, range: f64) -> Vec<Closest> {
    let mut found = facing(first, second, range);
    found.extend(facing(second, first, range).into_iter().map(|at| at.swapped()));
    let periods = [first.period(), second.period()];
    found.sort_by(|one, other| one.parameters[0].total_cmp(&other.parameters[0]));
    let mut distinct: Vec<Closest> = Vec::new();
    for feature in found {
        let is_same = |known: &Closest, side: usize| {
            let [one, other] = [feature, *known].map(|at| at.parameters[side]);
            apart(one, other, periods[side]) <= ROUNDING * periods[side]
        };
        if !distinct.iter().any(|known| is_same(known, 0) && is_same(known, 1)) {
            distinct.push(feature);
        }
    }
    let is_apart = distinct.iter().all(|at| at.gap > 0.0);
    if is_apart && (sides_cross(first, second) || distinct.is_empty() && range == f64::INFINITY) {
        distinct.push(by_points(first, second));
    }
    distinct
}

/// All places where corners of a polygon face a wall more closely than `range` (m), or are behind it.
pub fn wall_features(outline: &Outline, wall: &Wall, range: f64) -> Vec<Closest> {
    let corners = outline.corners().into_iter().filter(|corner| wall.gap(corner.at) < range);
    let curvature = CURVATURE / outline.reach();
    let described =
        corners.map(|corner| (corner, wall.describe(corner.at, corner.parameter, curvature)));
    let facing: Vec<Closest> = described
        .clone()
        .filter(|(corner, at)| faces(corner, -at.normal))
        .map(|(_, at)| at)
        .collect();
    let nearest = described.map(|(_, at)| at).reduce(|a, b| if b.gap < a.gap { b } else { a });
    match least(&facing) {
        // Behind the middle of a round wall the nearest corner may look away from it
        None => nearest.into_iter().collect(),
        Some(_) => facing,
    }
}

/// Corners of one polygon that face another one.
fn facing(one: &Outline, other: &Outline, range: f64) -> Vec<Closest> {
    let (near, own) = (other.least_gap(one.center()), CURVATURE / one.reach());
    if near - one.reach() >= range {
        return Vec::new();
    }
    let ends: Vec<Point<2>> = other.corners().iter().map(|corner| corner.at).collect();
    let small = ROUNDING * other.reach();
    let mut found = Vec::new();
    for corner in one.corners() {
        if other.least_gap(corner.at) >= range {
            continue;
        }
        let foot = other.nearest(corner.at);
        if foot.gap >= range || !faces(&corner, -foot.normal) {
            continue;
        }
        let is_at_corner = ends.iter().any(|end| (end - foot.point).norm() <= small);
        let second = if is_at_corner { CURVATURE / other.reach() } else { 0.0 };
        found.push(Closest {
            first: corner.at,
            second: foot.point,
            normal: foot.normal,
            gap: foot.gap,
            parameters: [
                wrapped(corner.parameter, one.period()),
                wrapped(other.parameter_of(foot.point), other.period()),
            ],
            curvatures: [own, second],
        });
    }
    found
}

/// Whether a corner of a body faces what lies in a direction from it.
fn faces(corner: &Corner, way: Point<2>) -> bool {
    let [before, behind] = corner.sides;
    let turn = corner.turn();
    if turn < STRAIGHT {
        return false;
    }
    let is_nearest = way.dot(&before) >= -ROUNDING && way.dot(&behind) <= ROUNDING;
    let along_normal = [before, behind].iter().any(|side| cross(way, *side) > FACING);
    is_nearest || (turn > SHARP && along_normal)
}

/// Whether a side of one polygon crosses one of another.
fn sides_cross(first: &Outline, second: &Outline) -> bool {
    let sides = |outline: &Outline| -> Vec<[Point<2>; 2]> {
        let corners = outline.corners();
        (0..corners.len()).map(|i| [corners[i].at, corners[(i + 1) % corners.len()].at]).collect()
    };
    let (own, others) = (sides(first), sides(second));
    own.iter().any(|[a, b]| {
        others.iter().any(|[c, d]| {
            let sides = |from: &Point<2>, to: &Point<2>, p: &Point<2>, q: &Point<2>| {
                cross(to - from, p - from) * cross(to - from, q - from) < 0.0
            };
            sides(a, b, c, d) && sides(c, d, a, b)
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planar::closest::{closest, closest_features, closest_to_wall, wall_features};
    use crate::{PlacedShape, Shape};

    fn placed(shape: Shape, x: f64, y: f64, angle: f64) -> Outline {
        let center = Point::<2>::new(x, y);
        Outline::new(&PlacedShape { name: "b".into(), shape, center, angle, size: None }).unwrap()
    }

    fn square(x: f64, y: f64, angle: f64) -> Outline {
        let points = vec![[0.5, 0.5], [-0.5, 0.5], [-0.5, -0.5], [0.5, -0.5]];
        placed(Shape::Polygon { points }, x, y, angle)
    }

    const FLOOR: Wall =
        Wall::Line { point: Point::<2>::new(0.0, 0.0), normal: Point::<2>::new(0.0, 1.0) };

    #[test]
    fn both_corners_of_a_side_face_the_floor_and_forces_change_continuously() {
        for tilt in [-1e-3, 0.0, 1e-3] {
            let found = wall_features(&square(0.3, 0.55, tilt), &FLOOR, 0.1);
            assert_eq!(found.len(), 2, "{tilt}");
            for (at, x) in found.iter().zip([-0.5, 0.5]) {
                let height = 0.55 - 0.5 * tilt.cos() + x * tilt.sin();
                assert!((at.gap - height).abs() < 1e-12, "{tilt}");
                assert!((at.normal.y - 1.0).abs() < 1e-12);
            }
        }
        // On its corner
        let found = wall_features(&square(0.0, 0.8, PI / 4.0), &FLOOR, 0.5);
        assert_eq!(found.len(), 1);
        assert!((closest_to_wall(&square(0.0, 0.3, 0.0), &FLOOR).gap + 0.2).abs() < 1e-12);
    }

    #[test]
    fn squares_face_each_other_where_they_must() {
        let found = closest_features(&square(0.0, 0.0, 0.0), &square(0.2, 1.01, 0.0), 0.05);
        assert_eq!(found.len(), 2);
        assert!(found.iter().all(|at| (at.gap - 0.01).abs() < 1e-12));
        // Corner to corner, seen from both once
        let found = closest_features(&square(0.0, 0.0, 0.0), &square(1.3, 1.4, 0.0), 1.0);
        assert_eq!(found.len(), 1);
        assert!((found[0].gap - 0.5).abs() < 1e-12);
        let plus = vec![[2.0, 0.1], [-2.0, 0.1], [-2.0, -0.1], [2.0, -0.1]];
        let bar = |angle| placed(Shape::Polygon { points: plus.clone() }, 0.0, 0.0, angle);
        assert!(closest(&bar(0.0), &bar(PI / 2.0)).gap < 0.0);
    }

    /// The least gap of features is that found by sampling, whatever faces a polygon.
    #[test]
    fn gaps_to_polygons_are_those_found_by_sampling() {
        let arrow = vec![[1.0, 0.0], [-0.5, 0.6], [0.0, 0.0], [-0.5, -0.6]];
        let points = (0..9).map(|i| PI * 2.0 * f64::from(i) / 9.0);
        let points = points.map(|a| [(1.0 + 0.3 * (3.0 * a).cos()) * a.cos(), 0.7 * a.sin()]);
        let shapes = [
            Shape::Polygon { points: arrow.clone() },
            Shape::Disc { radius: 0.4 },
            Shape::Ellipse { semi_axes: [0.7, 0.3] },
            Shape::Spline { points: points.collect() },
        ];
        for seed in 0..60_u8 {
            let part = |k: f64| (0.618_034 * k * f64::from(seed + 1)).fract();
            let one = placed(Shape::Polygon { points: arrow.clone() }, 0.0, 0.0, 6.3 * part(3.0));
            let other = shapes[usize::from(seed) % 4].clone();
            let other = placed(other, 1.9 + 0.6 * part(5.0), 0.8 * part(7.0), 6.3 * part(11.0));
            let sampled = (0..4000).map(|i| {
                let at =
                    |outline: &Outline| outline.at(outline.period() * f64::from(i) / 4000.0)[0];
                one.nearest(at(&other)).gap.min(other.nearest(at(&one)).gap)
            });
            let sampled = sampled.fold(f64::INFINITY, f64::min);
            if sampled <= 0.0 {
                continue;
            }
            let gap = closest(&one, &other).gap;
            assert!((gap - sampled).abs() < 2e-3, "{seed}: {gap} {sampled}");
            let near = closest_features(&one, &other, sampled + 0.01);
            assert!(!near.is_empty(), "{seed}");
            let [there, back] = [(&one, &other), (&other, &one)].map(|(a, b)| closest(a, b).gap);
            assert!((there - back).abs() < 1e-9, "{seed}: {there} {back}");
        }
    }
}
