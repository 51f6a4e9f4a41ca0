//! Bodies that deform, with inertia: balances, remeshing in the middle of a beat, states that
//! are continued.

use alewife_core::coupling::BodyShapes;
use alewife_core::run::{RunError, RunSummary, build_mesh, build_problem, simulate};
use alewife_core::step::FlowError;
use tests::cases::{case, column, last, run};
use tests::{figure, resumed, stopped};

/// A stout fish in a closed box; `gait` may be empty.
fn fish(gait: &str, time: &str, mesh: &str) -> String {
    format!(
        r#"
        title = "a fish in a box"
        geometry = "planar"
        fluid = {{ model = "navier-stokes", density = 1.0, viscosity = 5e-3 }}
        domain.box = {{ min = [-1.2, -0.8], max = [1.2, 0.8] }}
        boundary = {{ left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }}
        mesh = {{ growth = 0.3, gap_layers = 1, moving.layers = 1, {mesh} }}
        time.unsteady = {{ {time} }}
        [[body]]
        name = "fish"
        shape.fish = {{ length = 1.0, head_width = 0.08, head_end = 0.08, tail_width = 0.04, tip_radius = 0.01, corner_radius = 0.05 }}
        center = [0.0, 0.05]
        angle = 0.2
        density = 1.2
        motion = "free"
        {gait}
        "#
    )
}

const BEAT: &str = "gait.carangiform = { period = 1.0, ramp = 0.5 }";
const COARSE: &str = "size = 0.4, surface = 0.08";

/// In the frame of the body Newton's and Euler's equations are those of BDF2, in which the inertia
/// follows the shape; and the body keeps its area.
#[test]
fn force_and_torque_are_the_rates_of_momentum_and_angular_momentum() {
    let step = 0.02;
    let case = case(&fish(BEAT, &format!("step = {step}, end = 0.4"), COARSE));
    let mesh = build_mesh::<2>(&case).expect("it is meshed");
    let problem = build_problem(&case, &mesh).expect("it is a problem");
    let body = &problem.bodies[0];
    let outcome = run(&case);
    let times = &outcome.series.times;
    let (mut worst, mut size) = (0.0f64, 0.0f64);
    for axis in ["x", "y"] {
        let force = column(&outcome, &format!("fish.force.{axis}"));
        let velocity = column(&outcome, &format!("fish.velocity.{axis}"));
        for n in 3..times.len() {
            let rate = (3.0 * velocity[n] - 4.0 * velocity[n - 1] + velocity[n - 2]) / (2.0 * step);
            worst = worst.max((body.inertia.mass * rate - force[n]).abs());
            size = size.max(force[n].abs());
        }
    }
    let torque = column(&outcome, "fish.torque");
    let turn = column(&outcome, "fish.angular_velocity");
    let inertia = times.iter().map(|time| {
        let shapes = BodyShapes::at(&problem.bodies, *time).expect("the gait has a shape");
        body.inertia_with(shapes.deformed(0)).about_z()
    });
    let inertia: Vec<f64> = inertia.collect();
    let momentum: Vec<f64> =
        inertia.iter().zip(turn).map(|(inertia, turn)| inertia * turn).collect();
    let (mut off, mut most) = (0.0f64, 0.0f64);
    for n in 3..times.len() {
        let rate = (3.0 * momentum[n] - 4.0 * momentum[n - 1] + momentum[n - 2]) / (2.0 * step);
        off = off.max((rate - torque[n]).abs());
        most = most.max(torque[n].abs());
    }
    let inertia = inertia.into_iter();
    let [least, largest] = inertia.fold([f64::INFINITY, 0.0], |[a, b], i| [a.min(i), b.max(i)]);
    let defect = column(&outcome, "flow.mass_defect").iter().fold(0.0f64, |m, d| m.max(d.abs()));
    figure!(worst / size, "force");
    figure!(off / most, "torque");
    figure!(defect, "mass defect");
    assert!(worst < 1e-9 * size && off < 1e-9 * most, "{worst:e} {off:e}");
    assert!(largest > 1.005 * least, "the inertia changes by {}", largest / least - 1.0);
    assert!(defect < 1e-5, "{defect:e}");
}

/// A gait without amplitude is no gait.
#[test]
fn a_fish_that_does_not_bend_is_rigid() {
    let time = "step = 0.02, end = 0.2";
    let pulled = "force = [0.05, -0.03]\ntorque = 0.01\n";
    let names = ["x", "y", "angle", "velocity.x", "force.x", "torque", "power"];
    let end = |gait: &str| {
        let outcome = run(&case(&fish(&format!("{pulled}{gait}"), time, COARSE)));
        names.map(|name| last(&outcome, &format!("fish.{name}")))
    };
    let rigid = end("");
    let still = end("gait.carangiform = { period = 1.0, curvature = [[0.0, 0.0], [1.0, 0.0]] }");
    println!("{rigid:?}\n{still:?}");
    for (one, other) in rigid.iter().zip(still) {
        assert!((one - other).abs() < 1e-9 * rigid[0].abs().max(one.abs()), "{rigid:?} {still:?}");
    }
}

