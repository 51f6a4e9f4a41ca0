//! Gradients whose values are known: Oberbeck's drag of spheroids, squirmers.

use std::f64::consts::PI;

use alewife_core::case::Case;
use alewife_core::gradient::{NumberAt, value_and_gradient};

use super::gradients_of;

/// Oberbeck's drag over 6 pi mu U b of a spheroid of aspect e = a / b > 1 along its axis.
fn oberbeck(aspect: f64) -> f64 {
    let root = (aspect * aspect - 1.0).sqrt();
    let logarithm = (aspect + root).ln();
    let below = (2.0 * aspect * aspect - 1.0) / root.powi(3) * logarithm - aspect / root.powi(2);
    8.0 / 3.0 / (2.0 * below)
}

/// A spheroid in a fluid that ends a million radii away.
fn spheroid(axes: [f64; 2], surface: f64) -> String {
    let [a, b] = axes;
    format!(
        r#"
        title = "spheroid"
        geometry = "axisymmetric"
        fluid = {{ model = "stokes", viscosity = 1.0 }}
        domain.half-disc = {{ radius = 1e6 }}
        boundary = {{ wall = "no-slip" }}
        mesh = {{ size = 2e5, surface = {surface}, growth = 0.2 }}
        time.steady = {{}}
        [[body]]
        name = "spheroid"
        shape = {{ spheroid = {{ semi_axes = [{a:?}, {b:?}] }} }}
        center = [0.0, 0.0]
        motion = {{ imposed = {{ velocity = [1.0, 0.0] }} }}
        "#
    )
}

const AXES: [&str; 2] = ["body.0.shape.spheroid.semi_axes.0", "body.0.shape.spheroid.semi_axes.1"];

/// The drag (N) of a spheroid and its derivatives by both axes.
fn drag(axes: [f64; 2]) -> [f64; 3] {
    let text = spheroid(axes, 0.12);
    let found = &gradients_of(&text, &["spheroid.force.x"], &AXES, false).unwrap()[0];
    [-found.value, -found.by[0], -found.by[1]]
}

#[test]
fn drag_of_a_spheroid_follows_its_axes_as_the_exact_solution_does() {
    let exact = |[a, b]: [f64; 2]| 6.0 * PI * b * oberbeck(a / b);
    let [a, b, step] = [2.0, 1.0, 1e-4];
    let by_a = (exact([a + step, b]) - exact([a - step, b])) / (2.0 * step);
    let by_b = (exact([a, b + step]) - exact([a, b - step])) / (2.0 * step);
    let [value, found_a, found_b] = drag([a, b]);
    assert!((value / exact([a, b]) - 1.0).abs() < 1e-4, "{value}");
    assert!((found_a / by_a - 1.0).abs() < 1e-3, "{found_a} and {by_a}");
    assert!((found_b / by_b - 1.0).abs() < 1e-3, "{found_b} and {by_b}");
    // Without inertia drag is proportional to length
    assert!(((a * found_a + b * found_b) / value - 1.0).abs() < 1e-4);
}

/// Of all spheroids of a volume that of aspect 1.952 has the least drag along its axis, 0.9555 of the ball's.
#[test]
fn the_spheroid_of_least_drag_is_where_the_gradient_vanishes() {
    // Drag over the third root of the volume a b^2 with b = 1
    let slope = |a: f64| {
        let [value, by_a, _] = drag([a, 1.0]);
        by_a / value - 1.0 / (3.0 * a)
    };
    let [mut before, mut a] = [1.8, 2.1];
    let mut slope_before = slope(before);
    for _ in 0..3 {
        let here = slope(a);
        let next = a - here * (a - before) / (here - slope_before);
        (before, slope_before, a) = (a, here, next);
    }
    assert!((a - 1.952).abs() < 3e-3, "{a}");
    let ratio = drag([a, 1.0])[0] / (6.0 * PI * a.cbrt());
    assert!((ratio - 0.9555).abs() < 1e-4, "{ratio}");
}

