//! Closest points of outlines and walls against closed forms and dense sampling.
#![expect(clippy::unwrap_used, reason = "a test without its outlines has failed")]

use std::f64::consts::{PI, TAU};

use alewife_mesh::{
    Closest, Domain, Outline, PlacedShape, Point, Shape, Wall, closest, closest_features,
    closest_to_wall, on_meridian, overlap, thickness, wall_features,
};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn outline(shape: Shape, x: f64, y: f64, angle: f64) -> Outline {
    let center = Point::<2>::new(x, y);
    Outline::new(&PlacedShape { name: "body".into(), shape, center, angle, size: None }).unwrap()
}

fn disc(x: f64, y: f64, radius: f64) -> Outline {
    outline(Shape::Disc { radius }, x, y, 0.0)
}

fn ellipse(a: f64, b: f64) -> Shape {
    Shape::Ellipse { semi_axes: [a, b] }
}

/// r = 1 + depth cos(lobes t): two lobes of depth 0.4 make a peanut.
fn lobed(lobes: f64, depth: f64, n: usize) -> Shape {
    let points = (0..n)
        .map(|i| TAU * i as f64 / n as f64)
        .map(|t| (t, 1.0 + depth * (lobes * t).cos()))
        .map(|(t, r)| [r * t.cos(), r * t.sin()])
        .collect();
    Shape::Spline { points }
}

const FLOOR: Wall =
    Wall::Line { point: Point::<2>::new(0.0, 0.0), normal: Point::<2>::new(0.0, 1.0) };

/// Samples of s(u) = signed distance of the second outline to the point u of the first.
fn distances(first: &Outline, second: &Outline, n: usize) -> Vec<f64> {
    let parameter = |i: usize| first.period() * i as f64 / n as f64;
    (0..n).map(|i| second.nearest(first.at(parameter(i))[0]).gap).collect()
}

/// Points of `first` where the samples have a strict minimum below `range`.
fn sampled_minima(first: &Outline, gaps: &[f64], range: f64) -> Vec<(Point<2>, f64)> {
    let n = gaps.len();
    (0..n)
        .filter(|&i| gaps[i] < range)
        .filter(|&i| gaps[i] < gaps[(i + n - 1) % n] && gaps[i] <= gaps[(i + 1) % n])
        .map(|i| (first.at(first.period() * i as f64 / n as f64)[0], gaps[i]))
        .collect()
}

/// Every condition a feature must meet: its points on the curves, opposite normals along the gap.
fn assert_is_feature(first: &Outline, second: &Outline, at: &Closest) {
    let ([p, p1, _], [q, q1, _]) = (first.at(at.parameters[0]), second.at(at.parameters[1]));
    let size = first.reach() + second.reach();
    assert!((p - at.first).norm() < 1e-12 * size && (q - at.second).norm() < 1e-12 * size);
    let outward = |t: Point<2>| Point::<2>::new(t.y, -t.x).normalize();
    assert!((outward(p1) + at.normal).norm() < 1e-9, "{at:?}");
    assert!((outward(q1) - at.normal).norm() < 1e-9, "{at:?}");
    assert!((at.first - at.second - at.normal * at.gap).norm() < 1e-11 * size, "{at:?}");
}

#[test]
fn discs_have_closed_forms() {
    let (a, b) = (disc(0.3, 0.4, 1.0), disc(3.3, 4.4, 2.0));
    let at = closest(&a, &b);
    assert!((at.gap - 2.0).abs() < 1e-15);
    assert!((at.normal - Point::<2>::new(-0.6, -0.8)).norm() < 1e-15);
    assert_is_feature(&a, &b, &at);
    assert!(closest_features(&a, &b, 1.9).is_empty());
    assert_eq!(closest_features(&a, &b, 2.1), vec![at]);
    let deep = closest(&a, &disc(1.3, 0.4, 2.0));
    assert!((deep.gap + 2.0).abs() < 1e-15 && deep.normal.x == -1.0);
    // The same as two ellipses, which go the general way
    let almost = outline(ellipse(1.0, 1.0 + 1e-14), 0.3, 0.4, 0.2);
    assert!((closest(&almost, &b).gap - 2.0).abs() < 1e-13);
}

