//! The surface about a rod.

use std::f64::consts::PI;

use nalgebra::{DVector, Vector2};

use super::common::{along_x, assert_near, cantilever, planar, scatter, unit};
use crate::rod::{Along, End, RoundedStrip, SectionPoint};
use crate::structure::Structure;

#[test]
fn rows_are_derivatives_of_places() {
    for rod in [planar(unit(3)), cantilever(unit(3)), cantilever(unit(3)).clamped(End::Tip)] {
        let q = along_x(&rod) + scatter(rod.n_coordinates(), 0.5) * 0.2;
        for (along, offset) in [(0.0, 0.1), (0.21, -0.3), (0.5, 0.0), (1.0, 0.2)] {
            let point = SectionPoint { along, offset };
            let rows = rod.surface(&q, point);
            for i in 0..8 {
                let moved = |by: f64| {
                    let mut q = q.clone();
                    q[rows.first + i] += by;
                    rod.surface(&q, point).place
                };
                let difference = (moved(1e-6) - moved(-1e-6)) / 2e-6;
                let error = (difference - rows.weights.column(i)).norm();
                assert!(error < 1e-8, "weight {i} at {along} is off by {error:.1e}");
            }
        }
    }
}

#[test]
fn points_of_a_rod_that_turns_move_like_a_rigid_body() {
    let rod = planar(unit(5));
    let q = rod.curved(Vector2::new(0.3, -0.2), 0.4, &Along::Constant(2.0));
    // Velocities of a turn about the origin, and a drift
    let v = DVector::from_fn(q.len(), |i, _| {
        let drift = if i % 4 < 2 { 0.7 } else { 0.0 };
        drift + if i % 2 == 0 { -q[i + 1] } else { q[i - 1] }
    });
    for along in [0.0, 0.13, 0.77, 1.0] {
        let at = rod.surface(&q, SectionPoint { along, offset: 0.05 });
        let rigid = Vector2::new(0.7 - at.place.y, 0.7 + at.place.x);
        let error = (at.velocity(&v) - rigid).norm();
        assert!(error < 1e-14, "the velocity is off by {error:.1e}");
    }
}

#[test]
fn a_rounded_strip_has_its_area_and_perimeter_however_it_bends() {
    const POINTS: u32 = 4000;
    let rod = planar(unit(10));
    let strip = RoundedStrip { length: 1.0, half_width: 0.05 };
    let area = 2.0 * 0.05 * 0.9 + PI * 0.05 * 0.05;
    for curvature in [0.0, 3.0] {
        let q = rod.curved(Vector2::zeros(), 0.0, &Along::Constant(curvature));
        let place = |i: u32| {
            let part = f64::from(i) / f64::from(POINTS);
            rod.surface(&q, strip.outline(part * strip.perimeter())).place
        };
        let (mut enclosed, mut around) = (0.0, 0.0);
        for i in 0..POINTS {
            let (a, b) = (place(i), place(i + 1));
            enclosed += 0.5 * (a.x * b.y - a.y * b.x);
            around += (b - a).norm();
        }
        // Bending keeps both: what one side loses the other gains
        assert_near(enclosed, area, 1e-4);
        assert_near(around, strip.perimeter(), 1e-3);
    }
}

#[test]
fn widths_of_a_rounded_strip_are_those_of_its_outline() {
    let strip = RoundedStrip { length: 2.0, half_width: 0.3 };
    for i in 0..40 {
        let point = strip.outline(0.1234 * f64::from(i));
        let width = strip.half_width_at(point.along);
        assert!((point.offset.abs() - width).abs() < 1e-12, "{point:?} but {width}");
    }
}
