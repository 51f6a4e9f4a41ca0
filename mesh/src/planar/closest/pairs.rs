//! All places where two outlines face each other closely: branch and bound, then Newton's method.
//!
//! A feature is a pair of points p, q of the two curves whose tangents are opposite and
//! perpendicular to p - q. With n the normal of the second curve, g = (p - q) . n its gap and k the
//! curvatures, it is a minimum of the distance where D = k1 + k2 + g k1 k2 > 0. This form stays
//! regular as g goes through zero, which |p - q| does not, and continues into shallow overlaps.
//!
//! None is missed: pairs of stretches are given up only when bounds show that they are too far
//! apart, that no tangents are opposite, that p - q is nowhere perpendicular to them, or that
//! D < 0. Where bounds show D > 0 there is one feature at most; where neither is shown the pair is
//! halved, down to 1/256 of a stretch between two points of a spline, within which minima are one.

use super::arc::{
    Arc, ArcPair, Circle, Pairs, Range, apart, least_distance, may_be_opposite, split, wrapped,
};
use super::closest_points::Closest;
use crate::planar::vector::cross;
use crate::{Outline, Point};

/// Tangents turn less than this within a pair before Newton's method starts (rad).
const STRAIGHT: f64 = 0.4;

/// All features with |gap| below `limit` (m), the ones of shallow overlaps included, in the order
/// of their places on the first outline.
pub fn features(first: &Outline, second: &Outline, limit: f64) -> Vec<Closest> {
    let mut found: Vec<Closest> = Vec::new();
    for pair in Pairs::within(first, second, limit).backwards() {
        found.extend(features_of(pair, first, second, limit));
    }
    distinct(found, [first.period(), second.period()])
}

/// Those of a pair of stretches.
fn features_of(pair: ArcPair, first: &Outline, second: &Outline, limit: f64) -> Vec<Closest> {
    let (mut open, mut found) = (vec![pair], Vec::new());
    while let Some(ArcPair { first: a, second: b }) = open.pop() {
        let distance = least_distance(&a, &b);
        if distance > limit || !may_be_opposite(&a, &b) || !may_be_square(&a, &b) {
            continue;
        }
        let bounds = regularity(&a, &b, distance);
        if bounds.high < 0.0 {
            continue;
        }
        let is_straight = a.lean() + b.lean() < STRAIGHT;
        let smaller = split(&a, &b, first, second);
        if (bounds.low > 0.0 && is_straight) || smaller.is_empty() {
            let feature = newton(first, second, &a, &b);
            found.extend(feature.filter(|feature| is_feature(first, second, feature, limit)));
        } else {
            open.extend(smaller);
        }
    }
    found
}

/// Features in the order of their places on the first outline, those that differ by rounding once.
fn distinct(mut found: Vec<Closest>, periods: [f64; 2]) -> Vec<Closest> {
    found.sort_by(|one, other| one.parameters[0].total_cmp(&other.parameters[0]));
    let mut distinct: Vec<Closest> = Vec::new();
    for feature in found {
        let is_near = |known: &Closest, side: usize| {
            let (one, other) = (feature.parameters[side], known.parameters[side]);
            apart(one, other, periods[side]) <= 1e-6 * periods[side]
        };
        let is_among = |known: &mut dyn Iterator<Item = &Closest>| {
            known.take_while(|known| is_near(known, 0)).any(|known| is_near(known, 1))
        };
        // Parallel sides have hundreds: the near ones are the last so far, and at the end of the period the first
        if !is_among(&mut distinct.iter().rev()) && !is_among(&mut distinct.iter()) {
            distinct.push(feature);
        }
    }
    distinct
}

