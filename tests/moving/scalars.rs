//! Scalars that the flow carries: exact solutions, orders, constants and amounts on meshes that move and are replaced.

use alewife_core::case::Model;
use alewife_core::run::simulate;
use tests::cases::{case, last, run};
use tests::{resumed, stopped};

/// A box at rest with a scalar that is zero on all sides.
fn at_rest(time: &str, mesh: f64, scalar: &str) -> Model {
    case(&format!(
        r#"
        title = "diffusion"
        geometry = "planar"
        fluid = {{ model = "stokes", viscosity = 1.0 }}
        domain.box = {{ min = [0.0, 0.0], max = [1.0, 1.0] }}
        boundary = {{ left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }}
        mesh.size = {mesh}
        {time}
        probe = [{{ name = "middle", point = [0.5, 0.5] }}]
        [[scalar]]
        name = "c"
        diffusivity = 0.1
        boundary = {{ left.value = 0.0, right.value = 0.0, bottom.value = 0.0, top.value = 0.0 }}
        {scalar}
        "#
    ))
}

#[test]
fn diffusion_is_of_third_order_in_space() {
    let source = "source = \"2*pi^2*0.1*sin(pi*x)*sin(pi*y)\"";
    let error = |mesh: f64| {
        let outcome = run(&at_rest("time.steady = {}", mesh, source));
        let sides = ["left", "right", "bottom", "top"];
        let flux: f64 =
            sides.iter().map(|side| last(&outcome, &format!("scalar.c.{side}.flux"))).sum();
        assert!((flux + last(&outcome, "scalar.c.source")).abs() < 1e-13, "{flux}");
        (last(&outcome, "scalar.c.total") - (2.0 / std::f64::consts::PI).powi(2)).abs()
    };
    let [coarse, fine] = [error(0.2), error(0.05)];
    assert!(fine < coarse / 64.0, "{coarse:.2e} {fine:.2e}");
}

#[test]
fn diffusion_is_of_second_order_in_time_and_its_amount_is_accounted_for() {
    let error = |step: f64| {
        let time = format!("time.unsteady = {{ step = {step}, end = 1.0 }}");
        let outcome = run(&at_rest(&time, 0.1, "initial = \"sin(pi*x)*sin(pi*y)\""));
        assert!(last(&outcome, "scalar.c.defect").abs() < 1e-13);
        let exact = (-0.2 * std::f64::consts::PI.powi(2)).exp();
        (last(&outcome, "scalar.c.middle.value") - exact).abs()
    };
    let [coarse, fine] = [error(0.1), error(0.05)];
    assert!(fine < coarse / 3.6, "{coarse:.2e} {fine:.2e}");
}

#[test]
fn convection_is_resolved_where_it_is_strong() {
    let exact = 1.5_f64.sin() * 1.25;
    let error = |mesh: f64, diffusivity: f64| {
        let text = format!(
            r#"
            title = "a channel"
            geometry = "planar"
            fluid = {{ model = "stokes", viscosity = 1.0 }}
            domain.channel = {{ length = 3.0, height = 1.0 }}
            boundary = {{ left.parabolic.peak = 1.0, right = "do-nothing", bottom = "no-slip", top = "no-slip" }}
            mesh.size = {mesh}
            time.steady = {{}}
            probe = [{{ name = "middle", point = [1.5, 0.5] }}]
            define.k = {diffusivity}
            [[scalar]]
            name = "c"
            diffusivity = {diffusivity}
            source = "4*y*(1-y)*cos(x)*(1+y^2) + k*(sin(x)*(1+y^2) - 2*sin(x))"
            boundary.left.value = "sin(x)*(1+y^2)"
            boundary.right.value = "sin(x)*(1+y^2)"
            boundary.bottom.value = "sin(x)*(1+y^2)"
            boundary.top.value = "sin(x)*(1+y^2)"
            "#
        );
        (last(&run(&case(&text)), "scalar.c.middle.value") - exact).abs()
    };
    for diffusivity in [0.1, 0.001] {
        let [coarse, fine] = [error(0.3, diffusivity), error(0.075, diffusivity)];
        assert!(fine < coarse / 64.0, "k = {diffusivity}: {coarse:.2e} {fine:.2e}");
    }
}

