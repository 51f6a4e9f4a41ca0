//! Clamps that hold a place and a direction, but no stretch: rods that a force, their weight or a motion stretches.

use std::f64::consts::{FRAC_PI_2, TAU};

use nalgebra::{DVector, Rotation3, Vector2, Vector3};

use super::common::{assert_near, at_rest, cantilever, planar, unit};
use super::space::common::straight;
use crate::dry::{DrySystem, Level, Motion};
use crate::rod::{
    End, EndPose, LineForce, PlanarRod, RodProperties, SpatialEndPose, SpatialRod, Support,
};
use crate::structure::{Held, Load, Structure};

/// Tension over stretch, and the direction of the clamps in the plane.
const SOFT: f64 = 50.0;
const ANGLE: f64 = 0.7;

/// How the base of a rod in the plane is held.
fn in_the_plane() -> EndPose {
    EndPose { angle: ANGLE, ..EndPose::default() }
}

/// The same in space.
fn in_space() -> SpatialEndPose {
    let rotation = Rotation3::new(Vector3::new(0.3, -0.8, 0.5));
    SpatialEndPose { rotation, ..SpatialEndPose::default() }
}

fn soft(elements: usize) -> RodProperties {
    RodProperties { stretching: SOFT, ..unit(elements) }
}

/// A soft rod in the plane or in space, clamped at its base in a direction.
enum Clamped {
    Planar(PlanarRod),
    Spatial(SpatialRod),
}

impl Clamped {
    fn both(elements: usize) -> [Self; 2] {
        let spatial = straight(soft(elements)).clamped(End::Base);
        [Self::Planar(cantilever(soft(elements))), Self::Spatial(spatial)]
    }

    fn direction(&self) -> Vector3<f64> {
        match self {
            Self::Planar(_) => Vector3::new(ANGLE.cos(), ANGLE.sin(), 0.0),
            Self::Spatial(_) => in_space().rotation * Vector3::x(),
        }
    }

    fn structure(&self) -> &dyn Structure {
        match self {
            Self::Planar(rod) => rod,
            Self::Spatial(rod) => rod,
        }
    }

    fn start(&self) -> DVector<f64> {
        match self {
            Self::Planar(rod) => rod.straight(Vector2::zeros(), ANGLE),
            Self::Spatial(rod) => rod.straight(Vector3::zeros(), in_space().rotation),
        }
    }

    fn held(&self) -> Vec<Held> {
        match self {
            Self::Planar(rod) => rod.held(End::Base, Support::Clamped, &in_the_plane()),
            Self::Spatial(rod) => rod.held(End::Base, Support::Clamped, &in_space()),
        }
    }

    /// Forces along it, per length and at the tip.
    fn pulled(&self, per_length: f64, at_tip: f64) -> LineForce {
        let [all, last] = [per_length, at_tip].map(|force| self.direction() * force);
        match self {
            Self::Planar(rod) => LineForce::new(rod, all.as_slice(), last.as_slice()),
            Self::Spatial(rod) => LineForce::new(rod, all.as_slice(), last.as_slice()),
        }
    }

    /// How far the place at a distance along it is from the clamp in its direction.
    fn reach(&self, q: &DVector<f64>, along: f64) -> f64 {
        match self {
            Self::Planar(rod) => rod.place(q, along).push(0.0).dot(&self.direction()),
            Self::Spatial(rod) => rod.place(q, along).dot(&self.direction()),
        }
    }
}

/// Under a force F at its tip: a tangent held with its length would have it short by F h / 6 A.
#[test]
fn a_rod_is_stretched_at_its_clamp_as_elsewhere() {
    const FORCE: f64 = 7.0;
    for elements in [1, 3, 8] {
        for rod in Clamped::both(elements) {
            let load = rod.pulled(0.0, FORCE);
            let system = DrySystem::new(rod.structure(), vec![&load], |_| rod.held());
            let q = system.equilibrium(rod.start(), [0.0, 1.0], 1).expect("an equilibrium");
            for along in [0.1, 0.5, 1.0] {
                let off = (rod.reach(&q, along) / (along * (1.0 + FORCE / SOFT)) - 1.0).abs();
                assert!(off < 1e-13, "{elements} elements, at {along}: {off:.1e}");
            }
        }
    }
}

