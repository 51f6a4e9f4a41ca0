//! Rods without ends: sheets across a period.

use std::f64::consts::TAU;

use nalgebra::{DVector, Vector2};

use super::common::{assert_near, scatter, unit};
use crate::rod::{Along, Flexure, PlanarProperties, PlanarRod, SectionPoint};
use crate::structure::{Structure, Tangents};

/// A sheet of period, stiffness and mass one along -x.
fn sheet(elements: usize) -> PlanarRod {
    let properties =
        PlanarProperties { rod: unit(elements), bending: Flexure::passive(Along::Constant(1.0)) };
    PlanarRod::periodic(properties, Vector2::new(-1.0, 0.0)).expect("there is such a rod")
}

fn straight(rod: &PlanarRod) -> DVector<f64> {
    rod.straight(Vector2::zeros(), std::f64::consts::PI)
}

/// A wave across the sheet, one on it, in the directions of its knots: cos(k s), and its slope.
fn wave(elements: usize) -> DVector<f64> {
    DVector::from_fn(4 * elements, |i, _| {
        let phase = TAU * (i / 4) as f64 / elements as f64;
        [0.0, phase.cos(), 0.0, -TAU * phase.sin()][i % 4]
    })
}

/// Energy per length of a wave is B k^4 / 4, wherever the wave is, to the fourth order in the elements.
#[test]
fn a_wave_across_the_joint_has_its_stiffness() {
    let off = |elements: usize| {
        let rod = sheet(elements);
        let still = DVector::zeros(rod.n_coordinates());
        let Tangents { stiffness, .. } = rod.tangents(&straight(&rod), &still, 0.0);
        let wave = wave(elements);
        let of = |wave: &DVector<f64>| wave.dot(&(&stiffness * wave)) / (0.5 * TAU.powi(4)) - 1.0;
        // Knots are alike: those of the joint, too
        let shifted = DVector::from_fn(wave.len(), |i, _| wave[(i + 4) % wave.len()]);
        assert!((of(&wave) - of(&shifted)).abs() < 1e-9);
        of(&wave)
    };
    let (coarse, fine) = (off(8), off(16));
    assert_near((coarse / fine).log2(), 4.0, 0.1);
    assert!(fine.abs() < 1e-3, "{fine}");
}

/// Forces are those of the energy, and do not see where the sheet is.
#[test]
fn forces_of_a_sheet_are_those_of_its_energy() {
    const STEP: f64 = 1e-6;
    let rod = sheet(3);
    let (n, still) = (rod.n_coordinates(), DVector::zeros(rod.n_coordinates()));
    let at = straight(&rod) + scatter(n, 1.0) * 0.05;
    let forces = rod.forces(&at, &still, 0.0);
    let scale = forces.amax();
    for i in 0..n {
        let moved = |by: f64| {
            let mut moved = at.clone();
            moved[i] += by;
            rod.elastic_energy(&moved, 0.0)
        };
        let slope = (moved(STEP) - moved(-STEP)) / (2.0 * STEP);
        assert!((slope - forces[i]).abs() < 1e-6 * scale, "{i}: {slope} {}", forces[i]);
    }
    for axis in 0..2 {
        let sum: f64 = forces.iter().skip(axis).step_by(4).sum();
        assert!(sum.abs() < 1e-9 * scale, "{sum}");
    }
    let mass = rod.mass();
    let shift = DVector::from_fn(n, |i, _| f64::from(u8::from(i % 4 == 0)));
    assert_near(shift.dot(&(&mass * &shift)), 1.0, 1e-12);
}

/// A point of the last element moves with the first knot, and is a period from where that has it.
#[test]
fn points_go_on_across_the_joint() {
    let rod = sheet(4);
    let (n, at) = (rod.n_coordinates(), straight(&rod) + scatter(16, 2.0) * 0.05);
    let point = |along: f64| rod.surface(&at, SectionPoint { along, offset: 0.1 });
    let (first, last) = (point(0.0), point(1.0));
    assert!((last.place - first.place - Vector2::new(-1.0, 0.0)).norm() < 1e-14);
    let rates = scatter(n, 3.0);
    assert!((last.velocity(&rates) - first.velocity(&rates)).norm() < 1e-14);
}
