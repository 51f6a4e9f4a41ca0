//! Rods that move: frequencies, order of the stepper, energy, damping.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};

use super::common::{along_x, assert_near, at_base, at_rest, cantilever, planar, unit};
use crate::dry::{DrySystem, Level, Motion};
use crate::rod::{Along, LineForce, PlanarRod, RodProperties, Support};
use crate::structure::Structure;

/// Roots of cos(x) cosh(x) = -1: frequencies of a cantilever of length, stiffness and mass one are their squares.
const CANTILEVER: [f64; 3] = [1.875_104_069, 4.694_091_133, 7.854_757_438];

/// A mode of vibration.
struct Mode {
    /// Its frequency (rad/s).
    frequency: f64,
    /// Coordinates, less those of the straight rod.
    shape: DVector<f64>,
}

/// Modes of a straight rod whose first coordinates are held, by their frequencies.
fn modes(rod: &PlanarRod, held: usize) -> Vec<Mode> {
    let q = along_x(rod);
    let free = q.len() - held;
    let part = |matrix: DMatrix<f64>| matrix.view((held, held), (free, free)).into_owned();
    let stiffness = part(rod.tangents(&q, &DVector::zeros(q.len()), 0.0).stiffness);
    let factor = part(rod.mass()).cholesky().expect("all has mass").l();
    let inverse = factor.try_inverse().expect("all has mass");
    let eigen = (&inverse * stiffness * inverse.transpose()).symmetric_eigen();
    let mut modes: Vec<Mode> = (0..free)
        .map(|i| {
            let mode = inverse.transpose() * eigen.eigenvectors.column(i);
            let mut shape = DVector::zeros(q.len());
            shape.rows_mut(held, free).copy_from(&mode);
            Mode { frequency: eigen.eigenvalues[i].max(0.0).sqrt(), shape }
        })
        .collect();
    modes.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
    modes
}

#[test]
fn a_cantilever_has_its_frequencies() {
    let rod = cantilever(unit(10));
    for (mode, root) in modes(&rod, 4).iter().zip(CANTILEVER) {
        assert_near(mode.frequency, root * root, 1e-3);
    }
}

#[test]
fn a_free_strip_turns_with_its_moment_of_inertia() {
    let thickness = 0.3;
    let rod = planar(RodProperties {
        mass: Along::Constant(thickness),
        section_inertia: Along::Constant(thickness.powi(3) / 12.0),
        ..unit(3)
    });
    let q = along_x(&rod);
    // Angular velocity one about the middle
    let v = DVector::from_fn(q.len(), |i, _| match i % 4 {
        1 => q[i - 1] - 0.5,
        3 => 1.0,
        _ => 0.0,
    });
    let inertia = v.dot(&(rod.mass() * &v));
    assert_near(inertia, thickness * (1.0 + thickness * thickness) / 12.0, 1e-12);
}

/// A cantilever at rest in its first mode, with the frequency and the height of its tip.
struct FirstMode {
    start: Level,
    frequency: f64,
    height: f64,
}

fn first_mode(rod: &PlanarRod) -> FirstMode {
    /// So small that what is not linear is below 1e-5.
    const AMPLITUDE: f64 = 1e-5;
    let Mode { frequency, shape } = modes(rod, 4).swap_remove(0);
    let height = shape[shape.len() - 3] * AMPLITUDE;
    FirstMode { start: at_rest(along_x(rod) + shape * AMPLITUDE), frequency, height }
}

/// A cantilever after a time, with steps of a size.
fn after<'a>(system: &'a DrySystem<'a>, start: Level, step: f64, duration: f64) -> Motion<'a> {
    let mut motion = Motion::new(system, start, step);
    while motion.now().time < duration - 0.5 * step {
        motion.advance().expect("the step converges");
    }
    motion
}

#[test]
fn steps_are_of_order_two() {
    let rod = cantilever(unit(4));
    let FirstMode { start, frequency, height } = first_mode(&rod);
    let system = DrySystem::new(&rod, vec![], |_| at_base(&rod, Support::Clamped));
    // A quarter of a period, where errors of the phase are largest
    let duration = 0.5 * PI / frequency;
    let errors = [40.0, 80.0].map(|steps| {
        let motion = after(&system, start.clone(), duration / steps, duration);
        (rod.place(&motion.now().coordinates, 1.0).y / height).abs()
    });
    let order = (errors[0] / errors[1]).log2();
    assert!((order - 2.0).abs() < 0.2, "order {order:.2}, errors {errors:.1?}");
}

