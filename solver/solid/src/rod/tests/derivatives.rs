//! Forces and tangents against differences of energies and forces.

use nalgebra::{DMatrix, DVector};

use super::common::{along_x, bending, planar, scatter, unit};
use crate::rod::{Along, End, Field, Flexure, PlanarRod, Resistance, RodProperties, Varying};
use crate::structure::{Load, Structure};

/// A rod with all that a planar one can have.
fn whole() -> PlanarRod {
    let rod = RodProperties { damping: 0.3, stretching: 50.0, ..unit(3) };
    bending(
        rod,
        Flexure {
            stiffness: Along::Table(vec![[0.0, 1.0], [0.4, 2.0], [1.0, 0.5]]),
            rest: Field::in_time(|s, t| Varying { value: s * t.sin(), rate: s * t.cos() }),
            moment: Field::in_time(|s, t| Varying { value: (s - t).cos(), rate: (s - t).sin() }),
        },
    )
}

/// Free, and clamped at its ends.
fn full() -> [PlanarRod; 3] {
    [whole(), whole().clamped(End::Base), whole().clamped(End::Base).clamped(End::Tip)]
}

/// Derivative of a vector by another one, by central differences.
pub fn jacobian(
    at: &DVector<f64>,
    function: impl Fn(&DVector<f64>) -> DVector<f64>,
) -> DMatrix<f64> {
    const STEP: f64 = 1e-5;
    let columns: Vec<DVector<f64>> = (0..at.len())
        .map(|i| {
            let (mut up, mut down) = (at.clone(), at.clone());
            up[i] += STEP;
            down[i] -= STEP;
            (function(&up) - function(&down)) / (2.0 * STEP)
        })
        .collect();
    DMatrix::from_columns(&columns)
}

#[track_caller]
pub fn assert_same(exact: &DMatrix<f64>, difference: &DMatrix<f64>) {
    let error = (exact - difference).amax() / exact.amax();
    assert!(error < 1e-7, "derivatives differ from differences by {error:.1e}");
}

#[test]
fn tangents_are_derivatives_of_forces() {
    for rod in full() {
        let q = along_x(&rod) + scatter(rod.n_coordinates(), 0.0) * 0.2;
        let v = scatter(rod.n_coordinates(), 1.0);
        let tangents = rod.tangents(&q, &v, 0.7);
        assert_same(&tangents.stiffness, &jacobian(&q, |q| rod.forces(q, &v, 0.7)));
        assert_same(&tangents.damping, &jacobian(&v, |v| rod.forces(&q, v, 0.7)));
    }
}

#[test]
fn tangents_of_drag_are_its_derivatives() {
    let rod = planar(unit(3));
    let drag = Resistance::new(&rod, 1.0, 1.7);
    let q = along_x(&rod) + scatter(rod.n_coordinates(), 2.0) * 0.2;
    let v = scatter(rod.n_coordinates(), 3.0);
    let tangents = drag.tangents(&q, &v, 0.0);
    assert_same(&tangents.stiffness, &jacobian(&q, |q| drag.load(q, &v, 0.0)));
    assert_same(&tangents.damping, &jacobian(&v, |v| drag.load(&q, v, 0.0)));
}

#[test]
fn passive_forces_are_the_gradient_of_the_energy() {
    let soft = || RodProperties { stretching: 50.0, ..unit(3) };
    let single = RodProperties { elements: 1, ..soft() };
    for rod in [
        planar(soft()),
        planar(soft()).clamped(End::Tip),
        planar(single).clamped(End::Base).clamped(End::Tip),
    ] {
        let q = along_x(&rod) + scatter(rod.n_coordinates(), 4.0) * 0.2;
        let energy = |q: &DVector<f64>| DVector::from_element(1, rod.elastic_energy(q, 0.0));
        let forces = rod.forces(&q, &DVector::zeros(q.len()), 0.0);
        assert_same(&DMatrix::from_rows(&[forces.transpose()]), &jacobian(&q, energy));
    }
}

#[test]
fn a_rigid_motion_costs_no_energy() {
    for rod in full() {
        let q = along_x(&rod) + scatter(rod.n_coordinates(), 5.0) * 0.2;
        let (sin, cos) = 1.1_f64.sin_cos();
        let turned = DVector::from_fn(q.len(), |i, _| {
            let (x, y) = (q[i - i % 2], q[i - i % 2 + 1]);
            let place = if i % 4 < 2 { 3.0 } else { 0.0 };
            place + if i % 2 == 0 { cos * x - sin * y } else { sin * x + cos * y }
        });
        let (before, after) = (rod.elastic_energy(&q, 0.2), rod.elastic_energy(&turned, 0.2));
        assert!((before - after).abs() < 1e-12 * before, "{before} became {after}");
    }
}