/// A shell between spheres of radii 1 and 2 that are kept cold, in its slowest mode: sin(pi (r - 1)) / r, which decays as
/// exp(-k pi^2 t).
fn shell(geometry: &str, domain: &str, mesh: &str, step: f64) -> Model {
    let (square, zeros) = match geometry {
        "axisymmetric" => ("x^2 + y^2", "0.0, 0.0"),
        _ => ("x^2 + y^2 + z^2", "0.0, 0.0, 0.0"),
    };
    let axis = if geometry == "axisymmetric" { "axis = \"axis\"," } else { "" };
    case(&format!(
        r#"
        title = "a shell cools"
        geometry = "{geometry}"
        fluid = {{ model = "stokes", viscosity = 1.0 }}
        domain.{domain}
        boundary = {{ {axis} wall = "no-slip" }}
        mesh = {mesh}
        time.unsteady = {{ step = {step}, end = 0.2 }}
        body = [{{ name = "b", shape.sphere.radius = 1.0, center = [{zeros}], motion = "held" }}]
        [[scalar]]
        name = "c"
        diffusivity = 0.5
        initial = "sin(pi*(sqrt({square}) - 1))/sqrt({square})"
        boundary.wall.value = 0.0
        body.b.value = 0.0
        "#
    ))
}

/// What comes through the inner sphere, -4 pi k pi, and through the outer one, twice that, at the start.
#[test]
fn a_shell_cools_through_both_spheres() {
    let pi = std::f64::consts::PI;
    let exact = -2.0 * pi * pi * (-0.1 * pi * pi).exp();
    let off = |outcome: &alewife_core::run::RunSummary| {
        let defect = last(outcome, "scalar.c.defect");
        assert!(defect.abs() < 1e-11, "{defect:.1e}");
        ["b", "wall"].map(|name| last(outcome, &format!("scalar.c.{name}.flux")))
    };
    let around = |step: f64| {
        let mesh = "{ size = 0.2, surface = 0.1 }";
        let outcome = run(&shell("axisymmetric", "half-disc.radius = 2.0", mesh, step));
        let [inner, outer] = off(&outcome);
        [inner / exact - 1.0, outer / (2.0 * exact) - 1.0].map(f64::abs)
    };
    let [coarse, fine] = [around(0.04), around(0.02)];
    for (coarse, fine) in coarse.iter().zip(fine) {
        assert!(fine < coarse / 3.2 && fine < 4e-3, "{coarse:.2e} {fine:.2e}");
    }
    let ball = "sphere = { center = [0.0, 0.0, 0.0], radius = 2.0 }";
    let model = shell("spatial", ball, "{ size = 1.0, surface = 0.5, gap_layers = 2 }", 0.04);
    let outcome = simulate::<3>(&model, &mut []).expect("it runs");
    let [inner, outer] = off(&outcome);
    assert!((inner / exact - 1.0).abs() < 0.02, "{inner} {exact}");
    assert!((outer / (2.0 * exact) - 1.0).abs() < 0.02, "{outer} {exact}");
}