#[test]
fn damping_lets_a_mode_decay_as_it_should() {
    let damping = 0.02;
    let rod = cantilever(RodProperties { damping, ..unit(4) });
    let FirstMode { start, frequency, height } = first_mode(&rod);
    let system = DrySystem::new(&rod, vec![], |_| at_base(&rod, Support::Clamped));
    // x'' + damping frequency^2 x' + frequency^2 x = 0
    let decay = 0.5 * damping * frequency * frequency;
    let damped = (frequency * frequency - decay * decay).sqrt();
    let duration = 2.0 * PI / damped;
    let motion = after(&system, start, duration / 400.0, duration);
    let tip = rod.place(&motion.now().coordinates, 1.0).y;
    assert_near(tip, height * (-decay * duration).exp(), 2e-3);
}

/// Energy of a rod that is let go from a shape it had under a force at its tip.
fn loss(rod: &PlanarRod, step: f64) -> [f64; 2] {
    let load = LineForce::new(rod, &[0.0, 0.0], &[0.0, -2.0]);
    let clamped = |_: f64| at_base(rod, Support::Clamped);
    let pulled = DrySystem::new(rod, vec![&load], clamped);
    let bent = pulled.equilibrium(along_x(rod), [0.0, 1.0], 2).expect("there is an equilibrium");
    let stored = rod.elastic_energy(&bent, 0.0);
    let system = DrySystem::new(rod, vec![], clamped);
    let mut motion = Motion::new(&system, at_rest(bent), step);
    let mut dissipated = 0.0;
    while motion.now().time < 1.0 - 0.5 * step {
        let power = |level: &Level| {
            rod.inner_power(&level.coordinates, &level.velocities, level.time).dissipation
        };
        let before = power(motion.now());
        motion.advance().expect("the step converges");
        dissipated += 0.5 * step * (before + power(motion.now()));
    }
    let left = motion.kinetic_energy() + rod.elastic_energy(&motion.now().coordinates, 0.0);
    [(stored - left - dissipated) / stored, dissipated / stored]
}

#[test]
fn energy_is_lost_to_damping_and_to_the_order_of_the_stepper() {
    let rod = cantilever(RodProperties { damping: 0.02, ..unit(4) });
    let [coarse, fine] = [0.01, 0.005].map(|step| loss(&rod, step));
    assert!(fine[1] > 0.15, "damping takes {} only", fine[1]);
    assert!(fine[0].abs() < 2e-3, "{:.1e} of the energy is not accounted for", fine[0]);
    let order = (coarse[0] / fine[0]).abs().log2();
    assert!(order > 1.8, "order {order:.2}: {coarse:?}, {fine:?}");
}

#[test]
fn energy_balances_in_each_step_but_for_the_loss_of_the_scheme() {
    // Not stiff, so that the stretch of a straight rod that bends is nothing beside
    let rod = cantilever(RodProperties { damping: 0.02, stretching: 10.0, ..unit(4) });
    let FirstMode { start, frequency, .. } = first_mode(&rod);
    let scale = rod.elastic_energy(&start.coordinates, 0.0);
    let system = DrySystem::new(&rod, vec![], |_| at_base(&rod, Support::Clamped));
    let step = 2.0 * PI / frequency / 40.0;
    let mut motion = Motion::new(&system, start, step);
    for i in 0..40 {
        let before = motion.energy_of_scheme(&along_x(&rod));
        motion.advance().expect("the step converges");
        if i < 2 {
            continue;
        }
        let Level { coordinates, velocities, time } = motion.now();
        let dissipated = step * rod.inner_power(coordinates, velocities, *time).dissipation;
        let after = motion.energy_of_scheme(&along_x(&rod));
        let missing = before - after - dissipated - motion.loss_of_scheme();
        assert!(missing.abs() < 1e-8 * scale, "step {i}: {:.1e} is missing", missing / scale);
    }
}
