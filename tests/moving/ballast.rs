//! Bodies whose mass, centre of mass and inertia are not those of their shapes.

use std::f64::consts::PI;

use alewife_core::case::Model;
use alewife_core::run::{RunSummary, SavedState, simulate};
use tests::cases::{case, column, last, run};
use tests::{figure, resumed, stopped};

/// A heavy body in the middle of a wide container of thin fluid, turned by an angle (rad).
fn pendulum(geometry: &str, rest: &str, time: &str) -> Model {
    let (head, domain, center, turned) = match geometry {
        "planar" => ("shape.disc.radius = 0.5", "disc", "[0.0, 0.0]", "angle = 0.2"),
        _ => (
            "shape.sphere.radius = 0.5",
            "sphere",
            "[0.0, 0.0, 0.0]",
            "orientation.turned = { axis = [0.0, 0.0, 1.0], angle = 0.2 }",
        ),
    };
    let gravity = if geometry == "planar" { "[0.0, -1.0]" } else { "[0.0, -1.0, 0.0]" };
    let low = if geometry == "planar" { "[0.0, -0.2]" } else { "[0.0, -0.2, 0.0]" };
    let surface = if geometry == "planar" { 0.12 } else { 0.2 };
    let locked = if geometry == "planar" { "['x', 'y']" } else { "['x', 'y', 'z']" };
    case(&format!(
        r#"
        title = "a bottom-heavy body rocks"
        geometry = "{geometry}"
        fluid = {{ model = "unsteady-stokes", density = 1.0, viscosity = 1e-3, gravity = {gravity} }}
        domain.{domain}.radius = 3.0
        boundary.wall = "no-slip"
        mesh = {{ size = 1.0, surface = {surface}, growth = 0.4 }}
        time.unsteady = {{ {time} }}
        [[body]]
        name = "body"
        {head}
        center = {center}
        {turned}
        center_of_mass = {low}
        motion = "free"
        locked = {locked}
        {rest}
        "#
    ))
}

/// Held at its centre of mass, a round body turns about it under the moment of its buoyancy there, l m_f g sin(phi);
/// it moves off the centre of its shape, so that fluid moves with it as added mass m_a at that lever:
/// (I + m_a l^2) phi'' = -l m_f g phi, in fluid that is nearly without friction. In the plane m_a is m_f, in space m_f / 2.
#[test]
fn a_bottom_heavy_body_rocks_with_the_period_of_a_physical_pendulum() {
    let lever: f64 = 0.2;
    for (geometry, inertia, tensor) in
        [("planar", 20.0, "20.0"), ("spatial", 10.0, "[10.0, 10.0, 10.0]")]
    {
        let (displaced, added) = if geometry == "planar" {
            (PI * 0.25, PI * 0.25)
        } else {
            (4.0 / 3.0 * PI * 0.125, 2.0 / 3.0 * PI * 0.125)
        };
        let whole = inertia + added * lever * lever;
        let rate = (lever * displaced / whole).sqrt();
        // A quarter of a period: upright there
        let quarter = PI / 2.0 / rate;
        let rest = format!("mass = 2.0\ninertia = {tensor}");
        let n = if geometry == "planar" { 40.0 } else { 10.0 };
        let time = format!("step = {}, end = {}", quarter / n, quarter);
        let model = pendulum(geometry, &rest, &time);
        let outcome = if geometry == "planar" {
            run(&model)
        } else {
            simulate::<3>(&model, &mut []).expect("the case runs")
        };
        let angle = if geometry == "planar" {
            last(&outcome, "body.angle")
        } else {
            2.0 * last(&outcome, "body.orientation.z").asin()
        };
        let spin = if geometry == "planar" {
            last(&outcome, "body.angular_velocity")
        } else {
            last(&outcome, "body.angular_velocity.z")
        };
        // 0.2 sin(phi) / phi makes the period longer by 0.25 %
        let (late, slow) = (angle / 0.2, spin / (-0.2 * rate) - 1.0);
        figure!(late, "{geometry}: angle at a quarter of the period");
        figure!(slow, "{geometry}: rate there");
        assert!(late.abs() < 0.04 && slow.abs() < 0.04, "{geometry}: {late:e} {slow:e}");
    }
}

