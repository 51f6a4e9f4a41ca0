//! Pairs of bodies and smallest gaps against a search of all pairs.

use alewife_mesh::{Domain, PlacedShape, Shape};

use super::*;
use crate::contact::PlanarGaps;

/// Numbers in [0, 1) without a pattern, by the golden ratio.
fn scattered(nth: usize) -> f64 {
    (nth as f64 * 0.618_033_988_749).fract()
}

/// Bodies of several shapes that lie in a square of the side `size` (m), and beside it.
fn crowd(n: usize, size: f64) -> (Vec<PlacedShape>, Vec<Pose>) {
    let triangle = vec![[0.5, 0.1], [-0.3, 0.6], [-0.4, -0.4]];
    let shape = |nth: usize| match nth % 4 {
        0 => Shape::Ellipse { semi_axes: [0.6, 0.2] },
        1 => Shape::Spline { points: triangle.clone() },
        _ => Shape::Disc { radius: 0.1 + 0.3 * scattered(11 * nth) },
    };
    let body = |nth: usize| PlacedShape {
        name: nth.to_string(),
        shape: shape(nth),
        center: Point::<2>::zeros(),
        angle: 0.0,
        size: None,
    };
    let pose = |nth: usize| {
        let [x, y] = [scattered(nth), scattered(7 * nth + 3)];
        Pose::planar(1.2 * size * x, size * y, 4.0 * x)
    };
    ((0..n).map(body).collect(), (0..n).map(pose).collect())
}

fn box_of(size: f64, periodic_x: bool, periodic_y: bool) -> Domain {
    let (min, max) = (Point::<2>::zeros(), Point::<2>::repeat(size));
    Domain::Box { min, max, periodic_x, periodic_y }
}

#[test]
fn pairs_and_the_smallest_gap_are_those_found_among_all_bodies() {
    let size = 14.0;
    let (bodies, poses) = crowd(80, size);
    for (periodic_x, periodic_y, walls) in
        [(false, false, vec![0, 1, 2, 3]), (true, false, vec![2, 3]), (true, true, vec![])]
    {
        let domain = box_of(size, periodic_x, periodic_y);
        let joined = [[3, 5], [8, 7]].into_iter();
        let gaps = PlanarGaps::new(&domain, &walls, &bodies).unwrap().with_joined(joined);
        let surfaces = gaps.surfaces(&poses);
        let all: Vec<Vec<usize>> = (0..80).map(|body| (body..80).collect()).collect();
        for range in [0.05, 0.5] {
            let mut pairs = Vec::new();
            gaps.for_each_encounter(&poses, &surfaces, &all, |met| {
                gaps.append(&mut pairs, &poses, met, range);
            });
            assert!(pairs.len() > 20, "{}", pairs.len());
            assert_eq!(gaps.pairs(&poses, range), pairs);
        }
        let least = gaps.minimum_gap_within(&poses, &surfaces, f64::INFINITY);
        assert_eq!(gaps.minimum_gap(&poses), least);
    }
}

fn unit_disc(nth: usize) -> PlacedShape {
    PlacedShape {
        name: nth.to_string(),
        shape: Shape::Disc { radius: 1.0 },
        center: Point::<2>::zeros(),
        angle: 0.0,
        size: None,
    }
}

#[test]
fn the_smallest_gap_is_found_between_bodies_far_apart() {
    let n = FEW_BODIES + 4;
    let bodies: Vec<PlacedShape> = (0..n).map(unit_disc).collect();
    for distance in [3.0, 8.0, 30.0, 300.0] {
        let at = |nth: usize| distance * nth as f64 + f64::from(nth > 5);
        let poses: Vec<Pose> = (0..n).map(|nth| Pose::planar(at(nth), 5.0, 0.0)).collect();
        let gaps = PlanarGaps::new(&box_of(9.0, false, false), &[], &bodies).unwrap();
        let least = gaps.minimum_gap(&poses).unwrap();
        assert_eq!((least.body, least.partner), (0, Partner::Body(1)));
        assert_eq!(least.gap, distance - 2.0);
    }
}

