//! Sides that drive: pressures, tractions, developed flows and expressions, against exact flows.

use std::f64::consts::PI;

use alewife_core::run::{RunSummary, simulate};
use tests::cases::{case, last, run};

/// A channel of length 3 and height 1, viscosity 0.7, with these ends.
fn channel(ends: &str, more: &str) -> RunSummary {
    run(&case(&format!(
        r#"
        title = "channel"
        geometry = "planar"
        fluid.model = "navier-stokes"
        fluid.viscosity = 0.7
        fluid.density = 1.3
        domain.channel = {{ length = 3.0, height = 1.0 }}
        boundary = {{ {ends}, bottom = "no-slip", top = "no-slip" }}
        mesh = {{ size = 0.3 }}
        time.steady = {{ tolerance = 1e-12 }}
        define = {{ drop = 2.0, U = 1.5 }}
        {more}
        "#
    )))
}

#[track_caller]
fn is_near(found: f64, wanted: f64) {
    assert!((found - wanted).abs() < 1e-9 * wanted.abs().max(1.0), "{found} for {wanted}");
}

/// H^3 dp / (12 mu L), whichever end has the pressure, and by a number or an expression.
#[test]
fn a_pressure_drives_poiseuille_flow() {
    let flux = 2.0 / (12.0 * 0.7 * 3.0);
    for (ends, sign) in [
        ("left.pressure.value = 2.0, right = \"do-nothing\"", 1.0),
        ("left.pressure.value = 3.5, right.pressure.value = 1.5", 1.0),
        ("left.pressure.value = \"drop * (y + 1 - y)\", right.pressure.value = 0", 1.0),
        ("left = \"do-nothing\", right.pressure.value = \"drop\"", -1.0),
    ] {
        let outcome = channel(ends, "");
        is_near(last(&outcome, "left.flux"), sign * flux);
        is_near(last(&outcome, "right.flux"), -sign * flux);
        let ends = last(&outcome, "left.force.x") + last(&outcome, "right.force.x");
        is_near(ends, -sign * 2.0);
        let walls = last(&outcome, "top.force.x") + last(&outcome, "bottom.force.x");
        is_near(walls, sign * 2.0);
    }
    let tube = run(&case(
        r#"
        title = "tube"
        geometry = "axisymmetric"
        fluid = { model = "stokes", viscosity = 0.5 }
        domain.cylinder = { x = [0.0, 2.0], radius = 1.0 }
        boundary = { left.pressure.value = 3.0, right = "do-nothing", wall = "no-slip" }
        mesh = { size = 0.3 }
        time.steady = {}
        "#,
    ));
    is_near(last(&tube, "left.flux"), PI * 3.0 / (8.0 * 0.5 * 2.0));
    is_near(last(&tube, "wall.force.x"), 3.0 * PI);
}

/// What is given is what the side has, corners included; and the rest holds it.
#[test]
fn a_traction_is_that_of_the_side() {
    let outcome = channel("left.traction.value = [2.0, 0.5], right = \"traction-free\"", "");
    is_near(last(&outcome, "left.force.x"), -2.0);
    is_near(last(&outcome, "left.force.y"), -0.5);
    is_near(last(&outcome, "left.mean_traction.x"), -2.0);
    is_near(last(&outcome, "right.force.x"), 0.0);
    assert!(last(&outcome, "left.flux") > 0.05);
}

#[test]
fn a_developed_flow_has_its_flux_and_its_peak() {
    for (ends, mean) in [
        ("left.developed.flux = 0.5, right = \"do-nothing\"", 0.5),
        ("left.developed.peak = 0.75, right = \"do-nothing\"", 0.5),
        ("left = \"do-nothing\", right.developed.flux = -0.5", 0.5),
        ("left.developed.flux = 0.5, right.developed.flux = -0.5", 0.5),
    ] {
        let outcome = channel(ends, "");
        is_near(last(&outcome, "left.flux"), mean);
        is_near(last(&outcome, "top.force.x"), 6.0 * mean * 0.7 * 3.0);
    }
    // Half a channel: the flow is fastest at the plane of symmetry
    let half = run(&case(
        r#"
        title = "half a channel"
        geometry = "planar"
        fluid = { model = "stokes", viscosity = 1.0 }
        domain.channel = { length = 2.0, height = 1.0 }
        boundary = { bottom = "symmetry", top = "no-slip", left.developed.peak = 3.0, right = "do-nothing" }
        mesh = { size = 0.3 }
        time.steady = {}
        "#,
    ));
    is_near(last(&half, "left.flux"), 2.0);
    is_near(last(&half, "top.force.x"), 2.0 * 3.0 * 2.0);
}

