//! Particles that the flow carries: exact paths, orders, walls, bodies that move, new meshes, saved states.

mod probes;

use alewife_core::case::Model;
use alewife_core::run::{RunSummary, SavedState, simulate};
use tests::cases::{case, column, last, run};
use tests::{figure, resumed, stopped};

/// A channel with a developed flow, of largest velocity 1 at y = 0.5.
fn channel(more: &str) -> String {
    format!(
        r#"
        title = "a channel"
        geometry = "planar"
        fluid = {{ model = "stokes", viscosity = 1.0 }}
        domain.channel = {{ length = 3.0, height = 1.0 }}
        boundary = {{ left.parabolic.peak = 1.0, right = "do-nothing", bottom = "no-slip", top = "no-slip" }}
        mesh = {{ size = 0.3 }}
        time.unsteady = {{ step = 0.1, end = 2.0 }}
        {more}
        "#
    )
}

#[test]
fn in_a_channel_particles_go_straight_on_and_leave() {
    let outcome = run(&case(&channel(
        r#"
        [[tracer]]
        name = "slow"
        points = [[0.25, 0.1]]
        region = { min = [0.5, 0.0], max = [2.0, 1.0] }
        [[tracer]]
        name = "all"
        line = { from = [0.5, 0.0], to = [0.5, 1.0], count = 11 }
        [[tracer]]
        name = "dye"
        points = [[0.5, 0.5]]
        start = 0.33
        every = 0.25
        "#,
    )));
    let at = |height: f64| 4.0 * height * (1.0 - height);
    let x = column(&outcome, "slow.x");
    for (time, x) in outcome.series.times.iter().zip(&x) {
        assert!((x - (0.25 + at(0.1) * time)).abs() < 1e-9, "{x} at {time}");
    }
    assert!((last(&outcome, "slow.y") - 0.1).abs() < 1e-9);
    // It enters the region in the midst of a step
    let spent = 2.0 - 0.25 / at(0.1);
    assert!((last(&outcome, "slow.residence") - spent).abs() < 0.05, "a step is 0.1");
    assert_eq!(last(&outcome, "slow.inside").to_bits(), 1f64.to_bits());
    // u t > 2.5 where y (1 - y) > 0.3125, which is nowhere, then the fastest
    assert_eq!(last(&outcome, "all.count").to_bits(), 11f64.to_bits());
    // One released at t has gone 2 - t
    let releases = column(&outcome, "dye.count");
    assert_eq!(releases[3].to_bits(), 0f64.to_bits());
    assert_eq!(releases[4].to_bits(), 1f64.to_bits());
    assert_eq!(releases[20].to_bits(), 7f64.to_bits());
    let first = column(&outcome, "dye.x")[5];
    assert!((first - (0.5 + 0.17)).abs() < 1e-9, "{first}");

    let longer = channel("tracer = [{ name = \"a\", points = [[2.0, 0.5], [2.0, 0.1]] }]");
    let outcome = run(&case(&longer));
    let left = column(&outcome, "a.left");
    assert_eq!(left[9].to_bits(), 0f64.to_bits());
    assert_eq!(left[12].to_bits(), 1f64.to_bits());
    assert_eq!(last(&outcome, "a.count").to_bits(), 1f64.to_bits());
}

/// Where a particle is after a whole turn, from where it began, with this step.
fn off_after_a_turn(n: usize) -> f64 {
    let end = std::f64::consts::TAU;
    let step = end / n as f64;
    let outcome = run(&case(&format!(
        r#"
        title = "solid rotation"
        geometry = "planar"
        fluid = {{ model = "stokes", viscosity = 1.0 }}
        domain.disc = {{ radius = 2.0 }}
        boundary = {{ wall.velocity.value = ["-y", "x"] }}
        mesh = {{ size = 1.5 }}
        time.unsteady = {{ step = {step}, end = {end} }}
        tracer = [{{ name = "a", points = [[0.2, 0.3]] }}]
        "#
    )));
    let [x, y] = ["a.x", "a.y"].map(|name| last(&outcome, name));
    (x - 0.2).hypot(y - 0.3)
}

#[test]
fn in_solid_rotation_paths_are_of_fourth_order() {
    let [coarse, fine] = [12, 24].map(off_after_a_turn);
    let order = (coarse / fine).log2();
    figure!(order, "order in solid rotation");
    assert!(order > 3.7, "{coarse} {fine}");
}