#[test]
fn the_bound_of_the_step_is_that_of_all_bodies() {
    let (bodies, from) = crowd(60, 12.0);
    let gaps = PlanarGaps::new(&box_of(12.0, true, true), &[], &bodies).unwrap();
    let moved = |(nth, pose): (usize, &Pose)| {
        let (x, y) = (pose.center.x, pose.center.y);
        Pose::planar(x + 0.3 * scattered(nth), y, pose.angle())
    };
    let to: Vec<Pose> = from.iter().enumerate().map(moved).collect();
    let mut fraction = 1.0f64;
    for body in 0..60 {
        for other in body..60 {
            let [one, two] =
                [body, other].map(|body| gaps.displacement_bound(body, &from[body], &to[body]));
            let reach = gaps.reach(body) + gaps.reach(other) + one + two;
            let near = gaps
                .images(&from, body, other)
                .into_iter()
                .any(|away| (center(&from[body]) - center(&from[other]) - away).norm() < reach);
            if near {
                let thinner = gaps.bodies[body].thickness.min(gaps.bodies[other].thickness);
                fraction = fraction.min(0.5 * thinner / (one + two));
            }
        }
    }
    assert!(fraction < 1.0);
    assert_eq!(gaps.max_step_fraction(&from, &to), fraction);
}

/// A folded row of discs on pivots: neighbours are close, and yet the gap is that of the ends.
#[test]
fn of_a_chain_the_gaps_between_links_that_share_no_pivot_count() {
    let places = [[2.0, 2.0], [4.1, 2.0], [4.1, 4.1], [2.0, 4.5], [2.0, 6.55]];
    let poses = places.map(|[x, y]| Pose::planar(x, y, 0.0));
    let bodies: Vec<PlacedShape> = (0..5).map(unit_disc).collect();
    let joined = [[0, 1], [1, 2], [2, 3]].into_iter();
    let gaps =
        PlanarGaps::new(&box_of(9.0, false, false), &[0], &bodies).unwrap().with_joined(joined);
    let among = |bodies: &[usize]| gaps.minimum_gap_among(&poses, bodies);
    // From the first disc to the last one of the chain; another body and walls do not count
    assert!((among(&[1, 0, 2, 3]).unwrap() - 0.5).abs() < 1e-12);
    assert_eq!(among(&[1, 0]), None);
    // The pair whose bodies share no pivot
    assert!((among(&[3, 4]).unwrap() - 0.05).abs() < 1e-12);
}

#[test]
fn gaps_of_polygons_change_as_their_gradients_say() {
    let polygon =
        |points: Vec<[f64; 2]>| PlacedShape { shape: Shape::Polygon { points }, ..unit_disc(0) };
    let named = |name: &str, body: PlacedShape| PlacedShape { name: name.to_owned(), ..body };
    let square = polygon(vec![[0.5, 0.5], [-0.5, 0.5], [-0.5, -0.5], [0.5, -0.5]]);
    let wedge = polygon(vec![[0.7, 0.0], [-0.3, 0.4], [0.0, 0.0], [-0.3, -0.4]]);
    let bodies = [named("square", square), named("wedge", wedge), named("disc", unit_disc(2))];
    let gaps = PlanarGaps::new(&box_of(9.0, false, false), &[2], &bodies).unwrap();
    // The square nearly flat on the floor, the disc on its side, the tip of the wedge at its corner
    let poses =
        [Pose::planar(3.0, 0.52, 0.01), Pose::planar(4.4, 1.2, 3.6), Pose::planar(2.9, 2.1, 0.0)];
    let range = 0.6;
    let pairs = gaps.pairs(&poses, range);
    assert!(pairs.len() >= 4, "{}", pairs.len());
    let step = 1e-6;
    for body in 0..3 {
        for mode in [0, 1, 5] {
            let moved = |size: f64| {
                let mut displacement = crate::body::RigidVector::zeros();
                displacement[mode] = size;
                let mut moved = poses;
                moved[body] = poses[body].displaced(&displacement);
                gaps.pairs(&moved, range)
            };
            let (ahead, behind) = (moved(step), moved(-step));
            for ((at, up), down) in pairs.iter().zip(&ahead).zip(&behind) {
                let slope = (up.gap - down.gap) / (2.0 * step);
                let [own, others] = at.gradient();
                let exact = match at.partner {
                    _ if at.body == body => own[mode],
                    Partner::Body(other) if other == body => others[mode],
                    _ => 0.0,
                };
                assert!((slope - exact).abs() < 2e-3, "{body} {mode}: {slope} {exact} {at:?}");
            }
        }
    }
}