/// Under its weight p per length by p L^2 / 2 A, but for p h^2 / 12 A: what of the weight is on the tangent at the clamp stretches
/// nothing. A tangent held with its length would have it short by p L h / 6 A.
#[test]
fn a_rod_that_hangs_is_as_long_as_its_weight_makes_it() {
    const WEIGHT: f64 = 4.0;
    let off = |rod: &Clamped| {
        let load = rod.pulled(WEIGHT, 0.0);
        let system = DrySystem::new(rod.structure(), vec![&load], |_| rod.held());
        let q = system.equilibrium(rod.start(), [0.0, 1.0], 1).expect("an equilibrium");
        (rod.reach(&q, 1.0) - 1.0) / (0.5 * WEIGHT / SOFT) - 1.0
    };
    for elements in [2, 4, 8] {
        for rod in Clamped::both(elements) {
            assert_near(off(&rod), -1.0 / (6.0 * (elements * elements) as f64), 1e-9);
        }
    }
}

/// Between two clamps that are pulled apart the tension is even.
#[test]
fn a_rod_between_two_clamps_is_stretched_evenly() {
    for elements in [1, 2, 5] {
        let rod = cantilever(soft(elements)).clamped(End::Tip);
        let at = |place: f64| EndPose { place: Vector2::new(place, 0.0), ..EndPose::default() };
        let held = |_: f64| {
            [(End::Base, 0.0), (End::Tip, 1.2)]
                .map(|(end, place)| rod.held(end, Support::Clamped, &at(place)))
                .concat()
        };
        let system = DrySystem::new(&rod, vec![], held);
        let start = rod.straight(Vector2::zeros(), 0.0);
        let q = system.equilibrium(start, [0.0, 1.0], 1).expect("there is an equilibrium");
        let load = rod.end_load(End::Tip, &q, &system.unbalanced(&at_rest(q.clone())));
        assert_near(load.force.x, 0.2 * SOFT, 1e-12);
        assert_near(rod.place(&q, 0.35).x, 0.35 * 1.2, 1e-12);
    }
}

/// A force at the tip that bends and stretches it, against many elements.
#[test]
fn a_rod_that_is_bent_and_stretched_converges_with_order_four() {
    let tip = |elements: usize| {
        let rod = cantilever(soft(elements));
        let load = LineForce::new(&rod, &[0.0, 0.0], &[6.0, -5.0]);
        let pose = EndPose::default();
        let held = |_: f64| rod.held(End::Base, Support::Clamped, &pose);
        let system = DrySystem::new(&rod, vec![&load], held);
        let start = rod.straight(Vector2::zeros(), 0.0);
        let q = system.equilibrium(start, [0.0, 1.0], 4).expect("there is an equilibrium");
        rod.place(&q, 1.0)
    };
    let exact = tip(64);
    let [coarse, fine] = [4, 8].map(|elements| (tip(elements) - exact).norm());
    let order = (coarse / fine).log2();
    assert!(order > 3.5 && fine < 1e-4, "order {order:.2}, {coarse:.1e} and {fine:.1e}");
}

/// A wave along it: pi / 2 sqrt(A / m) / L, to the third order, by the mass that is on the tangent at the clamp.
#[test]
fn a_rod_rings_along_itself_at_the_pitch_of_a_bar() {
    let frequency = |elements: usize| {
        let rod = cantilever(soft(elements));
        let q = rod.straight(Vector2::zeros(), 0.0);
        let along: Vec<usize> = (4..q.len()).filter(|i| i % 2 == 0).collect();
        let stiffness = rod.tangents(&q, &DVector::zeros(q.len()), 0.0).stiffness;
        let part = |of: nalgebra::DMatrix<f64>| of.select_rows(&along).select_columns(&along);
        let inverse = part(rod.mass()).cholesky().expect("all has mass").l();
        let inverse = inverse.try_inverse().expect("all has mass");
        let squares = (&inverse * part(stiffness) * inverse.transpose()).symmetric_eigenvalues();
        squares.min().sqrt()
    };
    let exact = FRAC_PI_2 * SOFT.sqrt();
    let [coarse, fine] = [2, 4].map(|elements| frequency(elements) / exact - 1.0);
    let order = (coarse / fine).abs().log2();
    assert!((order - 3.0).abs() < 0.1, "order {order:.2}, {coarse:.1e} and {fine:.1e}");
}

