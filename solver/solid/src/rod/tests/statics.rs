//! Equilibria against the elastica: B theta'' = cos(theta) (P + q (1 - s)), theta(0) = theta'(1) = 0, whose values
//! here are those of a boundary value problem solved to 1e-11; those without weight are in (@mattiasson1981).

use nalgebra::DVector;

use super::common::{along_x, assert_near, at_base, at_rest, cantilever, unit};
use crate::dry::{DrySystem, Scaled};
use crate::rod::{End, LineForce, PlanarRod, Support};

/// The elastica under a force at its tip or its own weight, both downwards.
struct Elastica {
    at_tip: f64,
    weight: f64,
    /// Place of the tip.
    tip: [f64; 2],
    /// Curvature at the base.
    bend: f64,
}

const UNDER_A_FORCE: Elastica = Elastica {
    at_tip: 10.0,
    weight: 0.0,
    tip: [0.445_004_402, -0.810_609_025],
    bend: -4.450_044_02,
};

const HEAVY: Elastica = Elastica {
    at_tip: 0.0,
    weight: 10.0,
    tip: [0.656_353_761, -0.700_199_716],
    bend: -3.742_191_11,
};

const HEAVIER: Elastica = Elastica {
    at_tip: 0.0,
    weight: 30.0,
    tip: [0.342_763_681, -0.873_092_423],
    bend: -7.237_785_95,
};

/// Coordinates of a clamped rod under these loads.
fn bent(rod: &PlanarRod, elastica: &Elastica) -> DVector<f64> {
    let load = LineForce::new(rod, &[0.0, -elastica.weight], &[0.0, -elastica.at_tip]);
    let load = Scaled { load, factor: |time| time };
    let system = DrySystem::new(rod, vec![&load], |_| at_base(rod, Support::Clamped));
    system.equilibrium(along_x(rod), [0.0, 1.0], 4).expect("there is an equilibrium")
}

/// How far the tip is from where it should be.
fn error(elements: usize, elastica: &Elastica) -> f64 {
    let rod = cantilever(unit(elements));
    let tip = rod.place(&bent(&rod, elastica), 1.0);
    (tip.x - elastica.tip[0]).hypot(tip.y - elastica.tip[1])
}

#[test]
fn a_cantilever_bends_by_the_linear_formula_under_a_small_load() {
    let rod = cantilever(unit(4));
    let small = Elastica { at_tip: 1e-3, weight: 0.0, tip: [1.0, -1e-3 / 3.0], bend: -1e-3 };
    let q = bent(&rod, &small);
    assert_near(rod.place(&q, 1.0).y, small.tip[1], 1e-5);
    assert_near(rod.curvature(&q, 0.0), small.bend, 1e-5);
}

#[test]
fn the_elastica_is_met_to_a_thousandth_by_eight_elements() {
    for elastica in [UNDER_A_FORCE, HEAVY, HEAVIER] {
        let rod = cantilever(unit(8));
        let q = bent(&rod, &elastica);
        let error = error(8, &elastica);
        assert!(error < 1e-3, "the tip is off by {error:.1e}");
        assert_near(rod.curvature(&q, 0.0), elastica.bend, 1e-2);
        assert!(rod.largest_stretch(&q) < 1e-4, "{:.1e}", rod.largest_stretch(&q));
    }
}

#[test]
fn places_converge_with_order_four_in_the_elements() {
    for elastica in [UNDER_A_FORCE, HEAVY] {
        let errors = [4, 8].map(|elements| error(elements, &elastica));
        let order = (errors[0] / errors[1]).log2();
        assert!(order > 3.5, "order {order:.2}, errors {errors:.1?}");
    }
}

#[test]
fn the_clamp_carries_the_force_and_its_moment() {
    let rod = cantilever(unit(16));
    let q = bent(&rod, &UNDER_A_FORCE);
    let load = LineForce::new(&rod, &[0.0, 0.0], &[0.0, -10.0]);
    let system = DrySystem::new(&rod, vec![&load], |_| at_base(&rod, Support::Clamped));
    let at_clamp = rod.end_load(End::Base, &q, &system.unbalanced(&at_rest(q.clone())));
    assert_near(at_clamp.force.y, 10.0, 1e-8);
    assert!(at_clamp.force.x.abs() < 1e-8, "{}", at_clamp.force.x);
    assert_near(at_clamp.moment, 10.0 * UNDER_A_FORCE.tip[0], 1e-5);
}

#[test]
fn a_column_buckles_under_eulers_force() {
    let rod = cantilever(unit(8));
    let eulers = std::f64::consts::PI.powi(2) / 4.0;
    let is_stable = |force: f64| {
        let load = LineForce::new(&rod, &[0.0, 0.0], &[-force, 0.0]);
        let system = DrySystem::new(&rod, vec![&load], |_| at_base(&rod, Support::Clamped));
        let start = along_x(&rod);
        let q = system.equilibrium(start, [0.0, 1.0], 1).expect("it stays straight");
        let free = q.len() - 4;
        let stiffness = system.tangents(&at_rest(q)).stiffness;
        stiffness.view((4, 4), (free, free)).into_owned().cholesky().is_some()
    };
    assert!(is_stable(0.999 * eulers), "buckles too early");
    assert!(!is_stable(1.001 * eulers), "buckles too late");
}
