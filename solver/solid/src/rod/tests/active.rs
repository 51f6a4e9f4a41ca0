//! Rods that bend actively: shapes, and the balance of energy.

use super::common::{along_x, assert_near, at_base, at_rest, bending, unit, with_moment};
use crate::dry::{DrySystem, Level, Motion};
use crate::rod::{
    Along, End, Field, Flexure, LineForce, PlanarRod, Resistance, RodProperties, Support, Varying,
};
use crate::structure::Structure;

#[test]
fn an_active_moment_bends_a_free_rod_into_a_circle() {
    let moment = with_moment(Field::Steady(Along::Constant(2.0)));
    let rod = bending(unit(8), moment).clamped(End::Base);
    let system = DrySystem::new(&rod, vec![], |_| at_base(&rod, Support::Clamped));
    let q = system.equilibrium(along_x(&rod), [0.0, 1.0], 1).expect("there is an equilibrium");
    let tip = rod.place(&q, 1.0);
    assert_near(tip.x, 2.0_f64.sin() / 2.0, 1e-4);
    assert_near(tip.y, (1.0 - 2.0_f64.cos()) / 2.0, 1e-4);
    assert_near(rod.curvature(&q, 0.5), 2.0, 1e-3);
}

#[test]
fn a_rest_curvature_is_taken_without_energy() {
    let rest = Field::Steady(Along::function(|s| 3.0 * s));
    let flexure = Flexure { rest, ..Flexure::passive(Along::Constant(1.0)) };
    let rod = bending(unit(10), flexure).clamped(End::Base);
    let system = DrySystem::new(&rod, vec![], |_| at_base(&rod, Support::Clamped));
    let q = system.equilibrium(along_x(&rod), [0.0, 1.0], 2).expect("there is an equilibrium");
    let curved = rod.curved(nalgebra::Vector2::zeros(), 0.0, &Along::function(|s| 3.0 * s));
    let apart = (rod.place(&q, 1.0) - rod.place(&curved, 1.0)).norm();
    assert!(apart < 1e-4, "the tip is off by {apart:.1e}");
    assert!(rod.elastic_energy(&q, 0.0) < 1e-4, "{:.1e}", rod.elastic_energy(&q, 0.0));
}

/// Part of the work of activation that is in no other energy after a beat, with steps of a size.
fn unaccounted(rod: &PlanarRod, step: f64) -> f64 {
    let drag = Resistance::new(rod, 1.0, 2.0);
    let pull = LineForce::new(rod, &[0.3, 0.0], &[0.0, 0.2]);
    let system = DrySystem::new(rod, vec![&drag, &pull], |_| at_base(rod, Support::Hinged));
    let mut motion = Motion::new(&system, at_rest(along_x(rod)), step);
    let powers = |level: &Level| {
        let power = rod.inner_power(&level.coordinates, &level.velocities, level.time);
        [power.activation, system.power_of_loads(level) - power.dissipation]
    };
    let (mut active, mut other) = (0.0, 0.0);
    while motion.now().time < 2.0 - 0.5 * step {
        let before = powers(motion.now());
        motion.advance().expect("the step converges");
        let after = powers(motion.now());
        active += 0.5 * step * (before[0] + after[0]);
        other += 0.5 * step * (before[1] + after[1]);
    }
    let now = motion.now();
    let stored = motion.kinetic_energy() + rod.elastic_energy(&now.coordinates, now.time)
        - rod.elastic_energy(&along_x(rod), 0.0);
    ((active + other - stored) / active).abs()
}

#[test]
fn the_work_of_activation_is_stored_or_dissipated() {
    let wave = |s: f64, t: f64| {
        let (sin, cos) = (4.0 * s - 3.0 * t).sin_cos();
        // From rest without a jump
        Varying { value: 2.0 * t * t * sin, rate: 4.0 * t * sin - 6.0 * t * t * cos }
    };
    let by_moment = with_moment(Field::in_time(wave));
    let by_shape = Flexure { rest: Field::in_time(wave), ..Flexure::passive(Along::Constant(1.0)) };
    for flexure in [by_moment, by_shape] {
        let rod = bending(RodProperties { damping: 0.01, ..unit(5) }, flexure);
        let [coarse, fine] = [0.02, 0.01].map(|step| unaccounted(&rod, step));
        assert!(fine < 1e-3, "{fine:.1e} is missing");
        assert!(coarse > 3.0 * fine, "{coarse:.1e} became {fine:.1e} with half of the step");
    }
}
