//! Elastic rods that meet walls, bodies, each other and themselves.

use std::f64::consts::PI;

use alewife_core::case::Model;
use alewife_core::run::{RunError, RunSummary, SavedState, simulate};
use tests::cases::{case, column, last, run};
use tests::{figure, resumed, stopped};

/// Rods in a closed box, whose bottom is at `bottom`.
fn boxed(fluid: &str, bottom: f64, time: &str, contact: &str, bodies: &str) -> Model {
    case(&format!(
        r#"
        title = "rods in a box"
        geometry = "planar"
        units = "dimensionless"
        fluid = {{ {fluid} }}
        domain.box = {{ min = [-1.2, {bottom}], max = [1.0, 0.8] }}
        boundary = {{ left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }}
        mesh = {{ growth = 0.4, gap_layers = 1, moving.layers = 1, size = 0.4, surface = 0.08 }}
        time.unsteady = {{ {time} }}
        contact.barrier = {{ {contact} }}
        {bodies}
        "#
    ))
}

/// A strip of a length of 1 and of half a width, with these keys.
fn strip(name: &str, half_width: f64, keys: &str) -> String {
    let [end, tip] = [0.97, 0.4].map(|part| part * half_width);
    let start = 1.0 - 1.5 * half_width;
    format!(
        r#"
        [[body]]
        name = "{name}"
        shape.fish = {{ length = 1.0, head_width = {half_width}, head_end = {half_width}, tail_start = {start}, tail_width = {end}, tip_radius = {tip}, corner_radius = {half_width} }}
        motion = "free"
        {keys}
        "#
    )
}

const HELD: &str = r#"attached = { hold = "clamped" }"#;

fn bits(summary: &RunSummary) -> Vec<u64> {
    summary.series.rows.iter().flatten().map(|value| value.to_bits()).collect()
}

/// A cantilever whose weight a wall carries near its tip. With weights w(s) along it and the reaction R at a distance a from the
/// clamp its tip is bent by the sum of w s^2 (3 - s) / 6 B less R a^2 (3 - a) / 6 B; for even weights W and a tip at rest R is
/// 3 W / 8.
#[test]
fn a_cantilever_rests_on_a_wall_with_the_reaction_of_a_propped_beam() {
    const PIECES: u32 = 4000;
    let keys = "center = [0.0, 0.0]\nforce = [0.0, -1.0]\nrod = { bending = 1.0, elements = 12 }";
    let rod = strip("rod", 0.01, &format!("{keys}\n{HELD}"));
    let fluid = "model = \"stokes\", viscosity = 5e-5";
    let contact = "range = 0.004, stiffness = 1000.0";
    let model = boxed(fluid, -0.03, "step = 0.1, end = 2.4", contact, &rod);
    let profile = model.bodies[0].shape.profile().expect("it is slender");
    let length = profile.length();
    let middles = (0..PIECES).map(|piece| length * (f64::from(piece) + 0.5) / f64::from(PIECES));
    // The force acts on the pieces by their masses
    let (mut mass, mut bent_by_weight) = (0.0, 0.0);
    for s in middles {
        let half_width = profile.find(s).half_width;
        mass += half_width;
        bent_by_weight += half_width * s * s * (3.0 * length - s) / 6.0;
    }
    let summary = run(&model);
    let value = |what: &str| last(&summary, &format!("rod.{what}"));
    let reaction = value("contact_force.y");
    // The clamp is a length in front of where the tip was
    let clamp = length + column(&summary, "rod.tip.x")[0];
    let at = clamp - value("x") - value("contact_torque") / reaction;
    let theory = (bent_by_weight / mass + value("tip.y")) * 6.0 / (at * at * (3.0 * length - at));
    figure!(reaction / theory - 1.0, "reaction over theory");
    assert!((reaction / theory - 1.0).abs() < 2e-3, "{reaction} {theory} at {at}");
    // Clamp and wall carry the weight, and the fluid nothing
    let carried = reaction + value("base_force.y") + value("force.y");
    assert!((carried - 1.0).abs() < 1e-10, "{carried}");
    assert!(value("force.y").abs() < 1e-4 && value("velocity.y").abs() < 1e-5);
}

