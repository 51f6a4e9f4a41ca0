//! Rods as bodies in a flow: points by their places at rest, centres, supports.

use nalgebra::{DVector, Rotation3, Vector2, Vector3};

use super::common::{planar, unit};
use super::space::common::simple;
use crate::rod::{
    Along, End, EndPose, LineForce, PlanarRodBody, RodProperties, SpatialEndPose, SpatialRodBody,
    Support, Supports,
};
use crate::structure::{Flexible, Structure, weighted};

/// A rod on a base that turns, which starts bent.
fn turning() -> PlanarRodBody {
    let base = EndPose { place: Vector2::new(0.3, -0.2), angle: 0.4, ..EndPose::default() };
    let supports = Supports::one(End::Base, Support::Clamped, move |time| EndPose {
        angle: 0.4 + 0.1 * time,
        angular_velocity: 0.1,
        ..base
    });
    let rod = planar(unit(6));
    let bent = rod.curved(base.place, base.angle, &Along::Constant(1.5));
    PlanarRodBody::new(rod, base, supports).starting(bent)
}

fn in_space() -> SpatialRodBody {
    let rotation = Rotation3::new(Vector3::new(0.2, 0.5, -0.3));
    let base = SpatialEndPose {
        place: Vector3::new(0.3, -0.2, 0.1),
        rotation,
        ..SpatialEndPose::default()
    };
    let rod = simple(3);
    let bent = rod.curved(base.place, rotation, &[1.0, -2.0, 0.5].map(Along::Constant));
    SpatialRodBody::new(rod, base, Supports::FREE).starting(bent)
}

/// Compares weights with differences of places, and with what they do to a shift.
fn check(body: &dyn Flexible, rest: &Vector3<f64>) {
    let q = body.initial();
    for at in body.weights(&q, rest) {
        let moved = |by: f64| {
            let mut q = q.clone();
            q[at.coordinate] += by;
            body.place(&q, rest)
        };
        let difference = (moved(1e-6) - moved(-1e-6)) / 2e-6;
        assert!((difference - at.weight).norm() < 1e-8, "{at:?} but {difference}");
    }
}

#[test]
fn weights_are_derivatives_of_places() {
    let rest = Vector3::new(0.3 + 0.5 * 0.4_f64.cos(), -0.2 + 0.5 * 0.4_f64.sin(), 0.0);
    check(&turning(), &(rest + Vector3::new(0.01, 0.02, 0.0)));
    check(&in_space(), &Vector3::new(0.7, -0.3, 0.2));
}

#[test]
fn a_straight_rod_has_its_points_where_they_are_at_rest() {
    let body = PlanarRodBody::new(
        planar(unit(3)),
        EndPose { place: Vector2::new(1.0, 2.0), angle: -0.7, ..EndPose::default() },
        Supports::FREE,
    );
    let rest = Vector3::new(1.4, 1.7, 0.0);
    assert!((body.place(&body.initial(), &rest) - rest).norm() < 1e-14);
    let base = SpatialEndPose { place: Vector3::y(), ..SpatialEndPose::default() };
    let body = SpatialRodBody::new(simple(3), base, Supports::FREE);
    let rest = Vector3::new(0.4, 1.1, -0.2);
    assert!((body.place(&body.initial(), &rest) - rest).norm() < 1e-14);
}

#[test]
fn centers_are_those_of_mass_or_of_length() {
    let heavy_tip = RodProperties { mass: Along::function(|s| s), ..unit(4) };
    let massless = RodProperties { mass: Along::Constant(0.0), ..unit(4) };
    for (rod, expected) in [(unit(4), 0.5), (heavy_tip, 2.0 / 3.0), (massless, 0.5)] {
        let body = PlanarRodBody::new(planar(rod), EndPose::default(), Supports::FREE);
        let center = weighted(&body.center_weights(), &body.initial());
        assert!((center - Vector3::x() * expected).norm() < 1e-12, "{center}");
    }
    let body = in_space();
    let q = body.initial();
    let (center, rod) = (weighted(&body.center_weights(), &q), body.rod());
    let mean: Vector3<f64> =
        (0..400).map(|i| rod.place(&q, (f64::from(i) + 0.5) / 400.0) / 400.0).sum();
    assert!((center - mean).norm() < 1e-5, "{center} but {mean}");
}

#[test]
fn supports_hold_the_same_coordinates_at_any_time() {
    let body = turning();
    let (now, later) = (body.held(0.0), body.held(2.0));
    let numbers = |held: &[crate::structure::Held]| -> Vec<usize> {
        held.iter().map(|given| given.coordinate).collect()
    };
    assert_eq!(numbers(&now), [0, 1, 2, 3]);
    assert_eq!(numbers(&now), numbers(&later));
    assert!((later[2].value - 0.6_f64.cos()).abs() < 1e-15, "{:?}", later[2]);
}

#[test]
fn weight_is_a_part_of_the_forces() {
    let body = turning();
    let weight = LineForce::new(body.rod(), &[0.0, -2.0], &[0.0, 0.0]);
    let (q, still) = (body.initial(), DVector::zeros(body.n_coordinates()));
    let before = body.forces(&q, &still, 0.0);
    let after = body.loaded(weight).forces(&q, &still, 0.0);
    let lifted: f64 = (after - before).iter().skip(1).step_by(4).sum();
    assert!((lifted - 2.0).abs() < 1e-12, "the weight is {lifted}");
}
