//! Balances of energy and momentum with elastic rods, and the loads that hold them.

use alewife_core::case::Model;
use alewife_core::run::RunSummary;
use tests::cases::{case, column, last, run};
use tests::figure;

/// A closed box with these bodies.
fn boxed(fluid: &str, time: &str, bodies: &str) -> Model {
    case(&format!(
        r#"
        title = "rods in a box"
        geometry = "planar"
        fluid = {{ {fluid} }}
        domain.box = {{ min = [-1.2, -0.8], max = [1.2, 0.8] }}
        boundary = {{ left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }}
        mesh = {{ growth = 0.4, gap_layers = 1, moving.layers = 1, size = 0.4, surface = 0.08 }}
        time.unsteady = {{ {time} }}
        {bodies}
        "#
    ))
}

/// A slender body with these keys.
fn slender(keys: &str) -> String {
    format!(
        r#"
        [[body]]
        name = "rod"
        shape.fish = {{ length = 1.0, head_width = 0.08, head_end = 0.08, tail_width = 0.06, tip_radius = 0.02, corner_radius = 0.05 }}
        center = [0.1, 0.05]
        motion = "free"
        {keys}
        "#
    )
}

/// Integrals of quantities from a time on, and their changes.
struct Cycle<'a> {
    summary: &'a RunSummary,
    start: usize,
    step: f64,
}

impl Cycle<'_> {
    fn integral(&self, quantity: &str) -> f64 {
        let values = column(self.summary, quantity);
        let pairs = values[self.start..].windows(2);
        pairs.map(|pair| 0.5 * self.step * (pair[0] + pair[1])).sum()
    }

    fn change(&self, quantity: &str) -> f64 {
        let values = column(self.summary, quantity);
        values[values.len() - 1] - values[self.start]
    }
}

const DRIVEN: &str = r#"
    density = 3.0
    rod = { bending = 0.3, damping = 0.03, elements = 12 }
    attached.hold.angle.sine = { amplitude = 0.15, period = 1.0, ramp = 0.5 }
    activation = { curvature.sine = { amplitude = 0.6, period = 1.0, phase = 0.2, ramp = 0.5 }, wave_speed = 1.5 }
    "#;

/// What motor and muscles give in a cycle less what is dissipated in rod and fluid and what both store, over what they give:
/// of the rod with its work on the fluid, and of both.
fn defects(steps: u32, fluid: &str, body: &str) -> [f64; 2] {
    let step = 1.0 / f64::from(steps);
    // Behind the ramp, and the time that the wave takes to the tail
    let time = format!("step = {step}, end = 2.25");
    let summary = run(&boxed(fluid, &time, &slender(body)));
    let start = column(&summary, "rod.power").len() - 1 - steps as usize;
    let cycle = Cycle { summary: &summary, start, step };
    let given = cycle.integral("rod.base_power") + cycle.integral("rod.activation_power");
    let kept = cycle.integral("rod.internal_dissipation")
        + cycle.change("rod.elastic_energy")
        + cycle.change("rod.kinetic_energy");
    let taken = cycle.integral("flow.dissipation") + cycle.change("flow.kinetic_energy");
    assert!(given > 0.0, "{given}");
    [cycle.integral("rod.power"), taken].map(|taken| (given - kept - taken) / given)
}

const WITH_INERTIA: &str = "model = \"unsteady-stokes\", density = 1.0, viscosity = 0.1";
const WITHOUT: &str = "model = \"stokes\", viscosity = 1.0";

/// To a third of the square of the step times the rate of the cycle, by which its second difference is off: 8e-3.
#[test]
fn the_work_of_motor_and_muscles_is_dissipated_or_stored() {
    let massless = DRIVEN.replace("density = 3.0", "");
    for (fluid, body) in [(WITH_INERTIA, DRIVEN), (WITHOUT, &massless)] {
        let [of_rod, of_both] = defects(40, fluid, body);
        figure!(of_rod, "rod, {fluid}");
        figure!(of_both, "rod and fluid, {fluid}");
        assert!(of_rod.abs() < 1.5e-2 && of_both.abs() < 1.5e-2, "{of_rod} {of_both}");
    }
}

#[test]
#[ignore = "long: a minute; small: the_work_of_motor_and_muscles_is_dissipated_or_stored"]
fn the_work_of_motor_and_muscles_is_dissipated_or_stored_to_a_thousandth() {
    let (fluid, body) = (WITH_INERTIA, DRIVEN);
    let [of_rod, of_both] = defects(160, fluid, body);
    figure!(of_rod, "rod, {fluid}");
    figure!(of_both, "rod and fluid, {fluid}");
    assert!(of_rod.abs() < 1e-3 && of_both.abs() < 1e-3, "{of_rod} {of_both}");
}