const PUSHED: &str = r#"
    center = [0.0, 0.0]
    density = 2.0
    force = [0.0, -0.4]
    rod = { bending = 0.2, elements = 10 }
    "#;

const DISC: &str = r#"
    [[body]]
    name = "disc"
    shape.disc.radius = 0.15
    center = [0.2, -0.3]
    density = 2.0
    motion = "free"
    force = [0.0, 0.4]
    "#;

/// A free rod and a disc that are pressed together: contact gives as much momentum to one as it takes from the other, and a
/// turn about any point as well.
#[test]
fn a_rod_and_a_disc_that_collide_give_each_other_their_momentum() {
    let fluid = "model = \"navier-stokes\", density = 1.0, viscosity = 0.01";
    let bodies = strip("rod", 0.06, PUSHED) + DISC;
    let contact = "range = 0.03, stiffness = 50.0";
    let summary = run(&boxed(fluid, -0.8, "step = 0.02, end = 0.9", contact, &bodies));
    let of = |quantity: &str| column(&summary, quantity);
    let largest = of("rod.contact_force.y").into_iter().fold(0.0, f64::max);
    assert!(largest > 0.1, "{largest}");
    for row in 0..summary.series.rows.len() {
        let value = |quantity: &str| of(quantity)[row];
        let torque = |name: &str| {
            let of = |what: &str| value(&format!("{name}.{what}"));
            of("x") * of("contact_force.y") - of("y") * of("contact_force.x") + of("contact_torque")
        };
        for axis in ["x", "y"] {
            let both = ["rod", "disc"].map(|name| value(&format!("{name}.contact_force.{axis}")));
            assert!((both[0] + both[1]).abs() <= 1e-14 * largest, "{both:?}");
        }
        let both = torque("rod") + torque("disc");
        assert!(both.abs() < 1e-12 * largest, "{both:e}");
    }
    // With the fluid, whose force on each of them jumps as they meet; convection in coarse cells takes 1e-3 at most
    let defect = last(&summary, "flow.momentum_defect");
    figure!(defect, "momentum");
    assert!(defect < 2e-3, "{defect}");
    // Newton's second law for each of them, the mass of the rod being what it was in the first row
    let sum = |name: &str, row: usize| {
        of(&format!("{name}.force.y"))[row] + of(&format!("{name}.contact_force.y"))[row]
    };
    let rate = |name: &str, row: usize| of(&format!("{name}.acceleration.y"))[row];
    let rows = summary.series.rows.len();
    let mass = (sum("rod", rows - 1) - 0.4) / rate("rod", rows - 1);
    let of_disc = 2.0 * PI * 0.15_f64.powi(2);
    for row in 1..rows {
        let off = sum("disc", row) + 0.4 - of_disc * rate("disc", row);
        assert!(off.abs() < 1e-12, "{off:e} in row {row}");
        let off = sum("rod", row) - 0.4 - mass * rate("rod", row);
        assert!(off.abs() < 1e-9, "{off:e} in row {row}");
    }
}