/// A flow that is the same everywhere and changes in time: the path's error at its end.
fn off_in_a_gust(step: f64) -> f64 {
    let gust = r#"velocity = { value = [1.0, 0.0], factor.sine = { period = 2.0, phase = 0.1 } }"#;
    let outcome = run(&case(&format!(
        r#"
        title = "a gust"
        geometry = "planar"
        fluid = {{ model = "stokes", viscosity = 1.0 }}
        domain.box = {{ min = [-2.0, -1.0], max = [2.0, 1.0] }}
        boundary = {{ left = {{ {gust} }}, right = "do-nothing", bottom = {{ {gust} }}, top = {{ {gust} }} }}
        mesh = {{ size = 1.0 }}
        time.unsteady = {{ step = {step}, end = 1.2 }}
        tracer = [{{ name = "a", points = [[-0.5, 0.1]] }}]
        "#
    )));
    let place =
        |time: f64| -(std::f64::consts::TAU * (time / 2.0 + 0.1)).cos() / std::f64::consts::PI;
    last(&outcome, "a.x") + 0.5 - (place(1.2) - place(0.0))
}

#[test]
fn in_a_flow_that_changes_paths_are_of_second_order() {
    let [coarse, fine] = [0.1, 0.05].map(off_in_a_gust);
    let order = (coarse / fine).log2();
    figure!(order, "order in a gust");
    assert!((1.7..2.6).contains(&order), "{coarse} {fine}");
}

/// A squirmer of speed 1 in a ball whose wall moves as the fluid would there without it.
fn squirmer(size: f64, step: f64) -> Model {
    case(&format!(
        r#"
        title = "a neutral squirmer"
        geometry = "axisymmetric"
        fluid = {{ model = "stokes", viscosity = 1.0 }}
        domain.half-disc = {{ radius = 5.0 }}
        mesh = {{ size = {}, surface = {size}, moving.quality = 0.85 }}
        time.unsteady = {{ step = {step}, end = 1.6 }}
        [boundary.wall.velocity]
        value = [
            "(3 * (x - t)^2 / ((x - t)^2 + y^2) - 1) / (2 * ((x - t)^2 + y^2)^1.5)",
            "3 * (x - t) * y / (2 * ((x - t)^2 + y^2)^2.5)",
        ]
        [[body]]
        name = "squirmer"
        shape.sphere.radius = 1.0
        center = [0.0, 0.0]
        motion = "free"
        gait.squirmer.modes = [1.5]
        [[tracer]]
        name = "a"
        points = [[1.2, 0.3]]
        [[tracer]]
        name = "b"
        points = [[1.5, 0.5]]
        "#,
        8.0 * size
    ))
}

/// Largest change of the stream function in the squirmer's frame along the paths, over its size.
fn defect(outcome: &RunSummary) -> f64 {
    let body = column(outcome, "squirmer.x");
    let drift = |name: &str| {
        let [x, y] = ["x", "y"].map(|axis| column(outcome, &format!("{name}.{axis}")));
        let psi = |n: usize| {
            let radius = (x[n] - body[n]).hypot(y[n]);
            0.5 * y[n] * y[n] * (1.0 - radius.powi(-3))
        };
        (0..x.len()).map(|n| (psi(n) / psi(0) - 1.0).abs()).fold(0.0, f64::max)
    };
    drift("a").max(drift("b"))
}

/// The mesh moves with the squirmer, and is replaced.
#[test]
fn around_a_squirmer_particles_follow_its_stream_lines() {
    let [coarse, fine] = [(0.2, 0.1), (0.1, 0.05)].map(|(size, step)| {
        let outcome = run(&squirmer(size, step));
        assert!(last(&outcome, "flow.remeshes") >= 1.0, "no new mesh");
        let speed = last(&outcome, "squirmer.velocity.x");
        assert!((speed - 1.0).abs() < 0.01, "{speed}");
        defect(&outcome)
    });
    figure!(fine, "change of the stream function");
    figure!((coarse / fine).log2(), "order of the stream function");
    assert!(fine < 0.02 && coarse / fine > 1.5, "{coarse} {fine}");
}

