//! Bodies that are guided, pulled, sprung, set off or hung on the laboratory, in cases without a domain.

use alewife::case::{Case, CaseFile, Severity, check, check_flow, check_reduced};
use alewife::reduced::simulate;
use alewife::run::Series;

use super::last;

/// An ellipse of the area pi/20 in a fluid of density 1 that resists with 1 a velocity along, by `drag`.
fn text(motion: &str, drag: f64) -> String {
    format!(
        "
title = 't'
geometry = 'planar'
fluid = {{ model = 'navier-stokes', density = 1.0, viscosity = 1.0 }}
time.unsteady = {{ step = 0.01, end = 2.0 }}
[reduced]
loads = 'fossen'
coefficients = {{ linear_surge = {drag}, linear_sway = {drag}, linear_yaw = {drag} }}
[[body]]
name = 'b'
shape.ellipse.semi_axes = [0.5, 0.1]
center = [1.0, 2.0]
{motion}
"
    )
}

fn parsed(text: &str, settings: &[&str]) -> CaseFile {
    let settings: Vec<String> = settings.iter().map(|one| (*one).to_owned()).collect();
    Case::parse("t.toml", text, &settings).unwrap()
}

fn moved(text: &str, settings: &[&str]) -> Series {
    let file = parsed(text, settings);
    let wrong: Vec<_> =
        check(&file).into_iter().filter(|one| one.severity == Severity::Error).collect();
    assert!(wrong.is_empty(), "{wrong:?}");
    assert!(check_reduced(&file).is_empty(), "{:?}", check_reduced(&file));
    simulate(&file.model).unwrap()
}

const MASS: f64 = std::f64::consts::PI / 20.0;

#[test]
fn imposed_velocities_are_kept_and_resisted() {
    let motion = "motion.imposed = { velocity = [0.3, -0.1], angular_velocity = -0.5, \
                  factor.smooth-ramp.duration = 1.0 }";
    let series = moved(&text(motion, 1.0), &[]);
    // The integral of the factor is 1/2 over its second, and 1 over the next
    for (name, start, rate) in [("x", 1.0, 0.3), ("y", 2.0, -0.1), ("angle", 0.0, -0.5)] {
        let found = last(&series, &format!("b.{name}"));
        assert!((found - start - 1.5 * rate).abs() < 1e-4, "{name}: {found}");
    }
    let force = ["x", "y"].map(|axis| last(&series, &format!("b.force.{axis}")));
    assert!((force[0] + 0.3).abs() < 1e-9 && (force[1] - 0.1).abs() < 1e-9, "{force:?}");
    assert!((last(&series, "b.torque") - 0.5).abs() < 1e-9);
}

#[test]
fn motions_by_axis_are_given_held_or_free() {
    let motion =
        "motion = { x = 'free', y = { imposed.sine = { amplitude = 0.2, period = 1.5 } }, \
                  rotation = { velocity.value = 0.4 } }
force = [0.5, 0.0]";
    let series = moved(&text(motion, 1.0), &[]);
    let y = series.column("b.y").unwrap();
    for (time, y) in series.times.iter().zip(&y) {
        let stroke = 0.2 * (std::f64::consts::TAU * time / 1.5).sin();
        assert!((y - 2.0 - stroke).abs() < 1e-12, "{time}: {y}");
    }
    assert!((last(&series, "b.angle") - 0.8).abs() < 1e-12);
    // m v' = F - v
    let speed = 0.5 * (1.0 - (-2.0 / MASS).exp());
    assert!((last(&series, "b.velocity.x") - speed).abs() < 1e-4);
    let locked = moved(
        &text("motion = 'free'\nlocked = ['y', 'rotation']\nforce = [0.5, 1.0]\ntorque = 1.0", 1.0),
        &[],
    );
    assert!((last(&locked, "b.velocity.x") - speed).abs() < 1e-4);
    assert_eq!([last(&locked, "b.y"), last(&locked, "b.angle")], [2.0, 0.0]);
}

#[test]
fn a_spring_pulls_to_its_anchor() {
    let motion = "motion = 'free'
force = [0.0, 0.6]
spring = { stiffness = [4.0, 3.0], damping = [0.5, 0.5], anchor = [1.5, 2.0], torsion = 1.0, rest_angle = 0.3 }";
    let series = moved(&text(motion, 1.0), &["time.unsteady.end=40"]);
    let at = ["x", "y", "angle"].map(|name| last(&series, &format!("b.{name}")));
    for (at, expected) in at.into_iter().zip([1.5, 2.2, 0.3]) {
        assert!((at - expected).abs() < 1e-6, "{at} {expected}");
    }
}