/// A clamp that turns to and fro and moves along: its pose at a time.
fn driven(time: f64) -> EndPose {
    // From rest without a jump
    let (grows, rate) = (time * time, 2.0 * time);
    let (sin, cos) = (TAU * time).sin_cos();
    EndPose {
        place: Vector2::new(0.3 * grows * sin, 0.0),
        velocity: Vector2::new(0.3 * (rate * sin + grows * TAU * cos), 0.0),
        angle: ANGLE + 0.6 * grows * sin,
        angular_velocity: 0.6 * (rate * sin + grows * TAU * cos),
    }
}

/// Part of the work of such a clamp that is in no other energy, with steps of a size.
fn unaccounted(rod: &PlanarRod, step: f64) -> f64 {
    let weight = LineForce::new(rod, &[2.0, -3.0], &[0.0, 0.0]);
    let held = |time: f64| rod.held(End::Base, Support::Clamped, &driven(time));
    let system = DrySystem::new(rod, vec![&weight], held);
    let rest = rod.straight(Vector2::zeros(), ANGLE);
    let start = system.equilibrium(rest, [0.0, 0.0], 1).expect("there is an equilibrium");
    let stored = |level: &Level| {
        let Level { coordinates, time, .. } = level;
        let load = weight.load(coordinates, coordinates, *time);
        rod.elastic_energy(coordinates, *time) - load.dot(coordinates)
    };
    let mut motion = Motion::new(&system, at_rest(start), step);
    let before = stored(motion.now());
    let power = |motion: &Motion<'_>| {
        let Level { coordinates, velocities, time } = motion.now();
        let EndPose { velocity, angular_velocity, .. } = driven(*time);
        let load = rod.end_load(End::Base, coordinates, motion.support_loads());
        let given = load.force.dot(&velocity) + load.moment * angular_velocity;
        [given, rod.inner_power(coordinates, velocities, *time).dissipation]
    };
    let (mut given, mut taken) = (0.0, 0.0);
    while motion.now().time < 1.5 - 0.5 * step {
        let [last, dissipated] = power(&motion);
        motion.advance().expect("the step converges");
        let [next, dissipating] = power(&motion);
        given += 0.5 * step * (last + next);
        taken += 0.5 * step * (dissipated + dissipating);
    }
    let now = motion.kinetic_energy() + stored(motion.now()) - before;
    ((given - taken - now) / given).abs()
}

#[test]
fn the_work_of_a_clamp_that_moves_is_stored_or_dissipated() {
    let rod = cantilever(RodProperties { damping: 0.05, ..soft(4) });
    let [coarse, fine] = [0.01, 0.005].map(|step| unaccounted(&rod, step));
    assert!(fine < 5e-3, "{fine:.1e} is missing");
    assert!(coarse > 3.0 * fine, "{coarse:.1e} became {fine:.1e} with half of the step");
}

/// What a clamp does not hold is without effect where a rod keeps its length: the same rod with its tangent held whole.
#[test]
fn a_rod_that_keeps_its_length_does_not_see_what_else_a_clamp_could_hold() {
    let tip = |rod: PlanarRod| {
        let load = LineForce::new(&rod, &[0.0, -4.0], &[0.0, -3.0]);
        let held = |_: f64| rod.held(End::Base, Support::Clamped, &EndPose::default());
        let system = DrySystem::new(&rod, vec![&load], held);
        let start = rod.straight(Vector2::zeros(), 0.0);
        let q = system.equilibrium(start, [0.0, 1.0], 4).expect("there is an equilibrium");
        rod.place(&q, 1.0)
    };
    let apart = (tip(planar(unit(6))) - tip(cantilever(unit(6)))).norm();
    assert!(apart < 1e-6, "{apart:.1e}");
}