/// The tip of a heavy cantilever that falls on a wall in a fluid that hardly resists: what is stored in rod, contact and
/// fluid, and the height of the load, never grow together.
#[test]
fn a_rebound_of_a_tip_makes_no_energy() {
    let keys = "center = [0.0, 0.0]\ndensity = 20.0\nforce = [0.0, -2.0]\nrod = { bending = 0.5, elements = 10 }";
    let rod = strip("rod", 0.06, &format!("{keys}\n{HELD}"));
    let fluid = "model = \"unsteady-stokes\", density = 1.0, viscosity = 0.002";
    let contact = "range = 0.03, stiffness = 50.0";
    let summary = run(&boxed(fluid, -0.2, "step = 0.02, end = 1.2", contact, &rod));
    let of = |quantity: &str| column(&summary, quantity);
    let stored = ["rod.elastic_energy", "rod.kinetic_energy", "flow.kinetic_energy"].map(of);
    let (contact, height) = (of("flow.contact_energy"), of("rod.y"));
    let energies: Vec<f64> = (0..height.len())
        .map(|row| {
            stored.iter().map(|energy| energy[row]).sum::<f64>() + contact[row] + 2.0 * height[row]
        })
        .collect();
    let impact = stored[1].iter().copied().fold(0.0, f64::max);
    let gain = energies.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::MIN, f64::max);
    let speeds = of("rod.velocity.y");
    let fastest = speeds.iter().copied().fold(f64::MIN, f64::max);
    assert!(fastest > 0.05, "it is thrown back: {fastest}");
    figure!(gain / impact, "energy made in a step");
    assert!(gain < 1e-3 * impact, "{gain} of {impact}");
    let made = last(&summary, "flow.contact_energy_made");
    assert!(made < 1e-3 * impact, "{made} of {impact}");
}

/// Two cilia that are pressed together.
fn touching() -> Model {
    let keys = |y: f64, force: f64| {
        format!(
            "center = [0.0, {y}]\nforce = [0.0, {force}]\nrod = {{ bending = 0.5, elements = 10 }}\n{HELD}"
        )
    };
    let bodies =
        strip("upper", 0.04, &keys(0.055, -2.0)) + &strip("lower", 0.04, &keys(-0.055, 1.0));
    let fluid = "model = \"stokes\", viscosity = 0.02";
    let contact = "range = 0.03, stiffness = 100.0";
    boxed(fluid, -0.8, "step = 0.04, end = 0.16", contact, &bodies)
}

#[test]
fn two_rods_that_touch_push_each_other_back() {
    let whole = run(&touching());
    let pressed = last(&whole, "upper.contact_force.y");
    assert!(pressed > 0.01, "{pressed}");
    for axis in ["x", "y"] {
        let [upper, lower] =
            ["upper", "lower"].map(|name| column(&whole, &format!("{name}.contact_force.{axis}")));
        let off = upper.iter().zip(&lower).map(|(one, other)| (one + other).abs());
        assert!(off.fold(0.0, f64::max) <= 1e-14 * pressed);
    }
}

#[test]
#[ignore = "long: 19 s; small: bodies_on_a_mesh_that_is_replaced_end_with_the_same_bits"]
fn two_rods_that_touch_end_with_the_same_bits() {
    let model = touching();
    let whole = simulate::<2>(&model, &mut []).expect("the case runs");
    assert!(last(&whole, "upper.contact_force.y") > 0.01);
    let saved: SavedState<2> = stopped(&model, 2);
    let rest = resumed(&model, &saved).expect("it continues");
    assert!(bits(&rest) == bits(&whole));
}

/// Contact of a rod with itself is not computed, and a run says so: which, and where.
#[test]
fn a_rod_that_meets_itself_ends_the_run() {
    let keys = "center = [0.0, 0.2]\nrod = { bending = 1.0, elements = 16 }\nactivation.curvature.sine = { amplitude = 8.0, period = 8.0 }";
    let fluid = "model = \"stokes\", viscosity = 0.01";
    let contact = "range = 0.02, stiffness = 10.0";
    let rod = strip("ring", 0.03, keys);
    let model = boxed(fluid, -0.8, "step = 0.05, end = 2.0", contact, &rod);
    let error = simulate::<2>(&model, &mut []).expect_err("its ends meet");
    let message = error.to_string();
    assert!(matches!(error, RunError::MeetsItself { .. }), "{message}");
    for word in ["`ring`", "from itself at (", "from its head", "not computed", "step "] {
        assert!(message.contains(word), "{word}: {message}");
    }
}
