//! Thrust of filaments with resistive loads against linear theory, zeta y_t = -B y_ssss (@wiggins1998).

use std::f64::consts::PI;

use nalgebra::{Complex, DMatrix, DVector};

use super::common::{along_x, assert_near, at_rest, cantilever, unit};
use crate::dry::{DrySystem, Motion};
use crate::rod::{End, EndPose, PlanarRod, Resistance, RodProperties, Support};
use crate::structure::{Load, Structure};

/// Drag per length and velocity along and across.
const DRAG: [f64; 2] = [1.0, 2.0];

/// A filament of length and stiffness one whose base oscillates: by an angle where it is a pivot, by a height
/// where it is clamped.
#[derive(Clone, Copy)]
struct Filament {
    is_pivot: bool,
    /// Length over (B / (across omega))^(1/4).
    sperm_number: f64,
    /// Mean thrust over (across - along) omega (amplitude l)^2, in place of l by one where it is heaved.
    thrust: f64,
}

impl Filament {
    const fn pivoted(sperm_number: f64, thrust: f64) -> Self {
        Self { is_pivot: true, sperm_number, thrust }
    }

    const fn heaved(sperm_number: f64, thrust: f64) -> Self {
        Self { is_pivot: false, sperm_number, thrust }
    }

    /// Angular velocity of the oscillation.
    fn omega(&self) -> f64 {
        self.sperm_number.powi(4) / DRAG[1]
    }

    /// What a thrust is divided by.
    fn scale(&self, amplitude: f64) -> f64 {
        let length = if self.is_pivot { 1.0 / self.sperm_number } else { 1.0 };
        (DRAG[1] - DRAG[0]) * self.omega() * (amplitude * length).powi(2)
    }
}

const FILAMENTS: [Filament; 4] = [
    Filament::pivoted(2.16, 0.242_008),
    Filament::pivoted(2.0, 0.233_230),
    Filament::pivoted(4.0, 0.143_520),
    Filament::heaved(1.90, 0.392_433),
];

/// A filament without mass.
fn filament(elements: usize) -> PlanarRod {
    cantilever(RodProperties { mass: crate::rod::Along::Constant(0.0), ..unit(elements) })
}

/// Mean thrust of the linear equations (K + i omega C) y = 0 with the base given, per square of the amplitude.
fn linear_thrust(rod: &PlanarRod, filament: Filament) -> f64 {
    let (straight, still) = (along_x(rod), DVector::zeros(rod.n_coordinates()));
    let drag = Resistance::new(rod, DRAG[0], DRAG[1]);
    let stiffness = rod.tangents(&straight, &still, 0.0).stiffness;
    let damping = -drag.tangents(&straight, &still, 0.0).damping;
    let omega = filament.omega();
    // Across components only: y and dy/ds
    let across: Vec<usize> = (0..straight.len()).filter(|i| i % 2 == 1).collect();
    let n = across.len();
    let matrix = DMatrix::from_fn(n, n, |i, j| {
        let at = (across[i], across[j]);
        Complex::new(stiffness[at], omega * damping[at])
    });
    let given = if filament.is_pivot { [0.0, 1.0] } else { [1.0, 0.0] };
    let mut motion = DVector::from_element(n, Complex::new(0.0, 0.0));
    motion[0].re = given[0];
    motion[1].re = given[1];
    let load = -(&matrix * &motion).rows(2, n - 2).into_owned();
    let free = matrix.view((2, 2), (n - 2, n - 2)).into_owned();
    let solved = free.lu().solve(&load).expect("the filament has drag");
    motion.rows_mut(2, n - 2).copy_from(&solved);
    mean_thrust(rod, &across, &motion, omega)
}

/// Mean over a cycle of the integral of (along - across) y_t y_s: second order in the motion, by the second
/// derivative of the drag along the filament.
fn mean_thrust(
    rod: &PlanarRod,
    across: &[usize],
    motion: &DVector<Complex<f64>>,
    omega: f64,
) -> f64 {
    const TIMES: u32 = 8;
    /// So small that the thrust is a square to 1e-6, so large that it is not lost.
    const AMPLITUDE: f64 = 1e-4;
    let drag = Resistance::new(rod, DRAG[0], DRAG[1]);
    let mut sum = 0.0;
    for i in 0..TIMES {
        let phase = Complex::from_polar(AMPLITUDE, 2.0 * PI * f64::from(i) / f64::from(TIMES));
        let (mut q, mut v) = (along_x(rod), DVector::zeros(rod.n_coordinates()));
        for (place, value) in across.iter().zip(motion) {
            q[*place] += (value * phase).re;
            v[*place] = (value * phase * Complex::new(0.0, omega)).re;
        }
        let load = drag.load(&q, &v, 0.0);
        sum += load.iter().step_by(4).sum::<f64>();
    }
    sum.abs() / f64::from(TIMES) / (AMPLITUDE * AMPLITUDE)
}

#[test]
fn linear_filaments_have_their_thrust() {
    for of_theory in FILAMENTS {
        let thrust = linear_thrust(&filament(10), of_theory) / of_theory.scale(1.0);
        assert_near(thrust, of_theory.thrust, 1e-3);
    }
}

/// Mean thrust over a cycle of a filament that moves far, after cycles in which it gets there.
fn thrust_in_time(rod: &PlanarRod, filament: Filament, amplitude: f64, steps: u32) -> f64 {
    const CYCLES: u32 = 3;
    let omega = filament.omega();
    let drag = Resistance::new(rod, DRAG[0], DRAG[1]);
    let base = |time: f64| {
        let (sin, cos) = (omega * time).sin_cos();
        let (value, rate) = (amplitude * sin, amplitude * omega * cos);
        let mut pose = EndPose::default();
        if filament.is_pivot {
            (pose.angle, pose.angular_velocity) = (value, rate);
        } else {
            (pose.place.y, pose.velocity.y) = (value, rate);
        }
        rod.held(End::Base, Support::Clamped, &pose)
    };
    let system = DrySystem::new(rod, vec![&drag], base);
    let step = 2.0 * PI / omega / f64::from(steps);
    let mut motion = Motion::new(&system, at_rest(along_x(rod)), step);
    let mut sum = 0.0;
    for i in 0..CYCLES * steps {
        motion.advance().expect("the step converges");
        if i >= (CYCLES - 1) * steps {
            let load = rod.end_load(End::Base, &motion.now().coordinates, motion.support_loads());
            sum += load.force.x;
        }
    }
    sum.abs() / f64::from(steps)
}

#[test]
fn filaments_that_move_in_time_have_the_thrust_of_linear_theory() {
    const AMPLITUDE: f64 = 0.05;
    for of_theory in [FILAMENTS[0], FILAMENTS[3]] {
        let thrust = thrust_in_time(&filament(6), of_theory, AMPLITUDE, 60);
        assert_near(thrust / of_theory.scale(AMPLITUDE), of_theory.thrust, 5e-3);
    }
}