/// Whether p - q may be perpendicular to both stretches for some p and q on them.
fn may_be_square(a: &Arc, b: &Arc) -> bool {
    let Circle { center: p, radius: p_radius } = a.circle();
    let Circle { center: q, radius: q_radius } = b.circle();
    let (between, spread) = (p - q, p_radius + q_radius);
    [a, b].into_iter().all(|arc| {
        let along = between.dot(&arc.chord()).abs() / arc.chord().norm();
        let lean = arc.lean().min(std::f64::consts::FRAC_PI_2);
        along - spread <= lean.sin() * (between.norm() + spread)
    })
}

/// Bounds of D = k1 + k2 + g k1 k2 over two stretches.
fn regularity(a: &Arc, b: &Arc, distance: f64) -> Range {
    let Circle { center: p, radius: p_radius } = a.circle();
    let Circle { center: q, radius: q_radius } = b.circle();
    let farthest = (p - q).norm() + p_radius + q_radius;
    let outward = Point::<2>::new(b.chord().y, -b.chord().x) / b.chord().norm();
    let ahead = (p - q).dot(&outward);
    let lean = b.lean();
    let certain = p_radius + q_radius + lean.min(1.0) * farthest;
    let gap = if distance > 0.0 && lean < 1.0 && ahead > certain {
        Range { low: distance, high: farthest }
    } else if distance > 0.0 && lean < 1.0 && -ahead > certain {
        Range { low: -farthest, high: -distance }
    } else {
        Range { low: -farthest, high: farthest }
    };
    let (k1, k2) = (a.curvature(), b.curvature());
    if !(k1.low.is_finite() && k1.high.is_finite() && k2.low.is_finite() && k2.high.is_finite()) {
        return Range { low: f64::NEG_INFINITY, high: f64::INFINITY };
    }
    k1.plus(k2).plus(gap.times(k1.times(k2)))
}

/// The pair of points of two curves with opposite tangents square to the line between them.
fn newton(first: &Outline, second: &Outline, a: &Arc, b: &Arc) -> Option<Closest> {
    let (mut u, mut v) = (a.middle(), b.middle());
    // A root just outside is found by a neighbour, too, and counted once
    let within =
        |arc: &Arc, s: f64| s.clamp(arc.low - 0.25 * arc.width(), arc.high + 0.25 * arc.width());
    let (small_u, small_v) = (1e-15 * first.period(), 1e-15 * second.period());
    let (mut last, mut is_converged) = (f64::INFINITY, false);
    for _ in 0..60 {
        let Opposition { residual, matrix } = opposition(first.at(u), second.at(v));
        let step = solve(matrix, residual);
        let (next_u, next_v) = (within(a, u - step.x), within(b, v - step.y));
        let moved = ((next_u - u).abs() / a.width()).max((next_v - v).abs() / b.width());
        let is_inside = next_u == u - step.x && next_v == v - step.y;
        let is_tiny = (next_u - u).abs() <= small_u && (next_v - v).abs() <= small_v;
        let is_rounding = moved < 1e-9 && moved >= last;
        (u, v, last) = (next_u, next_v, moved);
        is_converged = is_inside && (is_tiny || is_rounding);
        if is_converged || (!is_inside && moved == 0.0) {
            break;
        }
    }
    is_converged.then(|| describe(first, second, u, v))
}

/// How far tangents are from being opposite, and square to p - q.
struct Opposition {
    residual: Point<2>,
    /// Derivative of the residual in both parameters.
    matrix: nalgebra::Matrix2<f64>,
}

fn opposition([p, p1, p2]: [Point<2>; 3], [q, q1, q2]: [Point<2>; 3]) -> Opposition {
    let (s, r) = (p1.norm(), q1.norm());
    let (t, w) = (p1 / s, q1 / r);
    // Turning of the tangents with the parameters
    let (turn_p, turn_q) = (cross(p1, p2) / (s * s), cross(q1, q2) / (r * r));
    let left = |a: Point<2>| Point::<2>::new(-a.y, a.x);
    let (mean, between) = (0.5 * (t - w), p - q);
    let matrix = nalgebra::Matrix2::new(
        -turn_p * t.dot(&w),
        turn_q * t.dot(&w),
        p1.dot(&mean) + 0.5 * turn_p * between.dot(&left(t)),
        -q1.dot(&mean) - 0.5 * turn_q * between.dot(&left(w)),
    );
    let residual = Point::<2>::new(cross(t, w), between.dot(&mean));
    Opposition { residual, matrix }
}

