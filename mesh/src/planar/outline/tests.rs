//! Nearest places, parameters and cuts of outlines of all kinds.

use super::*;
use crate::planar::vector::cross;

fn ellipse(a: f64, b: f64) -> PlacedShape {
    PlacedShape {
        name: "body".into(),
        shape: Shape::Ellipse { semi_axes: [a, b] },
        center: Point::<2>::new(0.3, -0.2),
        angle: 0.7,
        size: None,
    }
}

#[test]
fn the_nearest_point_of_an_ellipse_is_the_foot_of_its_normal() {
    for (a, b) in [(2.0, 1.0), (0.5, 1.5), (1.0, 1.0), (10.0, 0.1)] {
        let outline = Outline::new(&ellipse(a, b)).unwrap();
        for quarter in 0..4 {
            for i in 0..20 {
                let [on, first, second] = outline.evaluate(quarter, f64::from(i) / 20.0);
                let normal = Point::<2>::new(first.y, -first.x).normalize();
                let nearest = outline.nearest(on + normal * 0.37);
                assert!((nearest.point - on).norm() < 1e-7 * a.max(b), "{a} {b}");
                assert!((nearest.gap - 0.37).abs() < 1e-12, "{a} {b} {}", nearest.gap);
                assert!((nearest.normal - normal).norm() < 1e-6);
                let curvature = cross(first, second) / first.norm().powi(3);
                assert!((nearest.curvature / curvature - 1.0).abs() < 1e-4);
            }
        }
        assert!(outline.nearest(outline.center).gap < 0.0);
    }
}

/// Also next to the axes, where one coordinate is nothing but rounding.
#[test]
fn points_of_an_ellipse_have_no_gap_and_those_on_its_axes_the_right_one() {
    for (a, b) in [(2.0, 1.0), (0.3, 0.789), (10.0, 0.1)] {
        let outline = Outline::new(&ellipse(a, b)).unwrap();
        for i in 0..192 {
            let on = outline.evaluate(i / 48, (i % 48) as f64 / 48.0)[0];
            let gap = outline.nearest(on).gap;
            assert!(gap.abs() < 1e-14 * a.max(b), "{a} {b} {i}: {gap:e}");
        }
    }
    for y in [0.0, 1e-300, 1e-20, 1e-17, 1e-12] {
        let foot = ellipse::foot_on_ellipse(2.0, 1.0, 0.75, y);
        // On the axis inside the centre of curvature the feet are those of a^2 x / (a^2 - b^2)
        assert!((foot - Point::<2>::new(1.0, 0.75_f64.sqrt())).norm() < 1e-11, "{y}: {foot}");
    }
}

#[test]
fn a_spline_is_cut_at_its_extreme_points() {
    let points = (0..12)
        .map(|i| std::f64::consts::TAU * f64::from(i) / 12.0 + 0.1)
        .map(|t| [2.0 * t.cos() + 0.2 * (2.0 * t).cos(), t.sin()])
        .collect();
    let body = PlacedShape { shape: Shape::Spline { points }, angle: 0.0, ..ellipse(1.0, 1.0) };
    let outline = Outline::new(&body).unwrap();
    for (quarter, axis) in [(0, 0), (1, 1), (2, 0), (3, 1)] {
        assert!(outline.evaluate(quarter, 0.0)[1][axis].abs() < 1e-12);
    }
    let nearest = outline.nearest(Point::<2>::new(5.0, 1.0));
    let around = (0..4000).map(|i| outline.evaluate(i / 1000, (i % 1000) as f64 / 1000.0)[0]);
    let closest = around.map(|p| (p - Point::<2>::new(5.0, 1.0)).norm()).reduce(f64::min);
    assert!((nearest.gap - closest.unwrap()).abs() < 1e-5);
}