#[test]
fn a_body_keeps_the_velocity_that_it_starts_with() {
    let motion = "motion = 'free'\nangle = 0.7\nvelocity = [0.3, -0.4]\nangular_velocity = 2.0\nmass = 0.2\ninertia = 0.05";
    let series = moved(&text(motion, 0.0), &[]);
    let ends = [("x", 1.6), ("y", 1.2), ("angle", 4.7)];
    for (name, expected) in ends {
        let found = last(&series, &format!("b.{name}"));
        assert!((found - expected).abs() < 1e-3, "{name}: {found}");
    }
    // A torque turns it by its own inertia, about its centre of mass, a force moves that by its mass
    let pulled = "motion = 'free'\nmass = 0.2\ninertia = 0.05\ncenter_of_mass = [0.1, 0.0]\ntorque = 0.1\nforce = [0.2, 0.0]";
    let series = moved(&text(pulled, 0.0), &[]);
    assert!((last(&series, "b.angular_velocity") - 4.0).abs() < 1e-9);
    assert!((last(&series, "b.velocity.x") - 2.0).abs() < 1e-9);
    let x = series.column("b.x").unwrap();
    assert!((x[0] - 1.1).abs() < 1e-12 && (x[x.len() - 1] - 3.1).abs() < 1e-9);
    // One that turns with the body goes round with it
    let turning =
        "motion = 'free'\nangular_velocity = 1.0\nforce = [0.2, 0.0]\nload_frame = 'body'";
    let series = moved(&text(turning, 0.0), &[]);
    let [x, y] = [2.0_f64.sin(), 1.0 - 2.0_f64.cos()].map(|part| 0.2 / MASS * part);
    assert!((last(&series, "b.velocity.x") - x).abs() < 1e-3);
    assert!((last(&series, "b.velocity.y") - y).abs() < 1e-3);
}

/// A pendulum that hangs on the laboratory by its end swings with the period of its moment about that.
#[test]
fn a_joint_to_the_laboratory_holds_its_end() {
    let motion = "motion = 'free'\nangle = 0.02\nmass = 1.0\ninertia = 0.1
[[joint]]
parent = 'laboratory'
child = 'b'
on_parent = [1.5, 2.0]
on_child = [0.5, 0.0]
kind.hinge = {}";
    let place = "body.0.center=[1.00009999333346666, 1.99000066665333]";
    let gravity = "fluid.gravity=[-9.0, 0.0]";
    let settings =
        [gravity, "time.unsteady.step=1e-3", place, "reduced.buoyancy.b={ volume = 0.0 }"];
    let series = moved(&text(motion, 0.0), &settings);
    let rate = (9.0 * 0.5 / (0.1 + 0.25_f64)).sqrt();
    for (row, time) in series.times.iter().enumerate() {
        let at = |name: &str| series.column(&format!("b.{name}")).unwrap()[row];
        let angle = 0.02 * (rate * time).cos();
        assert!((at("angle") - angle).abs() < 1e-4, "{time}: {} {angle}", at("angle"));
        let end = [at("x") + 0.5 * at("angle").cos(), at("y") + 0.5 * at("angle").sin()];
        assert!((end[0] - 1.5).hypot(end[1] - 2.0) < 1e-9, "{end:?}");
    }
}

/// In space a body that goes round with a rotation that is given, and freely along.
#[test]
fn in_space_rotations_are_given_or_held() {
    let text = "
title = 't'
geometry = 'spatial'
fluid = { model = 'navier-stokes', density = 1.0, viscosity = 0.01 }
time.unsteady = { step = 0.01, end = 2.0 }
reduced.loads = 'fossen'
[[body]]
name = 'b'
shape.sphere.radius = 0.5
center = [0.0, 0.0, 0.0]
mass = 2.0
force = [0.0, 0.0, 1.0]
motion = { z = 'free', rotation = { velocity.value = 0.5 }, axis = [0.0, 0.0, 2.0] }
";
    let series = moved(text, &[]);
    assert!((last(&series, "b.z") - 1.0).abs() < 1e-9 && last(&series, "b.x") == 0.0);
    let w = last(&series, "b.orientation.w").abs();
    assert!((w - 0.5_f64.cos()).abs() < 1e-12, "{w}");
    let free = "body.0.motion={ z = 'free', rotation = 'free' }";
    let found = check_reduced(&parsed(text, &[free]));
    assert_eq!(found.iter().map(|one| one.key.as_str()).collect::<Vec<_>>(), ["body.0.motion"]);
}

#[test]
fn the_full_solver_asks_for_what_is_left_out() {
    let file = parsed(&text("motion = 'free'\nforce = [1.0, 0.0]", 1.0), &[]);
    assert!(check(&file).is_empty(), "{:?}", check(&file));
    let missing: Vec<String> = check_flow(&file).into_iter().map(|one| one.key).collect();
    assert_eq!(missing, ["domain", "mesh"]);
    let again = file.case().to_toml().unwrap();
    assert!(!again.contains("domain") && !again.contains("mesh"), "{again}");
    assert_eq!(Case::parse("u.toml", &again, &[]).unwrap().case(), file.case());
    // Without a reduced model they are missed when the case is read
    let flow = text("motion = 'free'", 1.0).replace("[reduced]", "[define]");
    let error = Case::parse(
        "v.toml",
        &flow.replace("loads = 'fossen'", "").replace("coefficients", "#"),
        &[],
    );
    assert!(error.unwrap_err().to_string().contains("domain"));
}