#[test]
fn walls_of_all_domains_have_closed_forms() {
    let body = disc(0.5, 0.25, 0.2);
    let gap =
        |domain: &Domain, side: usize| closest_to_wall(&body, &domain.wall(side).unwrap()).gap;
    let (min, max) = (Point::<2>::new(0.0, 0.0), Point::<2>::new(2.0, 1.0));
    let channel = Domain::Box { min, max, periodic_x: false, periodic_y: false };
    for (side, wanted) in [0.3, 1.3, 0.05, 0.55].into_iter().enumerate() {
        assert!((gap(&channel, side) - wanted).abs() < 1e-15);
    }
    let periodic = Domain::Box { min, max, periodic_x: true, periodic_y: false };
    assert!(periodic.wall(0).is_none() && periodic.wall(1).is_none() && periodic.wall(2).is_some());
    let round = Domain::Disc { center: Point::<2>::new(0.2, -0.15), radius: 1.0 };
    assert!((gap(&round, 0) - 0.3).abs() < 1e-15);
    let tube = Domain::Cylinder { x: [-1.0, 1.0], radius: 2.0, periodic_x: false };
    let sphere = outline(Shape::Sphere { radius: 0.5 }, 0.2, 0.0, 0.0);
    for (side, wanted) in [0.7, 0.3, 1.5].into_iter().enumerate() {
        let at = closest_to_wall(&sphere, &tube.wall(side).unwrap());
        assert!((at.gap - wanted).abs() < 1e-15, "side {side}");
    }
    assert!(tube.wall(3).is_none());
    let ball = Domain::HalfDisc { center: 0.1, radius: 1.0 };
    assert!(ball.wall(1).is_none());
    let at = closest_to_wall(&sphere, &ball.wall(0).unwrap());
    assert!((at.gap - 0.4).abs() < 1e-15 && at.normal.x == -1.0);
}

#[test]
fn a_body_behind_a_wall_has_its_depth() {
    for angle in [0.0, 0.4, 1.1] {
        let body = outline(ellipse(1.0, 0.3), 0.0, 0.1, angle);
        let lowest = f64::sin(angle).hypot(0.3 * f64::cos(angle));
        let at = closest_to_wall(&body, &FLOOR);
        assert!((at.gap - (0.1 - lowest)).abs() < 1e-14);
        assert_eq!(wall_features(&body, &FLOOR, 0.01), vec![at]);
    }
}

#[test]
fn a_peanut_touches_a_wall_and_a_neighbour_twice() {
    let peanut = outline(lobed(2.0, 0.4, 24), 0.0, 1.25, 0.0);
    let lowest = closest_to_wall(&peanut, &FLOOR).gap;
    let twice = wall_features(&peanut, &FLOOR, lowest + 0.05);
    assert_eq!(twice.len(), 2, "{twice:?}");
    assert!((twice[0].first.x + twice[1].first.x).abs() < 1e-12 && twice[0].first.x < -0.5);
    assert!((twice[0].gap - twice[1].gap).abs() < 1e-14);
    // Its mirror image below the wall
    let other = outline(lobed(2.0, 0.4, 24), 0.0, -1.25, 0.0);
    let pairs = closest_features(&peanut, &other, 2.0 * lowest + 0.05);
    assert_eq!(pairs.len(), 2, "{pairs:?}");
    for (pair, single) in pairs.iter().zip(&twice) {
        assert!((pair.gap - 2.0 * single.gap).abs() < 1e-13);
        assert_is_feature(&peanut, &other, pair);
    }
}

#[test]
fn bodies_in_and_across_each_other_overlap() {
    let wide = |angle: f64| outline(ellipse(2.0, 0.2), 0.0, 0.0, angle);
    let inside = outline(ellipse(0.2, 0.1), 0.5, 0.0, 0.3);
    for (first, second) in [(wide(0.0), wide(PI / 2.0)), (wide(0.0), inside.clone())] {
        assert!(overlap(&first, &second) && overlap(&second, &first));
        assert!(closest(&first, &second).gap < 0.0);
        assert!(closest_features(&first, &second, 1e-3).iter().any(|at| at.gap < 0.0));
    }
    assert!(!overlap(&wide(0.0), &outline(ellipse(0.2, 0.1), 0.5, 0.31, 0.0)));
}

#[test]
fn the_gap_of_aligned_ellipses_is_exact_down_to_nothing_and_below() {
    for gap in [1e-3, 1e-6, 1e-9, 1e-12, 0.0, -1e-12, -1e-9, -1e-6, -1e-3] {
        let first = outline(ellipse(0.7, 0.3), 1.2 + gap, 0.0, 0.0);
        let second = outline(ellipse(0.5, 1.1), 0.0, 0.0, 0.0);
        let at = closest(&first, &second);
        assert!((at.gap - gap).abs() < 1e-15, "{gap}: {at:?}");
        assert!((at.normal - Point::<2>::new(1.0, 0.0)).norm() < 1e-14);
        assert_eq!(overlap(&first, &second), at.gap <= 0.0);
    }
}

