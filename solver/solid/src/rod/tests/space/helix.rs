//! Helical rods against Kirchhoff's theory: a uniform helix stays one under a force and a couple along its axis
//! (@love1927).

use nalgebra::{DVector, Rotation3, Vector3};

use super::common::{TWISTING, at_base, at_rest_with};
use crate::dry::DrySystem;
use crate::rod::tests::common::{assert_near, at_rest, unit};
use crate::rod::{Along, End, Field, Resistance, SpatialEndPose, SpatialRod, Support, Varying};
use crate::structure::{Held, Load, Structure};

/// Curvature and torsion at rest.
pub(super) const REST: [f64; 2] = [6.0, 3.0];

/// A rod whose rest shape is a helix with d1 along its normal.
pub(super) fn helix(elements: usize) -> SpatialRod {
    let rest = [0.0, REST[0], REST[1]].map(|value| Field::Steady(Along::Constant(value)));
    at_rest_with(unit(elements), rest).clamped(End::Base)
}

/// Coordinates of a helix with a curvature and a torsion from the origin.
pub(super) fn coordinates(rod: &SpatialRod, [curvature, torsion]: [f64; 2]) -> DVector<f64> {
    let turning = [0.0, curvature, torsion].map(Along::Constant);
    rod.curved(Vector3::zeros(), Rotation3::identity(), &turning)
}

/// The pose of the tip for such coordinates.
pub(super) fn tip(q: &DVector<f64>) -> SpatialEndPose {
    let first = q.len() - 9;
    let part = |i: usize| q.fixed_rows::<3>(first + 3 * i).into_owned();
    let (tangent, across) = (part(1), part(2));
    let rotation = Rotation3::from_basis_unchecked(&[tangent, across, tangent.cross(&across)]);
    SpatialEndPose { place: part(0), rotation, ..SpatialEndPose::default() }
}

/// Force and moment at the tip that a helix needs, in the axes of the world.
pub(super) fn kirchhoff(
    pose: &SpatialEndPose,
    [curvature, torsion]: [f64; 2],
) -> [Vector3<f64>; 2] {
    let [tangent, binormal] = [Vector3::x(), Vector3::z()].map(|axis| pose.rotation * axis);
    let (bend, twist) = (curvature - REST[0], TWISTING * (torsion - REST[1]));
    let across = twist * curvature - bend * torsion;
    let force = (binormal + tangent * (torsion / curvature)) * across;
    [force, binormal * bend + tangent * twist]
}

#[test]
fn a_helix_that_is_wound_and_pulled_needs_the_force_and_the_couple_of_kirchhoff() {
    let rod = helix(20).clamped(End::Tip);
    let deformed = [5.0, 4.0];
    let exact = coordinates(&rod, deformed);
    let pose = tip(&exact);
    let held = |_: f64| {
        [at_base(&rod, Support::Clamped), rod.held(End::Tip, Support::Clamped, &pose)].concat()
    };
    let system = DrySystem::new(&rod, vec![], held);
    let q = system.equilibrium(exact.clone(), [0.0, 1.0], 1).expect("there is an equilibrium");
    let load = rod.end_load(End::Tip, &q, &system.unbalanced(&at_rest(q.clone())));
    let [force, moment] = kirchhoff(&pose, deformed);
    let errors =
        [(load.force - force).norm() / force.norm(), (load.moment - moment).norm() / moment.norm()];
    assert!(errors[0].max(errors[1]) < 1e-3, "{errors:?}");
    let apart = (rod.place(&q, 0.5) - rod.place(&exact, 0.5)).norm();
    assert!(apart < 1e-4, "the middle is off by {apart:.1e}");
}