/// Of a rod that muscles bend, alone, and behind a disc that it pushes.
#[test]
fn momentum_is_balanced_with_rods() {
    let fluid = "model = \"navier-stokes\", density = 1.0, viscosity = 0.05";
    let active = r#"
        density = 2.0
        rod = { bending = 0.5, elements = 12 }
        activation = { moment.sine = { amplitude = 0.2, period = 1.0, ramp = 0.3 }, wave_speed = 1.5 }
        "#;
    let head = r#"
        attached = { to = "head", hold = "clamped" }
        [[body]]
        name = "head"
        shape.disc.radius = 0.1
        center = [0.76, 0.05]
        density = 2.0
        motion = "free"
        "#;
    for more in ["", head] {
        let bodies = slender(&format!("{active}{more}"));
        let summary = run(&boxed(fluid, "step = 0.01, end = 0.6", &bodies));
        let defect = last(&summary, "flow.momentum_defect");
        figure!(defect, "momentum");
        assert!(defect.abs() < 1e-2, "{defect}");
    }
}

/// A heavy rod in a light fluid has more energy than the fluid: it comes from its muscles.
#[test]
fn a_run_in_which_muscles_give_a_rod_its_energy_has_not_blown_up() {
    let body = r#"
        density = 100.0
        rod = { bending = 20.0, elements = 12 }
        attached.hold.angle.sine = { amplitude = 0.1, period = 1.0, ramp = 0.3 }
        activation.moment.sine = { amplitude = 8.0, period = 1.0, ramp = 0.3 }
        "#;
    let fluid = "model = \"unsteady-stokes\", density = 1.0, viscosity = 0.01";
    let summary = run(&boxed(fluid, "step = 0.02, end = 0.5", &slender(body)));
    let [own, of_fluid] = ["rod", "flow"].map(|of| last(&summary, &format!("{of}.kinetic_energy")));
    assert!(own > 10.0 * of_fluid, "{own} {of_fluid}");
}

/// A clamped beam under a force along its length, at rest.
#[test]
fn a_beam_is_held_by_its_load_and_the_torque_of_it() {
    const FORCE: f64 = -0.1;
    const BENDING: f64 = 5.0;
    let body = format!(
        "rod = {{ bending = {BENDING}, elements = 12 }}\nattached.hold = \"clamped\"\n\
         force = [0.0, {FORCE}]"
    );
    let fluid = "model = \"stokes\", viscosity = 1.0";
    let model = boxed(fluid, "step = 0.25, end = 8.0", &slender(&body));
    let length = model.bodies[0].shape.profile().expect("it is slender").length();
    let summary = run(&model);
    let force = last(&summary, "rod.base_force.y") / -FORCE - 1.0;
    // The head is at the right of the centre, and the curvature the one in the middle of the first element
    let head = column(&summary, "rod.tip.x")[0] + length;
    let arm = column(&summary, "rod.x")[0] - head;
    let torque = last(&summary, "rod.base_torque") / (-FORCE * arm) - 1.0;
    let moment = BENDING * last(&summary, "rod.curvature") / last(&summary, "rod.base_torque");
    assert!(force.abs() < 1e-4 && torque.abs() < 2e-2, "{force} {torque}");
    assert!((0.88..0.96).contains(&moment.abs()), "{moment}");
}

/// What two rods do to a disc, by the equations of the rods, is what the fluid does to it the other way.
#[test]
fn several_rods_on_a_body_hold_it_by_their_bases() {
    let rod = |name: &str, y: f64, curvature: f64| {
        format!(
            r#"
            [[body]]
            name = "{name}"
            shape.fish = {{ length = 0.7, head_width = 0.05, head_end = 0.05, tail_width = 0.04, tip_radius = 0.02, corner_radius = 0.04 }}
            center = [-0.2, {y}]
            motion = "free"
            rod = {{ bending = 0.2, elements = 8 }}
            attached = {{ to = "head", hold = "clamped" }}
            activation = {{ curvature.sine = {{ amplitude = {curvature}, period = 1.0 }}, wave_speed = 1.0 }}
            "#
        )
    };
    let head = r#"
        [[body]]
        name = "head"
        shape.ellipse = { semi_axes = [0.15, 0.3] }
        center = [0.35, 0.0]
        motion = "free"
        "#;
    let bodies = format!("{}{}{head}", rod("one", 0.17, 2.0), rod("two", -0.17, -2.0));
    let fluid = "model = \"stokes\", viscosity = 1.0";
    let summary = run(&boxed(fluid, "step = 0.05, end = 0.4", &bodies));
    let at = |name: &str| last(&summary, name);
    let sum = |axis: &str| -> f64 {
        ["one", "two"].map(|of| at(&format!("{of}.base_force.{axis}"))).iter().sum()
    };
    let scale = at("one.base_force.x").hypot(at("one.base_force.y"));
    let off = (at("head.force.x") - sum("x")).hypot(at("head.force.y") - sum("y")) / scale;
    // They beat as mirror images, so that the head goes straight on
    let aside = at("head.velocity.y").abs() / at("head.velocity.x").abs();
    figure!(off, "force on the head");
    assert!(off < 1e-6 && aside < 0.05, "{off} {aside}");
}