/// In Stokes flow a disc in a shear of rate gamma turns with -gamma / 2 but for its weight below its centre, which
/// stops it where 4 pi mu a^2 (gamma / 2) = l m g sin(phi): Kessler's gyrotaxis. The disc is neutrally buoyant.
#[test]
fn a_bottom_heavy_disc_in_shear_stops_at_the_angle_of_the_balance_of_torques() {
    let (lever, radius, rate) = (0.05, 0.5, 1.0_f64);
    let case_of = |gravity: f64, rest: &str| {
        case(&format!(
            r#"
            title = "a bottom-heavy disc in a shear"
            geometry = "planar"
            fluid = {{ model = "stokes", density = 1.0, viscosity = 1.0, gravity = [0.0, -{gravity}] }}
            domain.box = {{ min = [-4.0, -4.0], max = [4.0, 4.0] }}
            boundary = {{ bottom.shear.rate = {rate}, top.shear.rate = {rate}, left.periodic = "right", right.periodic = "left" }}
            mesh = {{ size = 1.0, surface = 0.1 }}
            time.unsteady = {{ step = 0.25, end = 10.0 }}
            [[body]]
            name = "disc"
            shape.disc.radius = {radius}
            center = [0.0, 0.0]
            motion = "free"
            {rest}
            "#
        ))
    };
    // What holds it against the shear, measured by the same elements
    let held = run(&case_of(0.0, "locked = [\"rotation\"]"));
    let torque = last(&held, "disc.torque");
    let exact_torque = -4.0 * PI * radius * radius * rate / 2.0;
    assert!((torque / exact_torque - 1.0).abs() < 0.15, "{torque} {exact_torque}");
    let weight = PI * radius * radius;
    let gravity = 2.0 * torque.abs() / (lever * weight);
    let outcome = run(&case_of(gravity, &format!("center_of_mass = [0.0, -{lever}]")));
    // sin(phi) is a half
    let error = last(&outcome, "disc.angle") + PI / 6.0;
    figure!(error, "angle of gyrotaxis");
    assert!(error.abs() < 5e-3, "{error:e}");
    assert!(last(&outcome, "disc.angular_velocity").abs() < 1e-3);
}

/// A squirmer swims along its axis however its mass lies, and turns up where it is bottom-heavy.
#[test]
fn a_bottom_heavy_squirmer_swims_as_before_and_turns_up() {
    let squirmer = |gravity: &str, rest: &str| {
        run(&case(&format!(
            r#"
            title = "a bottom-heavy squirmer"
            geometry = "planar"
            fluid = {{ model = "stokes", density = 1.0, viscosity = 1.0, gravity = {gravity} }}
            domain.disc.radius = 6.0
            boundary.wall = "no-slip"
            mesh = {{ size = 1.5, surface = 0.15 }}
            time.unsteady = {{ step = 0.1, end = 3.0 }}
            [[body]]
            name = "s"
            shape.disc.radius = 0.5
            center = [0.0, 0.0]
            motion = "free"
            gait.squirmer = {{ modes = [0.2] }}
            {rest}
            "#
        )))
    };
    let off = "center_of_mass = [-0.1, 0.0]";
    let [plain, level] = ["", off].map(|rest| squirmer("[0.0, 0.0]", rest));
    let [one, other] = [&plain, &level].map(|outcome| last(outcome, "s.velocity.x"));
    assert!((one / other - 1.0).abs() < 1e-5 && one > 0.05, "{one} {other}");
    // What is reported is the centre of mass
    let [one, other] = [&plain, &level].map(|outcome| last(outcome, "s.x"));
    assert!((one - other - 0.1).abs() < 1e-5, "{one} {other}");
    let angles = column(&squirmer("[0.0, -40.0]", off), "s.angle");
    assert!(angles.windows(2).all(|pair| pair[1] >= pair[0]), "{angles:?}");
    let up = angles.last().expect("there are rows") - PI / 2.0;
    assert!(up < 0.0 && up > -0.2, "{up}");
}

/// An end that the mass of the shape gives as well: the same to rounding.
#[test]
fn what_the_shape_has_by_itself_may_be_given() {
    let fall = |rest: &str| {
        run(&case(&format!(
            r#"
            title = "an ellipse falls"
            geometry = "planar"
            fluid = {{ model = "navier-stokes", density = 1.0, viscosity = 0.1, gravity = [0.3, -1.0] }}
            domain.disc.radius = 3.0
            boundary.wall = "no-slip"
            mesh = {{ size = 1.0, surface = 0.15 }}
            time.unsteady = {{ step = 0.05, end = 0.5 }}
            [[body]]
            name = "e"
            shape.ellipse.semi_axes = [0.5, 0.3]
            center = [0.0, 0.0]
            angle = 0.5
            motion = "free"
            {rest}
            "#
        )))
    };
    let mass = 2.0 * PI * 0.5 * 0.3;
    let inertia = mass * (0.25 + 0.09) / 4.0;
    let one = fall("density = 2.0");
    let other =
        fall(&format!("mass = {mass:e}\ninertia = {inertia:e}\ncenter_of_mass = [0.0, 0.0]"));
    for quantity in ["e.x", "e.y", "e.angle", "e.velocity.x", "e.angular_velocity"] {
        let [one, other] = [&one, &other].map(|outcome| last(outcome, quantity));
        assert!((one - other).abs() < 1e-11, "{quantity}: {one} {other}");
    }
}

fn bits(outcome: &RunSummary) -> Vec<u64> {
    outcome.series.rows.iter().flatten().map(|value| value.to_bits()).collect()
}

#[test]
fn a_bottom_heavy_body_ends_with_the_same_bits_when_it_resumes() {
    for time in ["step = 0.1, end = 0.6", "step = 0.05, end = 0.6, adaptive.tolerance = 1e-2"] {
        let model = pendulum("planar", "mass = 2.0", time);
        let whole = run(&model);
        let saved: SavedState<2> = stopped(&model, 2);
        assert_eq!(bits(&resumed(&model, &saved).expect("it continues")), bits(&whole));
    }
}
