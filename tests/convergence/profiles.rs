//! Velocities on sides by numbers at places: what flows in is that of the numbers, to second order in their distance.

use std::f64::consts::PI;

use alewife_core::case::Model;
use alewife_core::run::{RunError, simulate};
use tests::cases::{case, last, run};

/// Rows of a height and a velocity along x at so many intervals.
fn rows(n: u32, [low, high]: [f64; 2], velocity: impl Fn(f64) -> f64) -> String {
    let at = |k: u32| low + (high - low) * f64::from(k) / f64::from(n);
    // From the top, since rows come in any order
    let all = (0..=n).rev().map(|k| format!("[{:?}, {:?}]", at(k), velocity(at(k))));
    format!(
        "{{ profile = {{ columns = ['y', 'velocity.x'], rows = [{}] }} }}",
        all.collect::<Vec<_>>().join(", ")
    )
}

/// A channel between walls, or a tube, with a condition on its left.
fn channel(geometry: &str, left: &str) -> Model {
    let (domain, walls) = match geometry {
        "planar" => ("channel = { length = 2.0, height = 1.0 }", "bottom = 'no-slip', top"),
        _ => ("cylinder = { x = [0.0, 2.0], radius = 1.0 }", "wall"),
    };
    case(&format!(
        "
title = 'a channel with a given inflow'
geometry = '{geometry}'
fluid = {{ model = 'stokes', viscosity = 1.0 }}
domain.{domain}
boundary = {{ left = {left}, right = 'do-nothing', {walls} = 'no-slip' }}
mesh = {{ size = 0.1 }}
time.steady = {{}}
output.sides = true
"
    ))
}

#[test]
fn what_flows_in_is_that_of_the_rows_to_second_order() {
    let parabola: fn(f64) -> f64 = |y| 6.0 * y * (1.0 - y);
    let paraboloid: fn(f64) -> f64 = |r| 2.0 * (1.0 - r * r);
    for (geometry, velocity, flux, below) in
        [("planar", parabola, 1.0, 1.0), ("axisymmetric", paraboloid, PI, 1.0 / 3.0)]
    {
        let off = [5, 10].map(|n| {
            let outcome = run(&channel(geometry, &rows(n, [0.0, 1.0], velocity)));
            let [inflow, outflow] =
                ["left", "right"].map(|side| last(&outcome, &format!("{side}.flux")));
            assert!((inflow + outflow).abs() < 1e-9 * flux, "{geometry}: {inflow} {outflow}");
            inflow / flux - 1.0
        });
        // Straight lines between places are below the curve by h^2 / 12 of its second derivative in the mean
        for (error, n) in off.iter().zip([5.0_f64, 10.0]) {
            assert!((error * n * n / below + 1.0).abs() < 0.1, "{geometry}: {off:?}");
        }
        let plain = run(&channel(geometry, &rows(200, [0.0, 1.0], velocity)));
        assert!((last(&plain, "left.flux") / flux - 1.0).abs() < 1e-4);
    }
}

/// A box with a flow through its left side that is a product of parabolas, by an expression or at places all over it.
fn duct(left: &str) -> Model {
    case(&format!(
        "
title = 'a duct with a given inflow'
geometry = 'spatial'
fluid = {{ model = 'stokes', viscosity = 1.0 }}
domain.box = {{ min = [0.0, 0.0, 0.0], max = [1.0, 1.0, 1.0] }}
boundary = {{ left = {left}, right = 'do-nothing', bottom = 'no-slip', top = 'no-slip', back = 'no-slip', front = 'no-slip' }}
mesh = {{ size = 0.3 }}
time.steady = {{}}
output.sides = true
"
    ))
}

#[test]
fn places_all_over_a_side_in_space_tell_its_velocity() {
    let velocity = |y: f64, z: f64| 16.0 * y * (1.0 - y) * z * (1.0 - z);
    let flux = |left: &str| {
        let outcome = simulate::<3>(&duct(left), &mut []).expect("the case runs");
        last(&outcome, "left.flux")
    };
    let exact = flux("{ velocity = { value = ['16*y*(1-y)*z*(1-z)', 0.0, 0.0] } }");
    let off = [6_u32, 12].map(|n| {
        let at = |k: u32| f64::from(k) / f64::from(n);
        let places = (0..=n).flat_map(|j| (0..=n).map(move |k| [j, k]));
        // With x as well, which is the same all over a flat side
        let row = |[j, k]: [u32; 2]| {
            format!("[0.0, {:?}, {:?}, {:?}]", at(j), at(k), velocity(at(j), at(k)))
        };
        let rows = places.map(row).collect::<Vec<_>>().join(", ");
        let columns = "columns = ['x', 'y', 'z', 'velocity.x']";
        flux(&format!("{{ profile = {{ {columns}, rows = [{rows}] }} }}")) / exact - 1.0
    });
    let order = (off[0] / off[1]).log2();
    assert!(off[1].abs() < 0.03 && order > 1.5, "{off:?}, order {order}");
}

#[test]
fn a_profile_reaches_to_the_rim_of_its_side_on_a_line() {
    let refused = |left: &str| match simulate::<2>(&channel("planar", left), &mut []) {
        Err(RunError::Unsupported(message)) => message,
        other => panic!("{:?}", other.map(drop)),
    };
    let short = refused(&rows(8, [0.0, 0.5], |_| 1.0));
    assert!(short.contains("on side `left` ends 5.000e-1 before"), "{short}");
    let bent = "{ profile = { columns = ['x', 'y', 'velocity.x'], rows = [[0.0, 0.0, 0.0], [0.2, 0.5, 1.0], [0.0, 1.0, 0.0]] } }";
    assert!(refused(bent).contains("off a line"));
    // Across the side, and in another unit
    let along = "{ profile = { columns = ['x', 'velocity.x'], rows = [[0.0, 0.0], [0.5, 1.0], [1.0, 0.0]] } }";
    assert!(refused(along).contains("take another coordinate"));
    let in_mm = refused(&rows(14, [0.0, 1000.0], |_| 1.0));
    assert!(in_mm.contains("in the unit of the case"), "{in_mm}");
    // Values at the middles of cells end half a cell before the walls
    let middles = rows(9, [0.05, 0.95], |y| 6.0 * y * (1.0 - y));
    let outcome = run(&channel("planar", &middles));
    assert!((last(&outcome, "left.flux") - 1.0).abs() < 0.05);
}