#[test]
fn a_gap_between_parallel_sides_is_one_feature() {
    let sides = |y: f64| {
        let mut points: Vec<[f64; 2]> = Vec::new();
        for i in 0..40 {
            points.push([-2.0 + 0.1 * f64::from(i), -0.25]);
        }
        points.extend([[2.0, -0.25], [2.25, 0.0], [2.0, 0.25]]);
        for i in 1..40 {
            points.push([2.0 - 0.1 * f64::from(i), 0.25]);
        }
        points.extend([[-2.0, 0.25], [-2.25, 0.0]]);
        outline(Shape::Spline { points }, 0.0, y, 0.0)
    };
    let (above, below) = (sides(0.6), sides(0.0));
    let at = closest(&above, &below);
    // The spline swings a little about its straight sides
    assert!(at.gap > 0.09 && at.gap < 0.1, "{at:?}");
    assert_is_feature(&above, &below, &at);
    assert!(!overlap(&above, &below));
}

#[test]
fn spheroids_on_the_axis_meet_at_their_poles_or_in_a_ring() {
    let spheroid = |x: f64, semi_axes| outline(Shape::Spheroid { semi_axes }, x, 0.0, 0.0);
    let poles =
        on_meridian(closest_features(&spheroid(0.0, [1.0, 0.5]), &spheroid(1.6, [0.5, 0.7]), 0.2));
    assert_eq!(poles.len(), 1);
    assert!((poles[0].gap - 0.1).abs() < 1e-14);
    assert_eq!((poles[0].normal, poles[0].first.y), (Point::<2>::new(-1.0, 0.0), 0.0));
    // A flat spheroid in a ball is nearest to it in a ring
    let ball = Domain::HalfDisc { center: 0.0, radius: 1.0 }.wall(0).unwrap();
    let rings = on_meridian(wall_features(&spheroid(0.1, [0.2, 0.9]), &ball, 0.12));
    assert_eq!(rings.len(), 1, "{rings:?}");
    assert!(rings[0].first.y > 0.8 && rings[0].normal.y < 0.0);
}

#[test]
fn a_body_is_as_thick_as_its_thinnest_part() {
    assert!((thickness(&outline(ellipse(2.0, 0.3), 1.0, 0.0, 0.4)) - 0.6).abs() < 1e-15);
    // The waist of a peanut is 2 (1 - 0.4) thick, its ends are wider
    let peanut = thickness(&outline(lobed(2.0, 0.4, 24), 0.0, 0.0, 0.0));
    assert!((peanut - 1.2).abs() < 0.02, "{peanut}");
}

#[test]
fn mirrored_outlines_have_mirrored_features() {
    let at = |sign: f64| {
        let first = outline(ellipse(1.0, 0.4), sign * 0.3, 1.0, sign * 0.5);
        let second = outline(ellipse(0.8, 0.5), sign * -0.9, -0.1, sign * -1.2);
        closest(&first, &second)
    };
    let (right, left) = (at(1.0), at(-1.0));
    assert!((right.gap - left.gap).abs() < 1e-15);
    let mirrored = Point::<2>::new(-left.normal.x, left.normal.y);
    assert!((right.normal - mirrored).norm() < 1e-14);
}

/// Direction in which the gap to a wall grows.
fn at_wall(wall: &Wall, place: Point<2>) -> Point<2> {
    match wall {
        Wall::Line { normal, .. } => *normal,
        Wall::Circle { center, .. } => center - place,
    }
}

fn shape() -> impl Strategy<Value = Shape> {
    prop_oneof![
        (0.15f64..1.5, 0.15f64..1.5).prop_map(|(a, b)| ellipse(a, b)),
        (1u8..5, 0.0f64..0.35, 14usize..40).prop_map(|(lobes, depth, n)| lobed(
            f64::from(lobes),
            depth,
            n
        )),
    ]
}

