//! Adaptive steps past velocities, slip and loads that jump in time, and out of rest; fixed steps past rates that jump.

use std::f64::consts::PI;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use alewife_core::case::Model;
use alewife_core::run::{Dimension, Observer, RunSummary, Snapshot, Solve, build_mesh, simulate};
use tests::cases::{PERIODIC_CHANNEL, case, column, run};
use tests::{resumed, stopped, stopped_within_a_step};

/// Times at which the plate changes its velocity, and by how much.
const CHANGES: [[f64; 2]; 3] = [[0.3, 1.0], [0.6, -2.0], [0.8, 1.0]];

/// Viscosity of the fluid between the plates, which are at a distance of 1.
const VISCOSITY: f64 = 0.1;

/// Fluid of density 1 between a plate at rest and one that starts, turns back and stops.
fn plates(tolerance: f64) -> Model {
    case(&format!(
        r#"
        title = "plates"
        geometry = "planar"
        fluid = {{ model = "navier-stokes", viscosity = {VISCOSITY}, density = 1.0 }}
        domain.box = {{ min = [0.0, 0.0], max = [0.1, 1.0] }}
        {}
        mesh = {{ size = 0.025 }}
        time.unsteady = {{ end = 1.0, adaptive.tolerance = {tolerance} }}
        probe = [{{ name = "middle", point = [0.05, 0.5] }}, {{ name = "near", point = [0.05, 0.8] }}]
        "#,
        PERIODIC_CHANNEL.replace(
            "top = \"no-slip\"",
            "top.velocity.value = [\"if(t < 0.3, 0, if(t < 0.6, 1, if(t < 0.8, -1, 0)))\", 0]"
        )
    ))
}

/// The exact velocity at a height and a time: for each change y + sum 2 (-1)^n / (n pi) exp(-n^2 pi^2 nu t) sin(n pi y).
fn exact(height: f64, time: f64) -> f64 {
    let after = |[at, change]: [f64; 2]| {
        let since = time - at;
        if since <= 0.0 {
            return 0.0;
        }
        let term = |n: i32| {
            let wave = PI * f64::from(n);
            let sign = if n % 2 == 0 { 1.0 } else { -1.0 };
            2.0 * sign / wave * (-wave * wave * VISCOSITY * since).exp() * (wave * height).sin()
        };
        change * (height + (1..400).map(term).sum::<f64>())
    };
    CHANGES.into_iter().map(after).sum()
}

#[test]
fn a_plate_that_starts_turns_back_and_stops_moves_the_fluid_as_it_should() {
    let worst = |tolerance: f64| {
        let outcome = run(&plates(tolerance));
        let of = |name: &str, height: f64| {
            let found = column(&outcome, name);
            // A layer thinner than four cells is not to be seen yet
            let is_seen =
                |time: f64| CHANGES.iter().all(|[at, _]| !(0.0..0.02).contains(&(time - at)));
            let rows = outcome.series.times.iter().zip(found).filter(|(time, _)| is_seen(**time));
            rows.map(|(time, found)| (found - exact(height, *time)).abs()).fold(0.0, f64::max)
        };
        of("middle.velocity.x", 0.5).max(of("near.velocity.x", 0.8))
    };
    let [coarse, fine] = [1e-3, 1e-4].map(worst);
    assert!(coarse < 4e-3 && fine < coarse / 2.0, "{coarse:.1e}, {fine:.1e}");
}

/// A disc in the plane that slips, a sphere on the axis that is pushed, both to and fro; `rk3` or `bdf2`.
fn to_and_fro(geometry: &str, scheme: &str, body: &str) -> RunSummary {
    let domain = if geometry == "planar" { "disc" } else { "half-disc" };
    run(&case(&format!(
        r#"
        title = "to and fro"
        geometry = "{geometry}"
        fluid = {{ model = "stokes", viscosity = 1.0 }}
        domain.{domain}.radius = 8.0
        boundary.wall = "no-slip"
        mesh = {{ size = 3.0, surface = 0.4, growth = 0.5 }}
        time.unsteady = {{ end = 6.0, scheme = "{scheme}", adaptive = {{}} }}
        [[body]]
        name = "s"
        center = [0.0, 0.0]
        motion = "free"
        {body}
        "#
    )))
}