/// A squirmer with modes of the slip in a fluid that ends ten thousand radii away.
fn squirmer(modes: &[f64]) -> String {
    format!(
        r#"
        title = "squirmer"
        geometry = "axisymmetric"
        fluid = {{ model = "stokes", viscosity = 1.5 }}
        domain.half-disc = {{ radius = 1e4 }}
        boundary = {{ wall = "no-slip" }}
        mesh = {{ size = 2e3, surface = 0.1, growth = 0.2 }}
        time.steady = {{}}
        [[body]]
        name = "squirmer"
        shape = {{ sphere = {{ radius = 2.0 }} }}
        center = [0.0, 0.0]
        motion = "free"
        gait = {{ squirmer = {{ modes = {modes:?} }} }}
        "#
    )
}

/// Velocity U = 2 B1 / 3 and power P = (8 pi / 3) mu a (2 B1^2 + B2^2).
#[test]
fn velocity_and_power_of_a_squirmer_follow_modes_radius_and_viscosity_exactly() {
    let [mu, a, first, second] = [1.5, 2.0, 1.2, 0.9];
    let by = [
        "body.0.gait.squirmer.modes.0",
        "body.0.gait.squirmer.modes.1",
        "body.0.shape.sphere.radius",
        "fluid.viscosity",
    ];
    let of = ["squirmer.velocity.x", "squirmer.power"];
    let found = gradients_of(&squirmer(&[first, second]), &of, &by, false).unwrap();
    let velocity = 2.0 / 3.0 * first;
    let factor = 8.0 * PI / 3.0;
    let power = factor * mu * a * (2.0 * first * first + second * second);
    let wanted = [
        [velocity, 2.0 / 3.0, 0.0, 0.0, 0.0],
        [
            power,
            factor * mu * a * 4.0 * first,
            factor * mu * a * 2.0 * second,
            power / a,
            power / mu,
        ],
    ];
    for (found, wanted) in found.iter().zip(wanted) {
        let all = [found.value].into_iter().chain(found.by.iter().copied());
        for (found, exact) in all.zip(wanted) {
            assert!((found - exact).abs() < 1e-3 * wanted[0], "{found} and {exact}");
        }
    }
}

/// Of all slips with given modes the first alone spends least for its velocity: Lighthill's efficiency 6 pi mu a U^2 / P is
/// 1/2 then. Modes beyond the first carry no velocity, so it grows as power falls, whose slopes vanish there.
#[test]
fn the_squirmer_of_best_efficiency_has_the_first_mode_alone() {
    let text = squirmer(&[1.0, 0.0, 0.0]);
    let read = |settings: &[String]| Case::parse("squirmer.toml", &text, settings);
    let keys = ["body.0.gait.squirmer.modes.1", "body.0.gait.squirmer.modes.2"];
    let at = |modes: [f64; 2], of: &str| {
        let numbers = [0, 1].map(|index| NumberAt { key: keys[index], value: modes[index] });
        value_and_gradient(&read, of, &numbers).unwrap()
    };
    // Steps along the slopes, each as long as the change of its slope in the last one tells
    let mut before = [0.6, -0.4];
    let mut slopes_before = at(before, "squirmer.power").by;
    let mut modes = [0.5, -0.3];
    for _ in 0..2 {
        let slopes = at(modes, "squirmer.power").by;
        let next = [0, 1].map(|index| {
            let curvature = (slopes[index] - slopes_before[index]) / (modes[index] - before[index]);
            modes[index] - slopes[index] / curvature
        });
        (before, slopes_before, modes) = (modes, slopes, next);
    }
    assert!(modes.iter().all(|mode| mode.abs() < 1e-4), "{modes:?}");
    let [power, velocity] = ["squirmer.power", "squirmer.velocity.x"].map(|of| at(modes, of).value);
    let efficiency = 6.0 * PI * 1.5 * 2.0 * velocity * velocity / power;
    assert!((efficiency - 0.5).abs() < 1e-3, "{efficiency}");
}
