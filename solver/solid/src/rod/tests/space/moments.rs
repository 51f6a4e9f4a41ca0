//! Moments and forces at the tips of rods in space, against Kirchhoff's theory (@love1927).

use nalgebra::{DVector, Rotation3, Vector3};

use super::common::{TWISTING, at_base, simple};
use super::helix::{REST, coordinates, helix, kirchhoff, tip};
use crate::dry::DrySystem;
use crate::rod::{
    Axes, End, SpatialEndLoad, SpatialEndPose, SpatialLoadedEnd, SpatialRod, SpatialRodBody,
    Support, Supports,
};

/// The rod, clamped at its base along x, under a load at its tip that grows to this one in steps.
fn loaded(rod: &SpatialRod, start: DVector<f64>, load: SpatialEndLoad) -> DVector<f64> {
    const STEPS: u32 = 8;
    let grows =
        move |time: f64| SpatialEndLoad { force: load.force * time, moment: load.moment * time };
    let at_tip = SpatialLoadedEnd { end: End::Tip, axes: Axes::Fixed, load: Box::new(grows) };
    let body = SpatialRodBody::new(
        rod.clone().clamped(End::Base),
        SpatialEndPose::default(),
        Supports::FREE,
    )
    .with_loaded_ends(vec![at_tip]);
    let system = DrySystem::new(&body, vec![], |_| at_base(rod, Support::Clamped));
    system.equilibrium(start, [0.0, 1.0], STEPS).expect("there is an equilibrium")
}

/// Distance of the place of the tip, and of the vector across there, from those of a straight rod under a moment M that keeps
/// its direction: its tangent goes round M at the rate M / B, and it is twisted by what twist gives way more than bending.
fn errors(elements: usize, moment: Vector3<f64>) -> [f64; 2] {
    let rod = simple(elements);
    let start = rod.straight(Vector3::zeros(), Rotation3::identity());
    let q = loaded(&rod, start, SpatialEndLoad { force: Vector3::zeros(), moment });
    // The integral of exp(s M) x
    let (rate, axis) = (moment.norm(), moment.normalize());
    let (sin, cos) = rate.sin_cos();
    let (along, across) = (axis * axis.x, Vector3::x() - axis * axis.x);
    let place = along + across * (sin / rate) + axis.cross(&Vector3::x()) * ((1.0 - cos) / rate);
    let twist = moment.x * (1.0 / TWISTING - 1.0);
    let exact = Rotation3::new(moment) * Rotation3::new(Vector3::x() * twist) * Vector3::y();
    let found = tip(&q);
    [(found.place - place).norm(), (found.rotation * Vector3::y() - exact).norm()]
}

#[test]
fn a_moment_at_the_tip_makes_an_arc_a_twist_and_a_helix() {
    let moment = |x: f64, y: f64, z: f64| Vector3::new(x, y, z);
    for (moment, worst) in [
        (moment(0.0, 0.0, 3.0), 1e-3),
        (moment(0.0, -2.0, 1.0), 1e-3),
        (moment(2.0, 0.0, 0.0), 1e-5),
        (moment(2.0, 1.0, 3.0), 3e-3),
    ] {
        let [place, across] = errors(8, moment);
        assert!(place.max(across) < worst, "{moment}: {place:.1e} {across:.1e}");
    }
}

#[test]
fn a_rod_that_a_moment_winds_converges_with_order_four() {
    let [coarse, fine] = [6, 12].map(|elements| errors(elements, Vector3::new(2.0, 1.0, 3.0)));
    for (coarse, fine) in coarse.iter().zip(fine) {
        let order = (coarse / fine).log2();
        assert!(order > 3.5, "order {order:.2}, errors {coarse:.1e} {fine:.1e}");
    }
}

/// Force and couple are given, and not the end that they lead to.
#[test]
fn a_helix_that_a_force_and_a_couple_act_on_becomes_that_of_kirchhoff() {
    let rod = helix(20);
    let deformed = [5.0, 4.0];
    let exact = coordinates(&rod, deformed);
    let [force, moment] = kirchhoff(&tip(&exact), deformed);
    let q = loaded(&rod, coordinates(&rod, REST), SpatialEndLoad { force, moment });
    let apart = (rod.place(&q, 1.0) - rod.place(&exact, 1.0)).norm();
    assert!(apart < 1e-3, "the tip is off by {apart:.1e}");
    let turning = rod.turning(&q, 0.5);
    let off = (turning - Vector3::new(0.0, deformed[0], deformed[1])).norm();
    assert!(off < 5e-3 * deformed[0], "{turning}");
}
