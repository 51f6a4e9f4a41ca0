//! Bodies on joints to the laboratory.

use std::f64::consts::PI;

use alewife_core::case::Model;
use alewife_core::run::{RunSummary, SavedState, simulate};
use tests::cases::{case, column, last, run};
use tests::{figure, resumed, stopped};

fn hung(time: &str, body: &str, joint: &str) -> Model {
    case(&format!(
        r#"
        title = "a body on a pivot"
        geometry = "planar"
        fluid = {{ model = "unsteady-stokes", density = 1.0, viscosity = 1e-3, gravity = [0.0, -1.0] }}
        domain.disc.radius = 4.0
        boundary.wall = "no-slip"
        mesh = {{ size = 1.0, surface = 0.1, growth = 0.4 }}
        time.unsteady = {{ {time} }}
        [[body]]
        name = "bob"
        shape.disc.radius = 0.5
        center = [{x}, {y}]
        angle = {angle}
        motion = "free"
        {body}
        [[joint]]
        parent = "laboratory"
        child = "bob"
        on_parent = [0.3, 0.2]
        on_child = [0.0, 0.8]
        {joint}
        "#,
        x = 0.3 + 0.8 * f64::sin(TILT),
        y = 0.2 - 0.8 * f64::cos(TILT),
        angle = TILT,
    ))
}

const TILT: f64 = 0.1;

/// (I + (m + m_a) l^2) phi'' = -(m - m_f) g l sin(phi) of a heavy disc on a pivot, m_a = m_f; in fluid that is
/// nearly without friction.
#[test]
fn a_pendulum_on_the_laboratory_has_its_period() {
    let density = 20.0;
    let displaced = PI * 0.25;
    let (mass, lever) = (density * displaced, 0.8);
    let inertia = 0.5 * mass * 0.25 + (mass + displaced) * lever * lever;
    let rate = ((mass - displaced) * lever / inertia).sqrt();
    let quarter = PI / 2.0 / rate;
    let time = format!("step = {}, end = {quarter}", quarter / 40.0);
    let outcome = run(&hung(&time, &format!("density = {density}"), "kind.hinge = {}"));
    let late = last(&outcome, "bob.angle") / TILT;
    let slow = last(&outcome, "bob.angular_velocity") / (-TILT * rate) - 1.0;
    figure!(late, "angle at a quarter of the period");
    figure!(slow, "rate there");
    assert!(late.abs() < 0.03 && slow.abs() < 0.03, "{late:e} {slow:e}");
    // It stays on its pivot
    let (angle, x, y) =
        (last(&outcome, "bob.angle"), last(&outcome, "bob.x"), last(&outcome, "bob.y"));
    assert!((x - 0.3 - 0.8 * angle.sin()).abs() < 1e-12, "{x}");
    assert!((y - 0.2 + 0.8 * angle.cos()).abs() < 1e-12, "{y}");
}

/// The torque that bends a body at rest is minus that of weight less buoyancy about the pivot.
#[test]
fn the_reaction_of_a_pivot_is_minus_the_load() {
    let body = "density = 3.0";
    let outcome =
        run(&hung("step = 0.1, end = 0.2", body, &format!("kind.bent.angle.constant = {TILT}")));
    let weight = 2.0 * PI * 0.25;
    let exact = weight * 0.8 * f64::sin(TILT);
    let error = last(&outcome, "bob.joint.torque") / exact - 1.0;
    figure!(error, "torque of a pivot");
    assert!(error.abs() < 1e-6, "{error:e}");
    assert!(column(&outcome, "bob.x").windows(2).all(|pair| pair[0] == pair[1]));
}

