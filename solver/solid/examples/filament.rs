//! A filament in resistive theory whose base turns to and fro: shapes over a cycle, and thrust beside linear theory.
//!
//! `cargo run --release -p alewife-solid --example filament > filament.csv`, drawn by `filament.py` beside this file.

use std::error::Error;
use std::f64::consts::{PI, TAU};

use alewife_solid::dry::{DrySystem, Level, Motion};
use alewife_solid::rod::{
    Along, End, EndPose, Flexure, PlanarProperties, PlanarRod, Resistance, RodProperties, Support,
};
use nalgebra::{Complex, DVector, Matrix4, Vector2, Vector4};

/// Drag per length and velocity along and across.
const DRAG: [f64; 2] = [1.0, 2.0];

const STEPS: u32 = 80;

/// Cycles in which the filament gets to its limit cycle, and more for short waves, which are slow beside a cycle.
fn cycles(sperm_number: f64) -> u32 {
    if sperm_number > 3.0 { 25 } else { 6 }
}

/// A filament without mass, of length and stiffness one.
fn filament() -> Result<PlanarRod, Box<dyn Error>> {
    let rod = RodProperties {
        length: 1.0,
        elements: 12,
        stretching: RodProperties::stiff(1.0, 1.0),
        damping: 0.0,
        mass: Along::Constant(0.0),
        section_inertia: Along::Constant(0.0),
    };
    let bending = Flexure::passive(Along::Constant(1.0));
    Ok(PlanarRod::new(PlanarProperties { rod, bending })?.clamped(End::Base))
}

/// Mean thrust over (across - along) omega (amplitude l)^2 of small motions: across y_t = -y_ssss.
fn linear(sperm_number: f64) -> Result<f64, Box<dyn Error>> {
    const POINTS: u32 = 2000;
    let exponents: [Complex<f64>; 4] = std::array::from_fn(|i| {
        Complex::from_polar(sperm_number, (1.5 * PI + TAU * i as f64) / 4.0)
    });
    let matrix = Matrix4::from_fn(|row, i| {
        let power = exponents[i].powi(i32::try_from(row).unwrap_or_default());
        if row < 2 { power } else { power * exponents[i].exp() }
    });
    let [zero, one] = [0.0, 1.0].map(|value| Complex::new(value, 0.0));
    let parts = matrix.lu().solve(&Vector4::new(zero, one, zero, zero)).ok_or("no solution")?;
    let mut sum = 0.0;
    for point in 0..POINTS {
        let along = (f64::from(point) + 0.5) / f64::from(POINTS);
        let (mut y, mut slope) = (zero, zero);
        for (exponent, part) in exponents.iter().zip(&parts) {
            let here = part * (exponent * along).exp();
            y += here;
            slope += here * exponent;
        }
        let rate: Complex<f64> = Complex::<f64>::i() * y;
        sum += 0.5 * (rate * slope.conj()).re / f64::from(POINTS);
    }
    Ok(-sum * sperm_number * sperm_number)
}

/// The last cycle of a filament.
struct Cycle {
    /// Places along it at times of the cycle (m).
    shapes: Vec<Vec<Vector2<f64>>>,
    /// Mean thrust over (across - along) omega (amplitude l)^2.
    thrust: f64,
}

/// A filament in time whose base turns by an amplitude (rad).
fn in_time(sperm_number: f64, amplitude: f64) -> Result<Cycle, Box<dyn Error>> {
    const SHAPES: u32 = 10;
    let rod = filament()?;
    let omega = sperm_number.powi(4) / DRAG[1];
    let drag = Resistance::new(&rod, DRAG[0], DRAG[1]);
    let system = DrySystem::new(&rod, vec![&drag], |time| {
        let (sin, cos) = (omega * time).sin_cos();
        let (angle, angular_velocity) = (amplitude * sin, amplitude * omega * cos);
        let pose = EndPose { angle, angular_velocity, ..EndPose::default() };
        rod.held(End::Base, Support::Clamped, &pose)
    });
    let coordinates = rod.straight(Vector2::zeros(), 0.0);
    let velocities = DVector::zeros(coordinates.len());
    let start = Level { coordinates, velocities, time: 0.0 };
    let mut motion = Motion::new(&system, start, TAU / omega / f64::from(STEPS));
    let mut cycle = Cycle { shapes: Vec::new(), thrust: 0.0 };
    let last = (cycles(sperm_number) - 1) * STEPS;
    for step in 0..last + STEPS {
        motion.advance()?;
        if step < last {
            continue;
        }
        let now = &motion.now().coordinates;
        let force = rod.end_load(End::Base, now, motion.support_loads()).force.x;
        cycle.thrust += force / f64::from(STEPS);
        if step % (STEPS / SHAPES) == 0 {
            let points = (0..=60).map(|i| rod.place(now, f64::from(i) / 60.0));
            cycle.shapes.push(points.collect());
        }
    }
    let scale = (DRAG[1] - DRAG[0]) * omega * (amplitude / sperm_number).powi(2);
    cycle.thrust /= scale;
    Ok(cycle)
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("curve,x,y");
    for i in 0..=110 {
        let sperm_number = 0.5 + 0.05 * f64::from(i);
        println!("linear,{sperm_number},{}", linear(sperm_number)?);
    }
    for amplitude in [0.05, 0.5] {
        for sperm_number in [1.0, 1.5, 2.0, 2.16, 2.5, 3.0, 4.0, 5.0] {
            let thrust = in_time(sperm_number, amplitude)?.thrust;
            println!("angle {amplitude},{sperm_number},{thrust}");
        }
    }
    for sperm_number in [2.16, 5.0] {
        for (i, shape) in in_time(sperm_number, 0.5)?.shapes.iter().enumerate() {
            for place in shape {
                println!("shape {sperm_number} {i},{},{}", place.x, place.y);
            }
        }
    }
    Ok(())
}