/// Solution of two equations; the shortest one of least squares when they are singular, as for
/// straight sides that are parallel.
fn solve(matrix: nalgebra::Matrix2<f64>, right: Point<2>) -> Point<2> {
    let size = matrix.column(0).norm() * matrix.column(1).norm();
    let determinant = matrix.determinant();
    if determinant.abs() > 1e-10 * size {
        return Point::<2>::new(
            matrix[(1, 1)] * right.x - matrix[(0, 1)] * right.y,
            matrix[(0, 0)] * right.y - matrix[(1, 0)] * right.x,
        ) / determinant;
    }
    let svd = matrix.svd(true, true);
    svd.solve(&right, 1e-8 * svd.singular_values.max()).unwrap_or_else(|_| Point::<2>::zeros())
}

/// Points, normal, gap and curvatures at two parameters.
fn describe(first: &Outline, second: &Outline, u: f64, v: f64) -> Closest {
    let ([p, p1, p2], [q, q1, q2]) = (first.at(u), second.at(v));
    let mean = (q1 / q1.norm() - p1 / p1.norm()).normalize();
    let normal = Point::<2>::new(mean.y, -mean.x);
    Closest {
        first: p,
        second: q,
        normal,
        gap: (p - q).dot(&normal),
        parameters: [wrapped(u, first.period()), wrapped(v, second.period())],
        curvatures: [cross(p1, p2) / p1.norm().powi(3), cross(q1, q2) / q1.norm().powi(3)],
    }
}

/// Whether a pair of points with opposite tangents is a minimum of the distance, or the deepest
/// place of a shallow overlap.
fn is_feature(first: &Outline, second: &Outline, at: &Closest, limit: f64) -> bool {
    let [k1, k2] = at.curvatures;
    let tangents_are_opposite =
        first.at(at.parameters[0])[1].dot(&second.at(at.parameters[1])[1]) < 0.0;
    let flatness = 1e-9 / first.reach().min(second.reach());
    let is_minimum =
        at.regularity() >= -flatness && 1.0 + at.gap * k1 > 0.0 && 1.0 + at.gap * k2 > 0.0;
    if !tangents_are_opposite || !is_minimum || at.gap.abs() >= limit {
        return false;
    }
    // Bodies overlap only where each point is inside the other body
    at.gap > 0.0
        || (second.nearest(at.first).gap <= 1e-12 * second.reach()
            && first.nearest(at.second).gap <= 1e-12 * first.reach())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One at two parameters of curves of period 1.
    fn at(u: f64, v: f64) -> Closest {
        let [first, second, normal] = [Point::<2>::zeros(); 3];
        Closest { first, second, normal, gap: 0.0, parameters: [u, v], curvatures: [0.0; 2] }
    }

    #[test]
    fn features_are_counted_once_also_across_the_end_of_the_period() {
        let wanted =
            [(1e-7, 0.5), (1e-7, 0.7), (0.3, 1e-7), (0.3, 0.2), (0.6, 0.9), (1.0 - 1e-7, 0.1)];
        let again = [
            (1.0 - 2e-7, 0.5),
            (1.0 - 3e-7, 0.7),
            (0.3 + 5e-7, 1.0 - 1e-7),
            (0.3 + 7e-7, 0.2 + 5e-7),
            (1.0 - 5e-8, 0.1),
        ];
        let found: Vec<Closest> = again.iter().chain(&wanted).map(|&(u, v)| at(u, v)).collect();
        let places = distinct(found, [1.0; 2]).iter().map(|at| at.parameters).collect::<Vec<_>>();
        let wanted = wanted.map(|(u, v)| [u, v]);
        assert_eq!(places, wanted);
    }
}