/// A disc is driven to and fro through a cloud.
fn stirred() -> Model {
    case(
        r#"
        title = "a disc stirs"
        geometry = "planar"
        fluid = { model = "navier-stokes", viscosity = 0.05, density = 1.0 }
        domain.box = { min = [-1.0, -1.0], max = [1.0, 1.0] }
        boundary = { left.periodic = "right", right.periodic = "left", bottom = "no-slip", top = "no-slip" }
        mesh = { size = 0.3, surface = 0.1, moving.quality = 0.8 }
        time.unsteady = { step = 0.05, end = 1.5 }
        [[body]]
        name = "disc"
        shape.disc.radius = 0.3
        center = [0.0, 0.0]
        motion.imposed = { velocity = [1.5, 0.0] }
        [[tracer]]
        name = "cloud"
        box = { min = [-1.0, -0.6], max = [1.0, 0.6], count = [24, 12] }
        every = 0.5
        "#,
    )
}

/// Where all particles are, and where the disc is, at the end.
struct Ending(std::sync::Arc<std::sync::Mutex<Vec<[f64; 4]>>>);

impl alewife_core::run::Observer<2> for Ending {
    fn on_step(&mut self, shown: &alewife_core::run::Snapshot<'_, 2>) -> std::io::Result<()> {
        let body = shown.bodies[0].pose.center;
        let all = shown.tracers[0].particles.iter();
        let places = all.map(|one| [one.position.x, one.position.y, body.x, body.y]);
        *self.0.lock().expect("nobody else holds it") = places.collect();
        Ok(())
    }
}

#[test]
fn a_body_pushes_particles_aside_and_none_is_lost() {
    let places = std::sync::Arc::default();
    let ending = Ending(std::sync::Arc::clone(&places));
    let outcome = simulate::<2>(&stirred(), &mut [Box::new(ending)]).expect("the case runs");
    assert_eq!(last(&outcome, "cloud.left").to_bits(), 0f64.to_bits());
    let places = places.lock().expect("nobody else holds it");
    assert_eq!(last(&outcome, "cloud.count") as usize, places.len());
    assert!(places.len() > 4 * 200, "{}", places.len());
    let radius = |[x, y, at_x, at_y]: &[f64; 4]| {
        let across = (x - at_x + 1.0).rem_euclid(2.0) - 1.0;
        across.hypot(y - at_y)
    };
    let nearest = places.iter().map(radius).fold(f64::INFINITY, f64::min);
    figure!(nearest, "distance of the nearest particle");
    assert!((0.2999..0.33).contains(&nearest), "{nearest}");
    assert!(places.iter().any(|[x, ..]| *x > 1.2), "some have been carried across a side");
}

#[test]
fn particles_of_a_run_that_resumes_and_of_other_threads_have_the_same_bits() {
    let model = stirred();
    let bits = |outcome: &RunSummary| -> Vec<Vec<u64>> {
        let rows = outcome.series.rows.iter();
        rows.map(|row| row.iter().map(|value| value.to_bits()).collect()).collect()
    };
    let on = |n: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("threads");
        pool.install(|| run(&model))
    };
    let whole = on(1);
    assert!(bits(&on(3)) == bits(&whole), "threads");
    let saved: SavedState<2> = stopped(&model, 13);
    let rest = resumed(&model, &saved).expect("it continues");
    assert!(bits(&rest) == bits(&whole), "resumed");
}

#[test]
fn without_tracers_the_flow_has_the_same_bits() {
    let with = run(&stirred());
    let mut model = stirred();
    model.case.tracer.clear();
    let without = run(&model);
    for name in ["disc.force.x", "flow.dissipation", "flow.cells"] {
        let [with, without] = [&with, &without].map(|outcome| column(outcome, name));
        assert!(with.iter().zip(&without).all(|(a, b)| a.to_bits() == b.to_bits()), "{name}");
    }
}

#[test]
fn in_space_a_particle_turns_with_the_fluid() {
    let outcome = alewife_core::run::simulate::<3>(
        &case(
            r#"
            title = "solid rotation in space"
            geometry = "spatial"
            fluid = { model = "stokes", viscosity = 1.0 }
            domain.sphere.radius = 1.0
            boundary.wall.velocity.value = ["-y", "x", "0"]
            mesh.size = 0.7
            time.unsteady = { step = 0.2, end = 1.0 }
            tracer = [{ name = "a", points = [[0.4, 0.0, 0.3]] }]
            "#,
        ),
        &mut [],
    )
    .expect("the case runs");
    let off = [0.4 * 1f64.cos(), 0.4 * 1f64.sin(), 0.3];
    let off = ["a.x", "a.y", "a.z"].iter().zip(off).map(|(name, at)| last(&outcome, name) - at);
    let off = off.map(f64::abs).fold(0.0, f64::max);
    assert!(off < 2e-4, "{off}");
}