/// On a slider a body goes as one that is locked across it: against its own weight.
#[test]
fn a_slider_to_the_laboratory_is_a_lock() {
    let text = |rest: &str| {
        format!(
            r#"
            title = "a disc on a rail"
            geometry = "planar"
            fluid = {{ model = "navier-stokes", density = 1.0, viscosity = 0.1, gravity = [0.5, -1.0] }}
            domain.disc.radius = 3.0
            boundary.wall = "no-slip"
            mesh = {{ size = 1.0, surface = 0.15 }}
            time.unsteady = {{ step = 0.05, end = 0.5 }}
            [[body]]
            name = "d"
            shape.disc.radius = 0.5
            center = [0.0, 0.0]
            density = 2.0
            motion = "free"
            {rest}
            "#
        )
    };
    let locked = run(&case(&text("locked = ['y', 'rotation']")));
    let joint = "[[joint]]\nparent = 'laboratory'\nchild = 'd'\nkind.slider = {}";
    let railed = run(&case(&text(joint)));
    for quantity in ["d.x", "d.velocity.x", "d.force.x", "d.force.y"] {
        let [one, other] = [&locked, &railed].map(|outcome| last(outcome, quantity));
        assert!((one - other).abs() < 1e-9 * (1.0 + one.abs()), "{quantity}: {one} {other}");
    }
    let (length, x) = (last(&railed, "d.joint.length"), last(&railed, "d.x"));
    assert!((length - x).abs() < 1e-12 && x > 0.01, "{length} {x}");
}

/// On the axis an arm of given length moves a sphere as an imposed motion does; in space a ball joint holds one at its
/// centre, which a torque turns.
#[test]
fn spheres_hang_on_the_laboratory_on_the_axis_and_in_space() {
    let sphere = |geometry: &str, domain: &str, center: &str, end: f64, rest: &str| {
        case(&format!(
            r#"
            title = "a sphere on a joint"
            geometry = "{geometry}"
            fluid = {{ model = "stokes", viscosity = 1.0 }}
            domain.{domain}.radius = 4.0
            boundary.wall = "no-slip"
            mesh = {{ size = 2.0, surface = 0.4 }}
            time.unsteady = {{ step = 0.1, end = {end} }}
            [[body]]
            name = "s"
            shape.sphere.radius = 1.0
            center = {center}
            motion = "free"
            {rest}
            "#
        ))
    };
    let arm = "[[joint]]\nparent = 'laboratory'\nchild = 's'\nkind.arm.length.sine = { mean = 0.5, amplitude = 0.2, period = 2.0 }";
    let outcome = run(&sphere("axisymmetric", "half-disc", "[0.5, 0.0]", 0.5, arm));
    assert!((last(&outcome, "s.x") - 0.7).abs() < 1e-12, "{}", last(&outcome, "s.x"));
    let ball =
        "torque = [0.0, 4.0, 3.0]\n[[joint]]\nparent = 'laboratory'\nchild = 's'\nkind.ball = {}";
    // Without inertia it turns at once
    let model = sphere("spatial", "sphere", "[0.0, 0.0, 0.0]", 0.2, ball);
    let outcome = simulate::<3>(&model, &mut []).expect("the case runs");
    let spin = ["x", "y", "z"].map(|axis| last(&outcome, &format!("s.angular_velocity.{axis}")));
    let exact = 5.0 / (8.0 * PI) * (1.0 - 1.0 / 64.0);
    let size = spin.iter().map(|part| part * part).sum::<f64>().sqrt();
    figure!(size / exact - 1.0, "spin of a sphere on a ball joint");
    assert!((size / exact - 1.0).abs() < 0.05, "{spin:?} {exact}");
    assert!((spin[1] / spin[2] - 4.0 / 3.0).abs() < 0.02, "{spin:?}");
    assert!(["x", "y", "z"].iter().all(|axis| last(&outcome, &format!("s.{axis}")).abs() < 1e-12));
}

fn bits(outcome: &RunSummary) -> Vec<u64> {
    outcome.series.rows.iter().flatten().map(|value| value.to_bits()).collect()
}

#[test]
fn a_pendulum_ends_with_the_same_bits_when_it_resumes() {
    for time in ["step = 0.1, end = 0.6", "step = 0.05, end = 0.6, adaptive.tolerance = 1e-2"] {
        let model = hung(time, "density = 5.0", "kind.hinge.stiffness = 1.0");
        let saved: SavedState<2> = stopped(&model, 2);
        assert_eq!(bits(&resumed(&model, &saved).expect("it continues")), bits(&run(&model)));
    }
}