/// Without inertia the velocity is one or the other, and the way is the sum of both times their times.
#[test]
fn what_is_driven_to_and_fro_goes_as_far_as_its_velocity_says() {
    let slip = "shape.disc.radius = 1.0\ngait.slip.velocity = [\"-0.2*if(t < 1.7, 1, if(t < 3.1, -1, if(t < 5.3, 1, -1)))\", 0]";
    let force = "shape.sphere.radius = 1.0\nforce = [2.0, 0.0]\nload_factor.table = [[0, 1], [1.7, 1], [1.7000000001, -1], [3.1, -1], [3.1000000001, 1], [5.3, 1], [5.3000000001, -1], [6, -1]]";
    for (geometry, body) in [("planar", slip), ("axisymmetric", force)] {
        for scheme in ["bdf2", "rk3"] {
            let outcome = to_and_fro(geometry, scheme, body);
            let speeds = column(&outcome, "s.velocity.x");
            let (speed, ways) = (speeds[0], column(&outcome, "s.x"));
            assert!(speed.abs() > 0.05, "{speed}");
            for ((time, way), now) in outcome.series.times.iter().zip(&ways).zip(&speeds) {
                let off = way - speed * way_to(*time);
                assert!(off.abs() < 2e-3 * speed.abs(), "{geometry}, {scheme}, {time}: {off:e}");
                // In rows at a jump, it is one or the other
                let is_full = (now.abs() - speed.abs()).abs() < 5e-3 * speed.abs();
                assert!(is_full, "{geometry}, {scheme}, {time}: {now}, {speed}");
            }
            assert!(outcome.steps < 400, "{geometry}, {scheme}: {} steps", outcome.steps);
        }
    }
}

/// Time to the one side less that to the other.
fn way_to(time: f64) -> f64 {
    let (mut way, mut from, mut sign) = (0.0, 0.0, 1.0);
    for at in [1.7, 3.1, 5.3, f64::INFINITY] {
        way += sign * (time.min(at) - from).max(0.0);
        (from, sign) = (at, -sign);
    }
    way
}

/// Wherever it is stopped on the way to a jump, across it and behind it.
#[test]
fn a_run_past_a_jump_ends_with_the_same_bits() {
    let model = case(
        r#"
        title = "a jump"
        geometry = "planar"
        fluid = { model = "navier-stokes", viscosity = 1.0, density = 1.0 }
        domain.disc.radius = 4.0
        boundary.wall = "no-slip"
        mesh = { size = 2.0, surface = 0.5, growth = 0.5 }
        time.unsteady = { end = 0.2 }
        [[body]]
        name = "s"
        shape.disc.radius = 1.0
        center = [0.0, 0.0]
        density = 1.0
        motion = "free"
        gait.slip.velocity = ["if(t < 0.15, -2, 2)", 0]
        "#,
    );
    let whole = run(&model);
    let bits = |outcome: &RunSummary| -> Vec<u64> {
        outcome.series.rows.iter().flatten().map(|value| value.to_bits()).collect()
    };
    let times = &whole.series.times;
    let jump = times.iter().position(|time| *time >= 0.15).expect("it gets there");
    assert!(times[jump] - times[jump - 1] < 1e-9, "the step across it is short");
    for after in jump - 1..jump + 2 {
        let rest = resumed(&model, &stopped::<2>(&model, after)).expect("it continues");
        assert!(bits(&rest) == bits(&whole), "stopped after {after}");
        let within = stopped_within_a_step::<2>(&model, after, 2).state.expect("a state");
        let rest = resumed(&model, &within).expect("it continues");
        assert!(bits(&rest) == bits(&whole), "stopped within the step after {after}");
    }
}

/// What jumps at every time has no steps that are short enough.
#[test]
fn what_jumps_at_every_time_is_said_to() {
    let model = case(
        r#"
        title = "noise"
        geometry = "planar"
        fluid = { model = "stokes", viscosity = 1.0 }
        domain.disc.radius = 4.0
        boundary.wall = "no-slip"
        mesh = { size = 2.0, surface = 0.5, growth = 0.5 }
        time.unsteady = { end = 1.0 }
        [[body]]
        name = "s"
        shape.disc.radius = 1.0
        center = [0.0, 0.0]
        motion = "free"
        gait.slip.velocity = ["-1 - 0.5*sin(1e12*t)", 0]
        "#,
    );
    let error = simulate::<2>(&model, &mut []).expect_err("it has no steps").to_string();
    assert!(error.contains("does not fall with the step"), "{error}");
    assert!(!error.contains("[contact]"), "{error}");
}