/// A pear, either way round: of its quarters, and of the feet of places on the axis and beside it.
#[test]
fn a_turned_profile_is_the_same_on_both_sides_of_the_axis_and_ends_on_it() {
    let pear = vec![[-1.0, 0.0], [-0.8, 0.4], [-0.1, 0.7], [0.9, 0.3], [1.6, 0.2], [1.9, 0.0]];
    let backwards: Vec<[f64; 2]> = pear.iter().rev().copied().collect();
    let turned = |profile: &[[f64; 2]]| {
        let shape = Shape::Revolved { profile: profile.to_vec() };
        let center = Point::<2>::new(0.3, 0.0);
        Outline::new(&PlacedShape { shape, center, angle: 0.0, ..ellipse(1.0, 1.0) }).unwrap()
    };
    let outline = turned(&pear);
    assert_eq!(outline, turned(&backwards));
    let ends = [0, 2].map(|quarter| outline.evaluate(quarter, 0.0)[0]);
    assert_eq!(ends, [[1.9 + 0.3, 0.0], [-1.0 + 0.3, 0.0]].map(Point::<2>::from));
    assert_eq!(outline.evaluate(1, 1.0)[0], ends[1]);
    let mirrored = |place: Point<2>| Point::<2>::new(place.x, -place.y);
    for i in 0..=40 {
        let along = f64::from(i) / 40.0;
        for (upper, lower) in [(0, 3), (1, 2)] {
            let places =
                [outline.evaluate(upper, along)[0], outline.evaluate(lower, 1.0 - along)[0]];
            assert!((places[0] - mirrored(places[1])).norm() < 1e-14, "{places:?}");
            assert!(places[0].y >= 0.0, "{places:?}");
        }
        // Of a place on the axis the foot is above it, or exactly on it
        let on_axis = outline.nearest(Point::<2>::new(6.0 * along - 3.0, 0.0));
        let is_beyond = [ends[0].x, ends[1].x].contains(&on_axis.point.x);
        assert!(on_axis.point.y > 1e-3 || (on_axis.point.y == 0.0 && is_beyond), "{on_axis:?}");
        for y in [1e-13, 0.1, 2.0] {
            let place = Point::<2>::new(6.0 * along - 3.0, y);
            let feet = [outline.nearest(place), outline.nearest(mirrored(place))];
            assert!((feet[0].point - mirrored(feet[1].point)).norm() < 1e-11, "{feet:?}");
            assert!(feet[0].point.y > -1e-13, "{feet:?}");
        }
    }
    for end in ends {
        assert_eq!(outline.nearest(end).point, end);
    }
}

#[test]
fn a_figure_of_eight_is_refused() {
    let points = vec![[2.0, -1.0], [2.0, 1.0], [-2.0, -1.5], [-2.0, 1.5]];
    let body = PlacedShape { shape: Shape::Spline { points }, ..ellipse(1.0, 1.0) };
    let error = Outline::new(&body).unwrap_err();
    let clockwise_or_crossing =
        matches!(error, MeshError::SelfIntersection { .. } | MeshError::Body { .. });
    assert!(clockwise_or_crossing, "{error}");
}

#[test]
fn the_parameter_of_a_place_on_the_outline_gives_it_back() {
    let fish = crate::FishForm {
        length: 1.0,
        head_width: 0.04,
        tail_width: 0.01,
        head_end: 0.04,
        tail_start: 0.95,
        tip_radius: 1e-3,
        corner_radius: 0.01,
    };
    let spline = Arc::new(crate::Profile::fish(&fish).unwrap().spline().unwrap());
    let fish = PlacedShape { shape: Shape::Curve { spline }, ..ellipse(1.0, 1.0) };
    for body in [ellipse(2.0, 0.5), ellipse(0.3, 1.2), ellipse(0.7, 0.7), fish] {
        let outline = Outline::new(&body).unwrap();
        let period = outline.period();
        for i in 0..1000 {
            let wanted = period * f64::from(i) / 1000.0;
            let found = outline.parameter_of(outline.at(wanted)[0]);
            let off = (found - wanted).abs();
            let off = off.min(period - off);
            assert!(off < 1e-13 * period, "{i}: {found} for {wanted}");
        }
    }
}