/// In space it is the solution of a Poisson problem on the side: a duct of 1 by 0.5 has the friction of the series.
#[test]
fn a_developed_flow_enters_a_duct() {
    let outcome = simulate::<3>(
        &case(
            r#"
            title = "duct"
            geometry = "spatial"
            fluid = { model = "stokes", viscosity = 1.0 }
            domain.box = { min = [0.0, 0.0, 0.0], max = [1.0, 1.0, 0.5] }
            mesh = { size = 0.25 }
            time.steady = {}
            [boundary]
            left.developed.flux = 0.2
            right = "do-nothing"
            bottom = "no-slip"
            top = "no-slip"
            back = "no-slip"
            front = "no-slip"
            "#,
        ),
        &mut [],
    )
    .expect("it is solved");
    is_near(last(&outcome, "left.flux"), 0.2);
    let sides = ["left", "right", "bottom", "top", "back", "front"];
    let net: f64 = sides.iter().map(|side| last(&outcome, &format!("{side}.flux"))).sum();
    assert!((net + last(&outcome, "flow.mass_defect")).abs() < 1e-12, "{net}");
    let (a, b) = (0.5_f64, 1.0);
    let odd = (0..20).map(|n| f64::from(2 * n + 1));
    let series: f64 = odd.map(|n| (n * PI * b / (2.0 * a)).tanh() / n.powi(5)).sum();
    let flux_of_unit = a.powi(3) * b / 12.0 * (1.0 - 192.0 * a / (PI.powi(5) * b) * series);
    // The gradient 0.2 / flux_of_unit pushes on the section over the length of 1
    let wanted = 0.2 / flux_of_unit * a * b;
    let walls = ["bottom", "top", "back", "front"];
    let held: f64 = walls.iter().map(|side| last(&outcome, &format!("{side}.force.x"))).sum();
    assert!((held / wanted - 1.0).abs() < 0.03, "{held} for {wanted}");
}

#[test]
fn expressions_give_the_same_flow_as_the_profiles_they_write() {
    let written =
        channel("left.velocity.value = [\"4*U*y*(1 - y)\", 0.0], right = \"do-nothing\"", "");
    let known = channel("left.parabolic.peak = 1.5, right = \"do-nothing\"", "");
    for name in ["left.flux", "right.flux", "top.force.x", "left.mean_pressure"] {
        is_near(last(&written, name), last(&known, name));
    }
    let forced = channel(
        "left.pressure.value = 0.0, right = \"do-nothing\"",
        "fluid.force = [\"drop\", 0.0]",
    );
    is_near(last(&forced, "left.flux"), 2.0 / (12.0 * 0.7));
}

/// In a closed box a force that has a potential is balanced by the pressure, to the bit of the solver.
#[test]
fn a_force_with_a_potential_moves_nothing() {
    let outcome = run(&case(
        r#"
        title = "box"
        geometry = "planar"
        fluid = { model = "stokes", viscosity = 1.0, force = ["2 + 0*x", -3] }
        domain.box = { min = [0.0, 0.0], max = [1.0, 2.0] }
        boundary = { left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }
        mesh = { size = 0.3 }
        time.steady = {}
        [[probe]]
        name = "a"
        point = [0.5, 0.5]
        "#,
    ));
    assert!(last(&outcome, "a.velocity.x").abs() < 1e-10);
    is_near(last(&outcome, "right.mean_pressure") - last(&outcome, "left.mean_pressure"), 2.0);
    is_near(last(&outcome, "top.mean_pressure") - last(&outcome, "bottom.mean_pressure"), -6.0);
}

/// The decaying vortices of Taylor and Green, by expressions at the start and on all sides.
#[test]
fn decaying_vortices_are_written_by_expressions() {
    let error = |size: f64, step: f64| {
        let velocity = "[\"-cos(pi*x)*sin(pi*y)*exp(-2*nu*pi^2*t)\", \
                        \"sin(pi*x)*cos(pi*y)*exp(-2*nu*pi^2*t)\"]";
        let side = format!("{{ velocity = {{ value = {velocity} }} }}");
        let outcome = run(&case(&format!(
            r#"
            title = "vortices"
            geometry = "planar"
            define.nu = 0.05
            fluid = {{ model = "navier-stokes", viscosity = 0.05, density = 1.0 }}
            domain.box = {{ min = [-0.2, 0.1], max = [0.8, 1.1] }}
            boundary = {{ left = {side}, right = {side}, bottom = {side}, top = {side} }}
            mesh = {{ size = {size} }}
            time.unsteady = {{ step = {step}, end = 0.2 }}
            initial.velocity = {velocity}
            [[probe]]
            name = "a"
            point = [0.25, 0.45]
            "#
        )));
        let (x, y) = (0.25 * PI, 0.45 * PI);
        let decay = (-2.0 * 0.05 * PI * PI * 0.2_f64).exp();
        (last(&outcome, "a.velocity.x") + x.cos() * y.sin() * decay).abs()
            + (last(&outcome, "a.velocity.y") - x.sin() * y.cos() * decay).abs()
    };
    let (coarse, fine) = (error(0.25, 0.02), error(0.125, 0.01));
    assert!(coarse < 2e-2 && fine < 0.25 * coarse, "{coarse} {fine}");
}