/// A disc that is at rest at the start, in a wide cylinder, for a time of 50.
fn disc_at_rest(driven: &str) -> RunSummary {
    run(&case(&format!(
        r#"
        title = "a pulse"
        geometry = "planar"
        fluid = {{ model = "stokes", viscosity = 1.0 }}
        domain.disc.radius = 8.0
        boundary.wall = "no-slip"
        mesh = {{ size = 3.0, surface = 0.4, growth = 0.5 }}
        time.unsteady = {{ end = 50.0 }}
        [[body]]
        name = "s"
        shape.disc.radius = 1.0
        center = [0.0, 0.0]
        motion = "free"
        {driven}
        "#
    )))
}

/// What is pushed or slips for a short time in the middle of a run, or begins ever so slowly, goes as far as the integral
/// of its speed, in few steps.
#[test]
fn a_pulse_out_of_rest_is_found_and_costs_few_steps() {
    let slip = |speed: &str| format!("gait.slip.velocity = [\"{speed}\", 0]");
    let force = |table: &str| format!("force = [0.1, 0.0]\nload_factor.table = {table}");
    let table = "[[0, 0], [20, 0], [20.1, 1], [20.2, 0]]";
    let bell = 0.1 * PI.sqrt();
    for (steady, driven, way) in [
        (slip("-0.1*exp(-t)"), slip("-0.1*exp(-((t - 7.3)/0.1)^2)"), bell),
        (slip("-0.1*exp(-t)"), slip("-0.005*(1 + tanh((t - 25)/0.2))"), 2.5),
        (force("[[0, 1], [1, 0]]"), force(table), 0.1),
    ] {
        let speed = column(&disc_at_rest(&steady), "s.velocity.x")[0];
        let outcome = disc_at_rest(&driven);
        let found = column(&outcome, "s.x").last().copied().unwrap_or_default() / speed;
        assert!((found / way - 1.0).abs() < 1e-2, "{driven}: {found} for {way}");
        assert!(outcome.steps < 300, "{driven}: {} steps", outcome.steps);
    }
}

/// Counts linear systems.
struct Systems(Arc<AtomicUsize>);

impl Observer<2> for Systems {
    fn on_step(&mut self, snapshot: &Snapshot<'_, 2>) -> std::io::Result<()> {
        self.0.fetch_add(snapshot.iterations, Ordering::Relaxed);
        Ok(())
    }
}

/// A disc that turns back at the end of a step and within another one: as many linear systems as one step and the number of all
/// say, short ones at the start and behind each turn included. Where it turns its velocity is that behind the turn, and the piece
/// that ends there has a system more.
#[test]
fn steps_are_as_many_as_their_number_ahead_says() {
    const TURNS: usize = 2;
    let model = case(
        r#"
        title = "a disc that goes to and fro"
        geometry = "planar"
        fluid = { model = "stokes", viscosity = 1.0 }
        domain.box = { min = [-1.0, -1.0], max = [1.0, 1.0] }
        boundary = { left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }
        mesh = { size = 0.5, surface = 0.2, growth = 0.6, gap_layers = 1 }
        time.unsteady = { step = 0.1, end = 1.0 }
        [[body]]
        name = "disc"
        shape.disc.radius = 0.3
        center = [0.0, 0.0]
        motion.x.imposed.legs = { period = 0.75, knots = [[0.0, 0.0], [0.3, 0.05]] }
        "#,
    );
    let mesh = build_mesh::<2>(&model).expect("it is meshed");
    let timed = Dimension::<2>::time_step(&model, mesh).expect("a step is made");
    let of_step = timed.step.expect("it moves").expect("it is made").systems;
    let pieces = timed.pieces.expect("its steps are fixed");
    assert_eq!([of_step, pieces], [1, 33]);
    let made = Arc::new(AtomicUsize::new(0));
    let mut observers: Vec<Box<dyn Observer<2>>> = vec![Box::new(Systems(Arc::clone(&made)))];
    simulate(&model, &mut observers).expect("the case runs");
    assert_eq!(made.load(Ordering::Relaxed), pieces * of_step + TURNS);
}