/// Where the tip of a cantilever of length and stiffness one is under a force across it and a moment there: by Runge-Kutta
/// steps along it from the clamp, at which that curvature is sought with which the tip has the moment's.
fn elastica(force: f64, moment: f64) -> [f64; 2] {
    const STEPS: u32 = 400;
    let rate = |[_, _, angle, bend]: [f64; 4]| {
        let (sin, cos) = f64::sin_cos(angle);
        [cos, sin, bend, -force * cos]
    };
    let h = 1.0 / f64::from(STEPS);
    let away = |from: [f64; 4], by: [f64; 4], part: f64| -> [f64; 4] {
        std::array::from_fn(|i| from[i] + by[i] * part)
    };
    let tip = |bend: f64| {
        (0..STEPS).fold([0.0, 0.0, 0.0, bend], |at, _| {
            let first = rate(at);
            let second = rate(away(at, first, 0.5 * h));
            let third = rate(away(at, second, 0.5 * h));
            let last = rate(away(at, third, h));
            std::array::from_fn(|i| {
                at[i] + h / 6.0 * (first[i] + 2.0 * (second[i] + third[i]) + last[i])
            })
        })
    };
    let [mut low, mut high] = [-10.0, 10.0];
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if tip(middle)[3] > moment { high = middle } else { low = middle }
    }
    let [x, y, ..] = tip(low);
    [x, y]
}

/// What is given at the tip of a cantilever in a fluid at rest, in any direction and as a moment.
#[test]
fn loads_at_a_tip_bend_a_cantilever_as_far_as_the_elastica() {
    let fluid = "model = \"stokes\", viscosity = 0.2";
    for (force, moment) in [(0.8, 0.0), (0.0, 0.6), (-0.5, 0.7)] {
        let body = format!(
            "rod = {{ bending = 1.0, elements = 12, load.tip = {{ force = [{{ constant = 0.0 }}, \
             {{ constant = {force} }}], moment.constant = {moment} }} }}\nattached.hold = \"clamped\""
        );
        let model = boxed(fluid, "step = 0.7, end = 14.0", &slender(&body));
        let length = model.bodies[0].shape.profile().expect("it is slender").length();
        let summary = run(&model);
        let ends = |axis: &str| {
            let all = column(&summary, &format!("rod.tip.{axis}"));
            [all[0], all[all.len() - 1]]
        };
        let ([x, to_x], [y, to_y]) = (ends("x"), ends("y"));
        // From the head at the right it goes on to the left, as if it were turned by half a turn
        let of_theory = elastica(-force * length * length, moment * length);
        let found = [(x + length - to_x) / length, (y - to_y) / length];
        let off = (found[0] - of_theory[0]).hypot(found[1] - of_theory[1]);
        figure!(off, "force {force}, moment {moment}");
        assert!(off < 1e-3, "{found:?} {of_theory:?}");
        let held = last(&summary, "rod.base_force.y") + last(&summary, "rod.force.y") + force;
        assert!(held.abs() < 1e-8, "{held:e}");
        assert!(last(&summary, "rod.end_power").abs() < 1e-4);
    }
}

/// A free one that is turned, while it is straight still: the fluid carries what acts on its tail along its own axes.
#[test]
fn a_load_in_the_frame_of_its_end_is_turned_as_the_body() {
    const ANGLE: f64 = 0.7;
    let body = format!(
        "angle = {ANGLE}\nrod = {{ bending = 1.0, elements = 6, load.tip = {{ frame = \"end\", \
         force = [{{ constant = 0.6 }}, {{ constant = -0.2 }}] }} }}"
    );
    let fluid = "model = \"stokes\", viscosity = 0.2";
    let summary = run(&boxed(fluid, "step = 0.01, end = 0.01", &slender(&body)));
    let (sin, cos) = ANGLE.sin_cos();
    for (axis, exact) in [("x", 0.6 * cos + 0.2 * sin), ("y", 0.6 * sin - 0.2 * cos)] {
        let held = column(&summary, &format!("rod.force.{axis}"))[0];
        // What is first written is after a short piece of the first step, in which it turns a little
        assert!((held + exact).abs() < 1e-3, "{held} {exact}");
    }
}
