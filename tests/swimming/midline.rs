//! Fish whose midlines are given by the case swim as those with built-in gaits of the same formula.

use tests::cases::{case, column, run};

/// How a fish with a gait swims: its place, velocity, force and power at all steps.
fn swims(gait: &str) -> Vec<f64> {
    let outcome = run(&case(&format!(
        r#"
        title = "a fish in a tank"
        geometry = "planar"
        fluid = {{ model = "navier-stokes", viscosity = 0.01, density = 1.0 }}
        domain.box = {{ min = [-1.2, -0.8], max = [1.2, 0.8] }}
        boundary = {{ left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }}
        mesh = {{ size = 0.4, surface = 0.04 }}
        time.unsteady = {{ step = 0.02, end = 0.1 }}
        define = {{ K = 3.5, amplitude = 0.08 }}
        [[body]]
        name = "fish"
        shape.fish = {{ length = 1.0, tip_radius = 4e-3 }}
        center = [0.0, 0.0]
        motion = "free"
        gait.{gait}
        "#
    )));
    let names = ["fish.x", "fish.velocity.x", "fish.velocity.y", "fish.force.y", "fish.power"];
    names.iter().flat_map(|name| column(&outcome, name)).collect()
}

/// Largest difference over the largest value.
fn apart(one: &[f64], other: &[f64]) -> f64 {
    let most = one.iter().fold(0.0f64, |most, value| most.max(value.abs()));
    let off = one.iter().zip(other).map(|(one, other)| (one - other).abs());
    off.fold(0.0, f64::max) / most
}

#[test]
fn a_midline_of_the_same_formula_swims_as_the_gait_that_is_built_in() {
    let built_in = swims("carangiform = { period = 1.0, curvature = [[0.0, 3.5], [1.0, 7.0]] }");
    let wave = "midline = { period = 1.0, curvature = \"K*(1 + s)*sin(2*pi*(t - s))\" }";
    let off = apart(&built_in, &swims(wave));
    assert!(off < 1e-7, "curvature: {off}");
    let other = swims("midline = { period = 1.0, curvature = \"K*(1 + s)*sin(2*pi*(t + s))\" }");
    assert!(apart(&built_in, &other) > 0.01, "the wave runs the other way");

    let built_in = swims("anguilliform = { period = 1.0, amplitude = 0.08 }");
    let wave = "midline = { period = 1.0, lateral = \"amplitude*(s + 1/32)*sin(2*pi*(s - t))\" }";
    let off = apart(&built_in, &swims(wave));
    assert!(off < 1e-7, "displacement: {off}");
}

/// The wave of curvature at 13 positions and 16 times.
#[test]
fn a_midline_by_a_table_swims_as_its_formula() {
    let part = |nth: u32, of: u32| f64::from(nth) / f64::from(of);
    let positions: Vec<f64> = (0..=12).map(|i| part(i, 12)).collect();
    let row = |j: u32| {
        let t = part(j, 16);
        let value = |s: &f64| 3.5 * (1.0 + s) * (std::f64::consts::TAU * (t - s)).sin();
        [t].into_iter().chain(positions.iter().map(value)).collect::<Vec<f64>>()
    };
    let table: Vec<Vec<f64>> = (0..16).map(row).collect();
    let formula = swims("midline = { period = 1.0, curvature = \"K*(1 + s)*sin(2*pi*(t - s))\" }");
    let table = swims(&format!(
        "midline = {{ period = 1.0, positions = {positions:?}, table = {table:?} }}"
    ));
    let off = apart(&formula, &table);
    assert!(off < 0.02, "{off}");
}