#[test]
fn a_helix_is_wound_by_a_couple_into_another_one() {
    let rod = helix(20).clamped(End::Tip);
    // The couple alone: twist times curvature = bend times torsion
    let curvature = 7.0;
    let torsion = TWISTING * REST[1] * curvature / (TWISTING * curvature - (curvature - REST[0]));
    let start = coordinates(&rod, REST);
    let end = coordinates(&rod, [curvature, torsion]);
    let (from, to) = (tip(&start), tip(&end));
    let turn = (to.rotation * from.rotation.inverse()).scaled_axis();
    let held = |time: f64| -> Vec<Held> {
        let rotation = Rotation3::new(turn * time) * from.rotation;
        let tip = rod.held(End::Tip, Support::Clamped, &SpatialEndPose { rotation, ..from });
        // Directions only: the place is free
        [at_base(&rod, Support::Clamped), tip[3..].to_vec()].concat()
    };
    let system = DrySystem::new(&rod, vec![], held);
    let q = system.equilibrium(start, [0.0, 1.0], 4).expect("there is an equilibrium");
    let apart = (rod.place(&q, 1.0) - to.place).norm();
    assert!(apart < 1e-3, "the tip is off by {apart:.1e}");
    let load = rod.end_load(End::Tip, &q, &system.unbalanced(&at_rest(q.clone())));
    let [_, moment] = kirchhoff(&to, [curvature, torsion]);
    let error = (load.moment - moment).norm() / moment.norm();
    assert!(error < 1e-3, "the couple is off by {error:.1e}");
}

#[test]
fn a_straight_rod_grows_into_the_helix_of_its_rest_shape() {
    let grows =
        |value: f64| Field::in_time(move |_, time| Varying { value: value * time, rate: value });
    let rest = [grows(0.0), grows(REST[0]), grows(REST[1])];
    let rod = at_rest_with(unit(20), rest).clamped(End::Base);
    let system = DrySystem::new(&rod, vec![], |_| at_base(&rod, Support::Clamped));
    let straight = coordinates(&rod, [0.0, 0.0]);
    let q = system.equilibrium(straight, [0.0, 1.0], 6).expect("there is an equilibrium");
    let expected = coordinates(&rod, REST);
    let apart = (rod.place(&q, 1.0) - rod.place(&expected, 1.0)).norm();
    assert!(apart < 1e-3, "the tip is off by {apart:.1e}");
    assert_near(rod.turning(&q, 0.5).y, REST[0], 1e-3);
    assert_near(rod.turning(&q, 0.5).z, REST[1], 1e-3);
    assert!(rod.elastic_energy(&q, 1.0) < 1e-3, "{:.1e}", rod.elastic_energy(&q, 1.0));
}

#[test]
fn helices_converge_with_order_four_in_the_elements() {
    let error = |elements: usize| {
        let rod = helix(elements);
        let system = DrySystem::new(&rod, vec![], |_| at_base(&rod, Support::Clamped));
        let exact = coordinates(&rod, REST);
        let q = system.equilibrium(exact.clone(), [0.0, 1.0], 1).expect("an equilibrium");
        (rod.place(&q, 1.0) - rod.place(&exact, 1.0)).norm()
    };
    let errors = [6, 12].map(error);
    let order = (errors[0] / errors[1]).log2();
    assert!(order > 3.5, "order {order:.2}, errors {errors:.1?}");
}

#[test]
fn a_stiff_helix_that_turns_about_its_axis_has_the_thrust_of_resistive_theory() {
    let rod = helix(16);
    let [curvature, torsion] = REST;
    let q = coordinates(&rod, REST);
    let square = curvature * curvature + torsion * torsion;
    let (radius, cosine) = (curvature / square, torsion / square.sqrt());
    let sine = curvature / square.sqrt();
    // The axis is along b curvature + t torsion, through the centre of curvature of the cylinder
    let axis = Vector3::new(torsion, 0.0, curvature) / square.sqrt();
    let on_axis = Vector3::y() * radius;
    let mut v = DVector::zeros(q.len());
    for i in (0..q.len()).step_by(3) {
        let from = if i % 9 == 0 { on_axis } else { Vector3::zeros() };
        let velocity = axis.cross(&(q.fixed_rows::<3>(i) - from));
        v.fixed_rows_mut::<3>(i).copy_from(&velocity);
    }
    let load = Resistance::new(&rod, 1.0, 1.7).load(&q, &v, 0.0);
    let force: Vector3<f64> =
        (0..q.len()).step_by(9).map(|i| load.fixed_rows::<3>(i).into_owned()).sum();
    assert_near(force.dot(&axis), 0.7 * radius * sine * cosine, 1e-3);
    assert_eq!(rod.n_coordinates(), q.len());
}
