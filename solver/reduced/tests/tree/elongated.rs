//! Elongated-body theory by links: thrust and wake of a travelling wave, as Lighthill's formulas have them.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use alewife_reduced::tree::loads::{
    ElongatedLink, Load, StripCoefficients, Strips, elongated_mass,
};
use alewife_reduced::tree::{Twist, Wrench};
use nalgebra::Vector3;

const SPEED: f64 = 0.4;
const AMPLITUDE: f64 = 1e-3;
const NUMBER: f64 = 6.0;
const FREQUENCY: f64 = 5.0;
const LENGTH: f64 = 1.0;

/// A point of a body that goes to +x: its tail is at 0, and a wave goes towards it.
fn point(place: f64, time: f64) -> [f64; 2] {
    [place + SPEED * time, AMPLITUDE * (NUMBER * place + FREQUENCY * time).sin()]
}

/// Middle, angle, and their rates of a link whose ends are two points; `ahead` is where the head is on its x axis.
struct Placed {
    angle: f64,
    twist: Twist<f64>,
}

fn placed(from: f64, to: f64, time: f64, ahead: f64) -> Placed {
    let step = 1e-5;
    let pose = |time: f64| {
        let ([x, y], [u, v]) = (point(from, time), point(to, time));
        let turned = if ahead > 0.0 { 0.0 } else { PI };
        [0.5 * (x + u), 0.5 * (y + v), (v - y).atan2(u - x) + turned]
    };
    let (before, now, after) = (pose(time - step), pose(time), pose(time + step));
    let rate = |k: usize| (after[k] - before[k]) / (2.0 * step);
    let (s, c) = now[2].sin_cos();
    let linear = Vector3::new(c * rate(0) + s * rate(1), c * rate(1) - s * rate(0), 0.0);
    Placed { angle: now[2], twist: Twist { linear, angular: Vector3::new(0.0, 0.0, rate(2)) } }
}

fn law(mass: f64, length: f64, tail: Option<f64>) -> Load<f64> {
    let coefficients = StripCoefficients {
        added_mass: 0.0,
        normal_linear: 0.0,
        normal_quadratic: 0.0,
        tangential_linear: 0.0,
        tangential_quadratic: 0.0,
    };
    let drag = Strips {
        half_length: 0.5 * length,
        half_width: 0.01,
        depth: 1.0,
        density: 1000.0,
        viscosity: 1e-3,
        coefficients,
    };
    Load::Elongated(ElongatedLink { drag, mass, tail })
}

/// Force along x and work on the fluid at a time, of all links.
fn at(time: f64, n: u32, mass: f64, ahead: f64) -> [f64; 2] {
    let length = LENGTH / f64::from(n);
    let mut sum = [0.0; 2];
    for nth in 0..n {
        let (from, to) = (length * f64::from(nth), length * f64::from(nth + 1));
        let law = law(mass, length, (nth == 0).then_some(ahead));
        let step = 1e-4;
        let Placed { angle, twist } = placed(from, to, time, ahead);
        let [before, after] = [-step, step].map(|by| placed(from, to, time + by, ahead).twist);
        let change = Twist {
            linear: (after.linear - before.linear) / (2.0 * step),
            angular: (after.angular - before.angular) / (2.0 * step),
        };
        let masses = law.added_mass();
        let load: Wrench<f64> = law
            .resist(&twist)
            .wrench
            .plus(&masses.times(&change), -1.0)
            .plus(&twist.cross_momentum(&masses.times(&twist)), -1.0);
        let (s, c) = angle.sin_cos();
        sum[0] += c * load.force.x - s * load.force.y;
        sum[1] -= twist.dot(&load);
    }
    sum
}

fn mean(n: u32, mass: f64, ahead: f64) -> [f64; 2] {
    let (mut sum, m) = ([0.0; 2], 24);
    for k in 0..m {
        let found = at(TAU / FREQUENCY * f64::from(k) / f64::from(m), n, mass, ahead);
        sum.iter_mut().zip(found).for_each(|(sum, one)| *sum += one / f64::from(m));
    }
    sum
}

/// T = m/2 (<h_t^2> - U^2 <h_x^2>), and the swimmer's work is the energy that the wake carries away, m/2 <w^2> U.
#[test]
fn a_travelling_wave_has_the_thrust_and_the_wake_of_lighthill() {
    let mass = elongated_mass(1000.0, 0.1, 0.9);
    assert!((mass - 0.9 * 1000.0 * 0.01 * 0.5 * FRAC_PI_2).abs() < 1e-12);
    let square = 0.5 * AMPLITUDE * AMPLITUDE;
    let thrust = 0.5 * mass * square * (FREQUENCY.powi(2) - (SPEED * NUMBER).powi(2));
    let wake = 0.5 * mass * square * (FREQUENCY - SPEED * NUMBER).powi(2) * SPEED;
    for ahead in [1.0, -1.0] {
        let [found, work] = mean(100, mass, ahead);
        assert!((found / thrust - 1.0).abs() < 2e-2, "{found} {thrust}");
        assert!((work / wake - 1.0).abs() < 2e-2, "{work} {wake}");
        // More links, nearer to it
        let [fine, fine_work] = mean(400, mass, ahead);
        assert!((fine / thrust - 1.0).abs() < 2e-3, "{fine} {thrust}");
        assert!((fine_work / wake - 1.0).abs() < 2e-3, "{fine_work} {wake}");
    }
    // Without a tail nothing is left behind, and there is no thrust
    let without: f64 = (0..24)
        .map(|k| {
            let time = TAU / FREQUENCY * f64::from(k) / 24.0;
            at(time, 100, mass, 1.0)[0] - at_tail(time, mass, 100)
        })
        .sum::<f64>()
        / 24.0;
    assert!(without.abs() < 2e-2 * thrust, "{without} {thrust}");
}

/// What the tail leaves behind by the points of the wave themselves: m w^2 / 2 along, and -m u w across.
fn at_tail(time: f64, mass: f64, n: u32) -> f64 {
    let Placed { angle, twist } = placed(0.0, LENGTH / f64::from(n), time, 1.0);
    let (s, c) = angle.sin_cos();
    let across = twist.linear.y - 0.5 * LENGTH / f64::from(n) * twist.angular.z;
    c * 0.5 * mass * across * across + s * mass * twist.linear.x * across
}
