//! Slip by expressions along bodies of any shape, against squirmers, the reciprocal theorem and turning surfaces.

use std::f64::consts::{PI, TAU};

use alewife_core::case::{Case, Model};
use alewife_core::run::simulate;
use tests::cases::{case, column, last, run};
use tests::figure;

/// A free body far within a wall, without inertia.
fn alone(geometry: &str, domain: &str, body: &str) -> Model {
    let walls = if geometry == "planar" { "" } else { "axis = \"axis\"," };
    case(&format!(
        r#"
        title = "slip"
        geometry = "{geometry}"
        fluid = {{ model = "stokes", viscosity = 1.0 }}
        domain.{domain}.radius = 1000.0
        boundary = {{ {walls} wall = "no-slip" }}
        mesh = {{ size = 300.0, surface = 0.05, growth = 0.3 }}
        time.steady = {{}}
        body = [{{ name = "b", center = [0.0, 0.0], motion = "free", {body} }}]
        "#
    ))
}

/// What is along the surface of -b e_x is B_1 = b of a squirmer, and that of -c (x / a) e_x is B_2 = c on a sphere, c / 2 on a disc.
#[test]
fn slip_by_expressions_is_that_of_a_squirmer() {
    for (geometry, domain, shape, turned, second) in [
        ("planar", "disc", "disc", "angle = 0.7,", "1.5"),
        ("axisymmetric", "half-disc", "sphere", "", "3.0"),
    ] {
        let swim = |gait: &str| {
            let body = format!("shape.{shape}.radius = 2.0, {turned} gait.{gait}");
            let outcome = run(&alone(geometry, domain, &body));
            ["velocity.x", "power"].map(|name| last(&outcome, &format!("b.{name}")))
        };
        let own = swim("slip.velocity = [\"-1.5 - 3*x/2\", 0]");
        let squirmer = swim(&format!("squirmer.modes = [1.5, {second}]"));
        for (own, squirmer) in own.iter().zip(squirmer) {
            assert!((own / squirmer - 1.0).abs() < 1e-10, "{shape}: {own} {squirmer}");
        }
    }
}

/// The tractions on an ellipse or spheroid that is moved are those of a constant over its area or volume times the distance h
/// of its tangent from the centre, so that one with slip u swims at -(1 / dV) times the integral of h u.
#[test]
fn slender_bodies_swim_by_the_reciprocal_theorem() {
    let [a, b] = [1.0, 0.4];
    // Along x, by slip of -e_x: the mean of 1 - n_x^2 with the weight h
    let exact = |is_revolved: bool| {
        let (mut sum, mut whole, n) = (0.0, 0.0, 2000);
        for nth in 0..n {
            let angle = (f64::from(nth) + 0.5) / f64::from(n) * if is_revolved { PI } else { TAU };
            let (sin, cos) = angle.sin_cos();
            let [x, y] = [a * cos, b * sin];
            let [p, q] = [x / (a * a), y / (b * b)];
            let h = 1.0 / p.hypot(q);
            let ring = if is_revolved { y } else { 1.0 };
            let weight = h * (a * sin).hypot(b * cos) * ring;
            sum += weight * (1.0 - (h * p).powi(2));
            whole += weight;
        }
        sum / whole
    };
    let slip = "gait.slip.velocity = [-1.0, 0.0]";
    let ellipse = format!("shape.ellipse.semi_axes = [{a}, {b}], {slip}");
    let spheroid = format!("shape.spheroid.semi_axes = [{a}, {b}], {slip}");
    for (name, model, is_revolved) in [
        ("ellipse", alone("planar", "disc", &ellipse), false),
        ("spheroid", alone("axisymmetric", "half-disc", &spheroid), true),
    ] {
        let off = last(&run(&model), "b.velocity.x") / exact(is_revolved) - 1.0;
        figure!(off, "{name}");
        assert!(off.abs() < 2e-4, "{name}: {off:.1e}");
    }
}

/// A sphere of triangles whose surface turns about an axis of its frame turns back as fast, and moves next to no fluid.
#[test]
fn a_surface_that_turns_moves_no_fluid() {
    let settings = [
        "mesh={ size = 1.5, surface = 0.8, gap_layers = 1 }",
        "domain.sphere.radius=4.0",
        "define.rate=2.0",
        "body.0.center=[0.3, 0.2, 0.1]",
        "body.0.orientation={ along = [0.0, 1.0, 0.0] }",
        "body.0.motion=free",
        "body.0.gait={ slip = { velocity = [0, \"-rate*z\", \"rate*y\"] } }",
    ];
    let settings = settings.map(str::to_owned);
    let model = Case::read("surface-3d/sphere-320", &settings).expect("it is shipped").model;
    let outcome = simulate::<3>(&model, &mut []).expect("it runs");
    // The x axis of the body is the y axis of the world
    let turn = last(&outcome, "body.angular_velocity.y");
    assert!((turn + 2.0).abs() < 1e-3, "{turn}");
    // Beside 8 pi mu a^3 rate^2, that of a sphere which is held while its surface turns
    let power = last(&outcome, "body.power") / (32.0 * PI);
    assert!(power.abs() < 1e-3, "{power:.1e}");
    assert!(last(&outcome, "body.velocity.x").abs() < 2e-3);
}

/// The same of a disc off the middle of a box, in time.
#[test]
fn a_disc_turns_back_as_its_surface_turns_in_time() {
    let model = case(
        r#"
        title = "slip"
        geometry = "planar"
        fluid = { model = "stokes", viscosity = 1.0 }
        domain.box = { min = [-2.0, -2.0], max = [2.0, 2.0] }
        boundary = { left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }
        mesh = { size = 0.5, surface = 0.15 }
        time.unsteady = { step = 0.1, end = 0.5 }
        define.rate = 2.0
        body = [{
            name = "b", shape.disc.radius = 0.5, center = [0.6, 0.3], motion = "free",
            gait.slip.velocity = ["-rate*cos(3*t)*y", "rate*cos(3*t)*x"],
        }]
        "#,
    );
    let outcome = run(&model);
    let turns = column(&outcome, "b.angular_velocity");
    for (time, turn) in outcome.series.times.iter().zip(turns) {
        let off = turn + 2.0 * (3.0 * time).cos();
        assert!(off.abs() < 1e-4, "{time}: {off:.1e}");
    }
    assert!(last(&outcome, "b.power").abs() < 1e-6);
}
