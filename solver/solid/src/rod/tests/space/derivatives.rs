//! Forces and tangents of rods in space against differences, and rigid motions.

use nalgebra::{DMatrix, DVector, Rotation3, Vector3};

use super::common::{along_x, carried, simple};
use crate::rod::tests::common::{scatter, unit};
use crate::rod::tests::derivatives::{assert_same, jacobian};
use crate::rod::{
    Along, End, Field, Flexure, Resistance, RodProperties, SpatialProperties, SpatialRod, Varying,
};
use crate::structure::{Load, Structure};

/// A rod with all that one in space can have.
fn whole() -> SpatialRod {
    let rod = RodProperties { damping: 0.3, stretching: 50.0, ..unit(2) };
    let flexure = |stiffness: f64| Flexure {
        stiffness: Along::Table(vec![[0.0, stiffness], [1.0, 2.0 * stiffness]]),
        rest: Field::in_time(|s, t| Varying { value: s * t.sin(), rate: s * t.cos() }),
        moment: Field::in_time(|s, t| Varying { value: (s - t).cos(), rate: (s - t).sin() }),
    };
    let bending = [flexure(1.0), flexure(1.5)];
    SpatialRod::new(SpatialProperties { rod, bending, twisting: flexure(0.7) })
        .expect("there is such a rod")
}

/// Free, and clamped at its ends.
fn full() -> [SpatialRod; 3] {
    [whole(), whole().clamped(End::Base), whole().clamped(End::Base).clamped(End::Tip)]
}

/// Coordinates near those of a straight rod.
fn scattered(rod: &SpatialRod, seed: f64) -> DVector<f64> {
    along_x(rod) + scatter(rod.n_coordinates(), seed) * 0.15
}

#[test]
fn tangents_are_derivatives_of_forces() {
    for rod in full() {
        let (q, v) = (scattered(&rod, 0.0), scatter(rod.n_coordinates(), 1.0));
        let tangents = rod.tangents(&q, &v, 0.7);
        assert_same(&tangents.stiffness, &jacobian(&q, |q| rod.forces(q, &v, 0.7)));
        assert_same(&tangents.damping, &jacobian(&v, |v| rod.forces(&q, v, 0.7)));
    }
}

#[test]
fn tangents_of_drag_are_its_derivatives() {
    let rod = simple(2);
    let drag = Resistance::new(&rod, 1.0, 1.7);
    let (q, v) = (scattered(&rod, 2.0), scatter(rod.n_coordinates(), 3.0));
    let tangents = drag.tangents(&q, &v, 0.0);
    assert_same(&tangents.stiffness, &jacobian(&q, |q| drag.load(q, &v, 0.0)));
    assert_same(&tangents.damping, &jacobian(&v, |v| drag.load(&q, v, 0.0)));
}

#[test]
fn passive_forces_are_the_gradient_of_the_energy() {
    for rod in [simple(2), simple(2).clamped(End::Base)] {
        let q = scattered(&rod, 4.0);
        let energy = |q: &DVector<f64>| DVector::from_element(1, rod.elastic_energy(q, 0.0));
        let forces = rod.forces(&q, &DVector::zeros(q.len()), 0.0);
        assert_same(&DMatrix::from_rows(&[forces.transpose()]), &jacobian(&q, energy));
    }
}

#[test]
fn a_rigid_motion_costs_no_energy() {
    for rod in full() {
        let q = scattered(&rod, 5.0);
        let rotation = Rotation3::new(Vector3::new(2.0, -1.0, 0.5));
        let turned = carried(&q, &rotation, Vector3::new(3.0, -2.0, 1.0));
        let (before, after) = (rod.elastic_energy(&q, 0.2), rod.elastic_energy(&turned, 0.2));
        assert!((before - after).abs() < 1e-12 * before, "{before} became {after}");
    }
}

#[test]
fn inner_forces_have_no_resultant_and_no_moment() {
    for rod in full() {
        let (q, v) = (scattered(&rod, 6.0), scatter(rod.n_coordinates(), 7.0));
        let forces = rod.forces(&q, &v, 0.3);
        let (mut resultant, mut moment) = (Vector3::zeros(), Vector3::zeros());
        for i in (0..q.len()).step_by(3) {
            let force = forces.fixed_rows::<3>(i).into_owned();
            moment += q.fixed_rows::<3>(i).into_owned().cross(&force);
            if i % 9 == 0 {
                resultant += force;
            }
        }
        let errors = [resultant.amax(), moment.amax()];
        assert!(errors[0].max(errors[1]) < 1e-11 * forces.amax(), "{errors:?}");
    }
}
