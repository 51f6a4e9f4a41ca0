//! Bodies in fluids whose viscosity depends on the rate of shear: loads, swimmers, all schemes, bad input.

use alewife_core::run::simulate;
use tests::cases::{PERIODIC_BOX, case, column, last, run};

use super::{CARREAU, LAWS};

/// A square array of cylinders held in a mean flow.
fn array(viscosity: &str, size: f64) -> String {
    format!(
        r#"
        title = "a square array"
        geometry = "planar"
        fluid = {{ model = "stokes", viscosity = {viscosity} }}
        flow.mean_velocity = [1.0, 0.0]
        domain.box = {{ min = [-0.5, -0.5], max = [0.5, 0.5] }}
        {PERIODIC_BOX}
        mesh = {{ size = 0.1, surface = {size} }}
        time.steady = {{}}
        [[body]]
        name = "cylinder"
        shape.disc.radius = 0.25
        center = [0.0, 0.0]
        motion = "held"
        "#
    )
}

/// By the residual, by the integral of the stress, and by the pressure gradient; power is what is dissipated.
#[test]
fn loads_are_those_of_the_local_viscosity() {
    for law in LAWS {
        let outcome = run(&case(&array(law, 0.02)));
        let [force, surface, gradient] =
            ["cylinder.force.x", "cylinder.surface_force.x", "flow.pressure_gradient.x"]
                .map(|name| last(&outcome, name));
        assert!((force + gradient).abs() < 1e-7 * force, "{law}: {force} {gradient}");
        assert!((surface / force - 1.0).abs() < 2e-2, "{law}: {force} {surface}");
        let dissipation = last(&outcome, "flow.dissipation");
        assert!((dissipation / force - 1.0).abs() < 1e-7, "{law}: {force} {dissipation}");
    }
}

/// A squirmer at the centre of a ball.
fn squirmer(geometry: &str, rest: &str) -> String {
    format!(
        r#"
        title = "a squirmer"
        geometry = "{geometry}"
        fluid = {{ model = "stokes", viscosity = {CARREAU} }}
        boundary.wall = "no-slip"
        {rest}
        "#
    )
}

fn squirmer_on_axis(radius: f64, mesh: &str) -> String {
    let rest = format!(
        r#"
        domain.half-disc.radius = {radius}
        mesh = {{ {mesh}, growth = 0.2 }}
        time.steady = {{}}
        [[body]]
        name = "squirmer"
        shape.sphere.radius = 1.0
        center = [0.0, 0.0]
        motion = "free"
        gait.squirmer.modes = [1.0, 0.5]
        "#
    );
    squirmer("axisymmetric", &rest)
}

#[test]
fn a_squirmer_in_space_is_that_on_an_axis() {
    let on_axis = run(&case(&squirmer_on_axis(3.0, "size = 0.3, surface = 0.1")));
    let rest = r#"
        domain.sphere.radius = 3.0
        mesh = { size = 1.0, surface = 0.3, growth = 0.5 }
        time.steady = {}
        [[body]]
        name = "squirmer"
        shape.sphere.radius = 1.0
        center = [0.0, 0.0, 0.0]
        motion = "free"
        gait.squirmer = { modes = [1.0, 0.5], axis = [0.6, 0.8, 0.0] }
        "#;
    let outcome = simulate::<3>(&case(&squirmer("spatial", rest)), &mut []).expect("it runs");
    let [x, y] = ["squirmer.velocity.x", "squirmer.velocity.y"].map(|name| last(&outcome, name));
    let [speed, expected] = [0.6 * x + 0.8 * y, last(&on_axis, "squirmer.velocity.x")];
    println!("{speed} {expected}, power {}", last(&outcome, "squirmer.power"));
    assert!((speed / expected - 1.0).abs() < 1e-2, "{speed} {expected}");
    let [power, wanted] = [&outcome, &on_axis].map(|outcome| last(outcome, "squirmer.power"));
    assert!((power / wanted - 1.0).abs() < 2e-2, "{power} {wanted}");
}

/// The way of a squirmer whose stroke oscillates, without inertia.
fn oscillating(scheme: &str, step: f64) -> f64 {
    let rest = format!(
        r#"
        frame = "squirmer"
        domain.half-disc.radius = 3.0
        mesh = {{ size = 0.6, surface = 0.2, growth = 0.3 }}
        time.unsteady = {{ step = {step}, end = 1.0, {scheme} }}
        [[body]]
        name = "squirmer"
        shape.sphere.radius = 1.0
        center = [0.0, 0.0]
        motion = "free"
        [body.gait.squirmer]
        modes = [1.5, 3.0]
        factors.1.sine = {{ mean = 1.0, amplitude = 0.8, period = 2.0 }}
        factors.2.sine = {{ mean = 0.5, amplitude = 1.0, period = 1.0 }}
        "#
    );
    let outcome = run(&case(&squirmer("axisymmetric", &rest)));
    assert!(column(&outcome, "flow.dissipation").iter().all(|value| *value > 0.0));
    last(&outcome, "squirmer.x")
}

#[test]
fn without_inertia_all_schemes_lead_to_the_same_place() {
    let explicit = oscillating("scheme = \"rk3\"", 0.1);
    let newton = oscillating("convection = \"newton\"", 0.025);
    let extrapolated = [0.1, 0.05, 0.025].map(|step| oscillating("", step));
    println!("{explicit} {newton} {extrapolated:?}");
    assert!((newton / explicit - 1.0).abs() < 2e-3, "{newton} {explicit}");
    assert!((extrapolated[2] / explicit - 1.0).abs() < 2e-3, "{extrapolated:?} {explicit}");
}