fn pair() -> impl Strategy<Value = (Outline, Outline)> {
    let angles = (0.0..TAU, 0.0..TAU, 0.0..TAU);
    (shape(), shape(), angles, -0.1f64..0.5).prop_map(|(one, other, (direction, a, b), wanted)| {
        let first = outline(one, 0.2, -0.1, a);
        let (dx, dy) = (direction.cos(), direction.sin());
        // Far apart first, then nearer by the gap that is too much along the line of centres
        let mut distance = first.reach() + 4.0;
        for _ in 0..3 {
            let second = outline(other.clone(), 0.2 + distance * dx, -0.1 + distance * dy, b);
            distance -= closest(&first, &second).gap - wanted.max(0.0);
        }
        distance += wanted.min(0.0);
        let second = outline(other, 0.2 + distance * dx, -0.1 + distance * dy, b);
        (first, second)
    })
}

proptest! {
    #![proptest_config(ProptestConfig {
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(1714),
        ..ProptestConfig::with_cases(400)
    })]

    #[test]
    fn the_closest_points_are_those_of_dense_sampling((first, second) in pair()) {
        let n = 2000;
        let gaps = distances(&first, &second, n);
        let sampled = gaps.iter().copied().fold(f64::INFINITY, f64::min);
        let at = closest(&first, &second);
        if sampled <= 0.0 {
            prop_assert!(at.gap <= 0.0, "{at:?} {sampled}");
            prop_assert!(overlap(&first, &second));
        } else {
            // Below the samples, by the square of their spacing at most
            let step = gaps.iter().zip(gaps.iter().skip(1)).fold(0.0f64, |s, (a, b)| s.max((a - b).abs()));
            prop_assert!(at.gap <= sampled + 1e-13 && at.gap > sampled - step, "{at:?} {sampled}");
            prop_assert!((second.nearest(at.first).gap - at.gap).abs() < 1e-12);
            prop_assert!((first.nearest(at.second).gap - at.gap).abs() < 1e-12);
            assert_is_feature(&first, &second, &at);
            prop_assert_eq!(overlap(&first, &second), at.gap <= 0.0);
        }
        let back = closest(&second, &first);
        if sampled > 0.0 {
            prop_assert!((back.gap - at.gap).abs() < 1e-13);
        }
    }

    #[test]
    fn no_minimum_below_the_range_is_missed((first, second) in pair(), range in 0.05f64..0.6) {
        let n = 1500;
        let found = closest_features(&first, &second, range);
        for at in found.iter().filter(|at| at.gap > 0.0) {
            assert_is_feature(&first, &second, at);
            prop_assert!(at.gap < range);
        }
        let gaps = [distances(&first, &second, n), distances(&second, &first, n)];
        prop_assume!(gaps[0].iter().all(|gap| *gap > 0.0));
        for (one, side, gaps) in [(&first, 0, &gaps[0]), (&second, 1, &gaps[1])] {
            // The kink where two features are as near is a maximum, so all minima are features
            for (place, gap) in sampled_minima(one, gaps, range - 1e-3) {
                let is_known = found.iter().any(|at| {
                    let point = if side == 0 { at.first } else { at.second };
                    (point - place).norm() < 0.02
                });
                prop_assert!(is_known, "{place} {gap}\n{found:#?}");
            }
        }
    }

    #[test]
    fn walls_are_met_as_by_dense_sampling(
        shape in shape(), angle in 0.0..TAU, height in 0.2f64..1.8, is_round in any::<bool>(),
    ) {
        let center = Point::<2>::new(0.1, 2.0);
        let wall = if is_round { Wall::Circle { center, radius: 2.5 } } else { FLOOR };
        let body = outline(shape, 0.3, height, angle);
        let n = 4000_u16;
        let parameter = |i: usize| body.period() * i as f64 / f64::from(n);
        let gaps: Vec<f64> = (0..usize::from(n)).map(|i| wall.gap(body.at(parameter(i))[0])).collect();
        let sampled = gaps.iter().copied().fold(f64::INFINITY, f64::min);
        let at = closest_to_wall(&body, &wall);
        prop_assert!(at.gap <= sampled + 1e-14 && at.gap > sampled - 1e-4, "{at:?} {sampled}");
        prop_assert!((wall.gap(at.first) - at.gap).abs() < 1e-14);
        let range = sampled.abs() + 0.3;
        let found = wall_features(&body, &wall, range);
        for (place, gap) in sampled_minima(&body, &gaps, range - 1e-3) {
            if body.nearest(place).normal.dot(&at_wall(&wall, place)) > 0.0 {
                // A dent on the far side of the body does not face the wall
                continue;
            }
            let is_known = found.iter().any(|at| (at.first - place).norm() < 0.02);
            prop_assert!(is_known, "{place} {gap}\n{found:#?}");
        }
    }
}
