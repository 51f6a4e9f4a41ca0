//! Frequencies and damping of rods in space.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};

use super::common::{TWISTING, along_x, at_base, straight};
use crate::dry::{DrySystem, Motion};
use crate::rod::tests::common::{assert_near, at_rest, unit};
use crate::rod::{Along, End, RodProperties, SpatialRod, Support};
use crate::structure::Structure;

/// Moment of inertia per length of sections.
const INERTIA: f64 = 2e-4;

fn with_inertia(elements: usize, damping: f64) -> SpatialRod {
    let inertia = Along::Constant(INERTIA);
    straight(RodProperties { section_inertia: inertia, damping, ..unit(elements) })
        .clamped(End::Base)
}

/// Frequencies (rad/s) of a cantilever, ascending.
fn frequencies(rod: &SpatialRod) -> Vec<f64> {
    let q = along_x(rod);
    let free = q.len() - 9;
    let part = |matrix: DMatrix<f64>| matrix.view((9, 9), (free, free)).into_owned();
    let stiffness = part(rod.tangents(&q, &DVector::zeros(q.len()), 0.0).stiffness);
    let factor = part(rod.mass()).cholesky().expect("all has mass").l();
    let inverse = factor.try_inverse().expect("all has mass");
    let values = (&inverse * stiffness * inverse.transpose()).symmetric_eigenvalues();
    let mut frequencies: Vec<f64> = values.iter().map(|value| value.max(0.0).sqrt()).collect();
    frequencies.sort_by(f64::total_cmp);
    frequencies
}

#[test]
fn a_cantilever_has_its_frequencies_in_both_directions_and_that_of_twist() {
    let found = frequencies(&with_inertia(8, 0.0));
    let bending = [1.875_104_069_f64, 4.694_091_133].map(|root| root * root);
    let twist = 0.5 * PI * (TWISTING / INERTIA).sqrt();
    for expected in [bending[0], bending[0], bending[1], bending[1], twist] {
        let nearest = |a: &&f64, b: &&f64| (*a - expected).abs().total_cmp(&(*b - expected).abs());
        let value = *found.iter().min_by(nearest).expect("there are frequencies");
        assert_near(value, expected, 2e-3);
    }
    assert_near(found[0], found[1], 1e-2);
    assert_near(found[2], found[3], 1e-2);
}

#[test]
fn a_twist_that_is_let_go_decays_as_it_should() {
    const AMPLITUDE: f64 = 1e-3;
    let damping = 0.003;
    let rod = with_inertia(8, damping);
    let mut q = along_x(&rod);
    for (knot, along) in rod.knots().iter().enumerate() {
        q[9 * knot + 8] = AMPLITUDE * (0.5 * PI * along).sin();
    }
    let frequency = 0.5 * PI * (TWISTING / INERTIA).sqrt();
    let decay = 0.5 * damping * frequency * frequency;
    let damped = (frequency * frequency - decay * decay).sqrt();
    let (duration, steps) = (2.0 * PI / damped, 100);
    let system = DrySystem::new(&rod, vec![], |_| at_base(&rod, Support::Clamped));
    let mut motion = Motion::new(&system, at_rest(q), duration / f64::from(steps));
    for _ in 0..steps {
        motion.advance().expect("the step converges");
    }
    let tip = motion.now().coordinates[9 * 8 + 8];
    assert_near(tip, AMPLITUDE * (-decay * duration).exp(), 3e-2);
}
