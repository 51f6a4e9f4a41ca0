//! The surface about a rod in space, and its ends.

use nalgebra::{DVector, Matrix3, Rotation3, Vector3, Vector6};

use super::common::{along_x, simple, straight};
use crate::rod::tests::common::{scatter, unit};
use crate::rod::{
    Along, Axes, End, RodProperties, SpatialEndLoad, SpatialEndPose, SpatialLoadedEnd,
    SpatialRodBody, SpatialSectionPoint, Support, Supports,
};
use crate::structure::{BaseMotion, Flexible, Structure};

#[test]
fn rows_are_derivatives_of_places() {
    for rod in [simple(2), simple(2).clamped(End::Base)] {
        let q = along_x(&rod) + scatter(rod.n_coordinates(), 0.5) * 0.15;
        for (along, offset) in [(0.0, [0.1, 0.0]), (0.21, [-0.1, 0.3]), (1.0, [0.2, 0.1])] {
            let point = SpatialSectionPoint { along, offset };
            let rows = rod.surface(&q, point);
            for i in 0..18 {
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
    let rod = simple(4);
    let turning = [1.0, -2.0, 3.0].map(Along::Constant);
    let rotation = Rotation3::new(Vector3::new(0.3, 0.2, -0.5));
    let q = rod.curved(Vector3::new(0.1, 0.2, 0.3), rotation, &turning);
    let (drift, spin) = (Vector3::new(0.3, 0.1, -0.2), Vector3::new(1.0, -0.5, 0.7));
    let mut v = DVector::zeros(q.len());
    for i in (0..q.len()).step_by(3) {
        let shift = if i % 9 == 0 { drift } else { Vector3::zeros() };
        let velocity = spin.cross(&q.fixed_rows::<3>(i)) + shift;
        v.fixed_rows_mut::<3>(i).copy_from(&velocity);
    }
    for along in [0.0, 0.13, 0.77, 1.0] {
        let at = rod.surface(&q, SpatialSectionPoint { along, offset: [0.05, -0.02] });
        let error = (at.velocity(&v) - spin.cross(&at.place) - drift).norm();
        assert!(error < 1e-14, "the velocity is off by {error:.1e}");
    }
}

#[test]
fn an_end_on_a_body_has_the_velocity_of_the_body() {
    let rod = simple(2);
    let body = SpatialEndPose {
        place: Vector3::new(1.0, 2.0, 3.0),
        velocity: Vector3::new(0.1, 0.2, 0.3),
        rotation: Rotation3::new(Vector3::new(0.4, -0.3, 0.2)),
        angular_velocity: Vector3::new(-1.0, 0.5, 2.0),
    };
    let end = body.attached(Vector3::new(0.5, 0.0, 0.1), Rotation3::new(Vector3::z()));
    let held = rod.held(End::Tip, Support::Clamped, &end);
    let mut rates = Vector6::zeros();
    rates.fixed_rows_mut::<3>(0).copy_from(&end.velocity);
    rates.fixed_rows_mut::<3>(3).copy_from(&end.angular_velocity);
    let by_rows = end.rows() * rates;
    for (i, given) in held.iter().enumerate() {
        assert_eq!(given.coordinate, 18 + i);
        assert!((given.rate - by_rows[i]).abs() < 1e-14, "{given:?} but {}", by_rows[i]);
    }
    // A short time later
    let (step, turn) = (1e-6, Rotation3::new(body.angular_velocity * 1e-6));
    let later = SpatialEndPose {
        place: body.place + body.velocity * step,
        rotation: turn * body.rotation,
        ..body
    };
    let later = later.attached(Vector3::new(0.5, 0.0, 0.1), Rotation3::new(Vector3::z()));
    for (now, then) in held.iter().zip(rod.held(End::Tip, Support::Clamped, &later)) {
        let rate = (then.value - now.value) / step;
        assert!((rate - now.rate).abs() < 1e-5, "{now:?} but {rate}");
    }
}

/// Whatever the vectors across are.
#[test]
fn the_base_of_a_rod_has_the_rigid_motion_it_is_in() {
    let rod = simple(3);
    let rotation = Rotation3::new(Vector3::new(0.3, 0.2, -0.5));
    let curved =
        rod.curved(Vector3::new(0.1, 0.2, 0.3), rotation, &[1.0, -2.0, 3.0].map(Along::Constant));
    let q = &curved + scatter(curved.len(), 0.5) * 0.1;
    let body = SpatialRodBody::new(rod, SpatialEndPose::default(), Supports::FREE);
    let motion = BaseMotion {
        place: q.fixed_rows::<3>(0).into_owned(),
        velocity: Vector3::new(0.3, 0.1, -0.2),
        angular_velocity: Vector3::new(1.0, -0.5, 0.7),
    };
    let rates = body.rigid_velocities(&q, &motion).expect("it is known");
    let found = body.base(&q, &rates).expect("it has a base");
    assert_eq!(found.place, motion.place);
    assert!((found.velocity - motion.velocity).norm() < 1e-15);
    assert!((found.angular_velocity - motion.angular_velocity).norm() < 1e-13, "{found:?}");
    // Inner forces do no work in it
    let power = body.forces(&q, &DVector::zeros(q.len()), 0.0).dot(&rates);
    assert!(power.abs() < 1e-8 * body.elastic_energy(&q, 0.0), "{power}");
}

/// Whatever the tangent and the vector across are: against the velocity and the turn of the frame there, and the tangent against
/// differences.
#[test]
fn a_load_at_an_end_does_its_work_there() {
    // So that loads are not small differences of forces
    let rod = straight(RodProperties { stretching: 1.0, ..unit(3) });
    let q = along_x(&rod) + scatter(rod.n_coordinates(), 0.5) * 0.1;
    let rates = scatter(rod.n_coordinates(), 1.3);
    let body = || SpatialRodBody::new(rod.clone(), SpatialEndPose::default(), Supports::FREE);
    let load = |time: f64| SpatialEndLoad {
        force: Vector3::new(0.3, -0.2, 0.5) * time,
        moment: Vector3::new(-0.7, 0.4, 0.2) * time,
    };
    let ends =
        [Axes::Fixed, Axes::OfSection].map(|axes| [End::Base, End::Tip].map(|end| (end, axes)));
    for (end, axes) in ends.into_iter().flatten() {
        let at_end = SpatialLoadedEnd { end, axes, load: Box::new(load) };
        let loaded = body().with_loaded_ends(vec![at_end]);
        let without = body().forces(&q, &rates, 2.0);
        let change =
            |q: &DVector<f64>| loaded.forces(q, &rates, 2.0) - body().forces(q, &rates, 2.0);
        // Inner forces are large, as stretched rods are stiff
        let rounding = 4.0 * f64::EPSILON * without.norm() * rates.norm();
        let power = loaded.inner_power(&q, &rates, 2.0).ends;
        assert!((change(&q).dot(&rates) + power).abs() < rounding.max(1e-12), "{power}");
        let turn = match axes {
            Axes::Fixed => Matrix3::identity(),
            Axes::OfSection => frame_at(&q, rod.first_coordinate(end)),
        };
        let SpatialEndLoad { force, moment } = load(2.0);
        let [force, moment] = [force, moment].map(|of| turn * of);
        assert!((loaded.given_load(&q, 2.0).force - force).norm() < 1e-14);
        assert!((loaded.given_load(&q, 2.0).moment - moment).norm() < 1e-14);
        // The frame at the tip is that at the base of the rod the other way round
        let end_rates = |of: &DVector<f64>| match end {
            End::Base => of.clone(),
            End::Tip => DVector::from_fn(of.len(), |i, _| of[27 - 9 * (i / 9) + i % 9]),
        };
        let motion = body().base(&end_rates(&q), &end_rates(&rates)).expect("it has a base");
        let exact = force.dot(&motion.velocity) + moment.dot(&motion.angular_velocity);
        assert!((power - exact).abs() < 1e-12, "{power} {exact}");
        let stiffness = |of: &SpatialRodBody| of.tangents(&q, &rates, 2.0).stiffness;
        let added = stiffness(&loaded) - stiffness(&body());
        let small = 1e-6;
        for i in 0..q.len() {
            let moved = |by: f64| {
                let mut q = q.clone();
                q[i] += by;
                loaded.forces(&q, &rates, 2.0) - body().forces(&q, &rates, 2.0)
            };
            let slope = (moved(small) - moved(-small)) / (2.0 * small);
            assert!((slope - added.column(i)).amax() < 1e-4, "{i}");
        }
    }
}

/// The tangent, d1 and d2 at an end, whose first coordinate is given.
fn frame_at(q: &DVector<f64>, first: usize) -> Matrix3<f64> {
    let [tangent, across] = [3, 6].map(|from| q.fixed_rows::<3>(first + from).into_owned());
    let second = tangent.cross(&across).normalize();
    let tangent = tangent.normalize();
    Matrix3::from_columns(&[tangent, second.cross(&tangent), second])
}