/// Once on the mesh it starts with as far as that goes, once with many meshes on the way. What a
/// transfer loses acts as a blow in the one step after it, and so would a frame that is not where it
/// was.
#[test]
fn a_new_mesh_in_the_middle_of_a_beat_changes_little() {
    for frame in ["", "frame = \"fish\""] {
        let at = |quality: f64| {
            let mesh = format!("size = 0.12, surface = 0.025, moving.quality = {quality}");
            run(&case(&format!("{frame}{}", fish(BEAT, "step = 0.025, end = 0.7", &mesh))))
        };
        let (few, many) = (at(0.3), at(0.75));
        let meshes = [&few, &many].map(|outcome| column(outcome, "flow.remeshes"));
        let is_fresh =
            |step: usize| meshes.iter().any(|meshes| step > 0 && meshes[step] > meshes[step - 1]);
        let n = meshes[0].len();
        assert!(meshes[1][n - 1] >= meshes[0][n - 1] + 3.0, "{meshes:?}");
        for name in ["velocity.x", "velocity.y", "force.x", "force.y", "torque"] {
            let [one, other] =
                [&few, &many].map(|outcome| column(outcome, &format!("fish.{name}")));
            let size = one.iter().fold(0.0f64, |most, value| most.max(value.abs()));
            let largest = |fresh: bool| {
                let steps = (0..n).filter(|step| is_fresh(*step) == fresh);
                steps.map(|step| (one[step] - other[step]).abs() / size).fold(0.0, f64::max)
            };
            let (after, otherwise) = (largest(true), largest(false));
            figure!(after, "{frame}, {name} after a new mesh");
            figure!(otherwise, "{frame}, {name} otherwise");
            let allowed = if name == "torque" { 0.015 } else { 0.005 };
            assert!(after < allowed && otherwise < allowed, "{name}: {after:e} {otherwise:e}");
        }
    }
}

/// The work of a beat is dissipated or is in the fluid, better with shorter steps.
#[test]
fn the_energy_of_a_beat_is_accounted_for() {
    let at = |step: f64| {
        let time = format!("step = {step}, end = 1.0");
        let outcome = run(&case(&fish(BEAT, &time, "size = 0.2, surface = 0.06")));
        let defect = last(&outcome, "flow.energy_defect");
        figure!(defect, "step {step}: energy defect");
        defect
    };
    let (coarse, fine) = (at(0.04), at(0.02));
    assert!(fine.abs() < 5e-3, "{coarse} {fine}");
}

#[test]
fn a_swimmer_that_goes_on_from_a_state_ends_where_it_would_have_ended() {
    let case = case(&fish(BEAT, "step = 0.02, end = 0.6", COARSE));
    let whole = run(&case);
    assert!(last(&whole, "flow.remeshes") >= 1.0);
    let names = ["fish.x", "fish.y", "fish.angle", "fish.velocity.x", "fish.force.y"];
    let ends = |outcome: &RunSummary| names.map(|name| last(outcome, name));
    for after in [5, 24] {
        let saved = stopped::<2>(&case, after);
        let rest = resumed(&case, &saved).expect("it continues");
        for (one, other) in ends(&whole).iter().zip(ends(&rest)) {
            assert!((one - other).abs() < 1e-8, "{:?} {:?}", ends(&whole), ends(&rest));
        }
    }
}

#[test]
fn a_state_of_another_gait_is_refused() {
    let with = |beat: &str| case(&fish(beat, "step = 0.02, end = 0.6", COARSE));
    let saved = stopped::<2>(&with(BEAT), 24);
    let other = with(&BEAT.replace("period = 1.0", "period = 11.0"));
    let error = resumed(&other, &saved).expect_err("another gait");
    let message = error.to_string();
    assert!(message.contains("body.0.gait.") && message.contains(".period = 1.0"), "{message}");
}

/// Its outline crosses itself between the times at which the gait is evaluated before the run.
#[test]
fn a_gait_that_fails_in_a_run_stops_it_with_the_body_and_the_time() {
    let case = case(
        r#"
        title = "a fish that bends too far"
        geometry = "planar"
        fluid = { model = "navier-stokes", density = 1.0, viscosity = 5e-3 }
        domain.box = { min = [-1.5, -1.5], max = [1.5, 1.5] }
        boundary = { left = "no-slip", right = "do-nothing", bottom = "no-slip", top = "no-slip" }
        mesh = { growth = 0.3, size = 0.5, surface = 0.1 }
        time.unsteady = { step = 0.033, end = 0.066, scheme = "bdf1" }
        [[body]]
        name = "fish"
        shape.fish = { length = 1.0, tip_radius = 1e-3 }
        center = [0.0, 0.0]
        motion = "free"
        gait.carangiform = { period = 1.0, ramp = 0.01, bending = 1.683, phase = 0.7291666666666666 }
        "#,
    );
    let error = simulate::<2>(&case, &mut []).expect_err("the outline crosses itself");
    assert!(matches!(error, RunError::Flow(FlowError::Shape(_))), "{error:?}");
    let message = error.to_string();
    assert!(message.starts_with("body `fish`: at t = 0.033000 the body bends so far"), "{message}");
}