/// A wave that a stream carries through a periodic channel and that decays: cos(pi (x - t)) exp(-k pi^2 t).
#[test]
fn a_wave_is_carried_through_periodic_sides_to_second_order_by_both_schemes() {
    let exact = (0.3 * std::f64::consts::PI).cos() * (-0.02 * std::f64::consts::PI.powi(2)).exp();
    for scheme in ["bdf2", "rk3"] {
        let error = |step: f64| {
            let model = case(&format!(
                r#"
                title = "a wave"
                geometry = "planar"
                fluid = {{ model = "stokes", viscosity = 1.0 }}
                domain.box = {{ min = [0.0, 0.0], max = [2.0, 1.0] }}
                mesh.size = 0.15
                time.unsteady = {{ step = {step}, end = 0.4, scheme = "{scheme}" }}
                probe = [{{ name = "p", point = [0.7, 0.5] }}]
                scalar = [{{ name = "c", diffusivity = 0.05, initial = "cos(pi*x)" }}]
                [boundary]
                left.periodic = "right"
                right.periodic = "left"
                bottom.velocity.value = [1.0, 0.0]
                top.velocity.value = [1.0, 0.0]
                "#
            ));
            let outcome = run(&model);
            assert!(last(&outcome, "scalar.c.defect").abs() < 1e-12);
            (last(&outcome, "scalar.c.p.value") - exact).abs()
        };
        let [coarse, fine] = [error(0.08), error(0.04)];
        assert!(fine < coarse / 3.2, "{scheme}: {coarse:.2e} {fine:.2e}");
    }
}

/// A disc that is driven through a box with two scalars, of which one is constant.
fn stirred(step: f64, end: f64, more: &str) -> Model {
    case(&format!(
        r#"
        title = "a disc stirs"
        geometry = "planar"
        fluid = {{ model = "stokes", viscosity = 1.0 }}
        domain.box = {{ min = [-2.0, -1.0], max = [2.0, 1.0] }}
        boundary = {{ left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }}
        mesh = {{ size = 0.25, surface = 0.1 }}
        time.unsteady = {{ step = {step}, end = {end} }}
        body = [{{ name = "b", shape.disc.radius = 0.3, center = [-1.0, 0.1], motion.imposed = {{ velocity = [1.0, 0.1] }} }}]
        scalar = [
            {{ name = "k", diffusivity = 0.05, initial = 3.0 }},
            {{ name = "c", diffusivity = 0.05, initial = "1 + 0.5*sin(x)*cos(y)" {more} }},
        ]
        "#
    ))
}

#[test]
fn on_a_mesh_that_moves_a_constant_stays_and_the_amount_is_kept_to_second_order() {
    let defect = |step: f64| {
        let outcome = run(&stirred(step, 0.8, ""));
        for extreme in ["minimum", "maximum"] {
            assert!((last(&outcome, &format!("scalar.k.{extreme}")) - 3.0).abs() < 1e-12);
        }
        assert!(last(&outcome, "scalar.k.defect").abs() < 1e-11);
        last(&outcome, "scalar.c.defect").abs()
    };
    let [coarse, fine] = [defect(0.1), defect(0.05)];
    assert!(fine < coarse / 2.8 && fine < 2e-3, "{coarse:.2e} {fine:.2e}");
}

#[test]
fn on_a_new_mesh_a_constant_stays_and_the_amount_is_kept() {
    let outcome = run(&stirred(0.1, 2.0, ""));
    assert!(last(&outcome, "flow.remeshes") > 0.0);
    assert!((last(&outcome, "scalar.k.maximum") - 3.0).abs() < 1e-10);
    assert!((last(&outcome, "scalar.k.minimum") - 3.0).abs() < 1e-10);
    assert!(last(&outcome, "scalar.c.defect").abs() < 5e-3, "of 7.8");
}

#[test]
fn a_run_that_resumes_has_the_same_scalars() {
    let model = stirred(0.1, 0.6, ", body.b.uptake.rate = 0.3");
    let whole = run(&model);
    let state = stopped::<2>(&model, 3);
    let rest = resumed::<2>(&model, &state).expect("it resumes");
    let bits = |rows: &[Vec<f64>]| -> Vec<u64> {
        rows.last().expect("there are rows").iter().map(|value| value.to_bits()).collect()
    };
    assert_eq!(bits(&whole.series.rows), bits(&rest.series.rows));
    assert!(last(&whole, "scalar.c.b.flux") < 0.0, "it takes up");
}
