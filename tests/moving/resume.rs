//! Runs that go on from the state another one left.

use alewife_core::case::{Model, TimeSettings};
use alewife_core::simulation::RunSummary;
use tests::cases::{case, last, run};
use tests::{resumed, stopped, stopped_within_a_step};

fn two_bodies(adaptive: &str) -> Model {
    case(&format!(
        r#"
        title = "an ellipse and a disc in a periodic channel"
        geometry = "planar"
        fluid = {{ model = "navier-stokes", density = 1.0, viscosity = 0.1, gravity = [6.0, -6.0] }}
        domain.box = {{ min = [-1.0, -1.0], max = [1.0, 1.0] }}
        mesh = {{ size = 0.25, surface = 0.1, gap_layers = 2.5 }}
        time.unsteady = {{ step = 0.02, end = 2.0{adaptive} }}
        contact.barrier = {{ range = 0.05, stiffness = 50.0 }}
        boundary = {{ left.periodic = "right", right.periodic = "left", bottom = "no-slip", top = "no-slip" }}
        [[body]]
        name = "ellipse"
        shape = {{ ellipse = {{ semi_axes = [0.3, 0.15] }} }}
        center = [-0.4, 0.2]
        angle = 0.5
        density = 2.0
        motion = "free"
        [[body]]
        name = "disc"
        shape = {{ disc = {{ radius = 0.2 }} }}
        center = [0.5, -0.3]
        density = 1.5
        motion = "free"
        "#
    ))
}

fn poses(outcome: &RunSummary) -> Vec<f64> {
    let names = ["ellipse.x", "ellipse.y", "ellipse.angle", "disc.x", "disc.y", "disc.force.y"];
    names.map(|name| last(outcome, name)).to_vec()
}

/// Factors of a matrix are not part of a state: rounding differs, and nothing else.
#[test]
fn a_run_that_goes_on_ends_where_it_would_have_ended() {
    for adaptive in ["", ", adaptive = { tolerance = 5e-3, largest = 0.04 }"] {
        let case = two_bodies(adaptive);
        let whole = run(&case);
        assert!(last(&whole, "flow.remeshes") >= 1.0);
        for after in [3, 60] {
            let saved = stopped(&case, after);
            let rest = resumed(&case, &saved).expect("it goes on");
            let ends = (poses(&whole), poses(&rest));
            if adaptive.is_empty() {
                for (one, other) in ends.0.iter().zip(&ends.1) {
                    assert!((one - other).abs() < 1e-6 * one.abs().max(1.0), "{after}: {ends:?}");
                }
            }
            let (first, end) = (rest.series.times[0], rest.series.times.last().copied());
            assert!(first > saved.time && end == Some(2.0), "{first} {end:?}");
        }
    }
}

/// Signals come at any time: every step is reported once, before the stop or after it.
#[test]
fn no_step_is_lost_where_a_run_is_stopped() {
    for scheme in ["", ", scheme = \"bdf1\"", ", adaptive = { tolerance = 5e-3, largest = 0.04 }"] {
        let mut case = two_bodies(scheme);
        if let TimeSettings::Unsteady(unsteady) = &mut case.case.time {
            unsteady.end = 0.2;
        }
        let whole = run(&case).series.times;
        for after in [1, 4] {
            let stopped = stopped_within_a_step(&case, after);
            let rest = resumed(&case, stopped.state.as_ref().expect("it left a state"))
                .expect("it goes on");
            let joined: Vec<f64> = stopped.times.into_iter().chain(rest.series.times).collect();
            assert_eq!(joined.len(), whole.len(), "{joined:?} {whole:?}");
            if !scheme.contains("adaptive") {
                assert_eq!(joined, whole);
            }
        }
    }
}

#[test]
fn a_state_of_other_bodies_is_refused() {
    let saved = stopped(&two_bodies(""), 2);
    let mut other = two_bodies("");
    other.bodies[1].name = "ball".to_owned();
    let error = resumed(&other, &saved).expect_err("other bodies");
    assert!(error.to_string().contains("its bodies are [\"ellipse\", \"disc\"]"), "{error}");
}
