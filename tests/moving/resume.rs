//! Runs that go on from the state another one left.

use alewife_core::case::{Model, TimeSettings};
use alewife_core::simulation::RunSummary;
use tests::cases::{PERIODIC_CHANNEL, case, last, run};
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
        {PERIODIC_CHANNEL}
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
            for (one, other) in ends.0.iter().zip(&ends.1) {
                assert!((one - other).abs() < 1e-6 * one.abs().max(1.0), "{after}: {ends:?}");
            }
            // Statistics are over the steps before, too
            assert_eq!(rest.series.times.len(), whole.series.times.len());
            let bits = |run: &RunSummary| -> Vec<u64> {
                run.series.rows[..=after].iter().flatten().map(|value| value.to_bits()).collect()
            };
            assert_eq!(bits(&rest), bits(&whole));
            let defect = |run: &RunSummary| last(run, "flow.energy_defect");
            assert!((defect(&rest) - defect(&whole)).abs() < 1e-6, "{}", defect(&rest));
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
        for (after, spared) in [(0, 0), (0, 1), (0, 4), (0, 9), (1, 1), (4, 1), (4, 2)] {
            let stopped = stopped_within_a_step(&case, after, spared);
            let rest = resumed(&case, stopped.state.as_ref().expect("it left a state"))
                .expect("it goes on");
            assert!(rest.series.times.starts_with(&stopped.times));
            assert_eq!(rest.series.times.len(), whole.len(), "{scheme}");
            if !scheme.contains("adaptive") {
                assert_eq!(rest.series.times, whole);
            }
        }
    }
}

#[test]
fn a_state_of_another_problem_is_refused_by_its_key() {
    let saved = stopped(&two_bodies(""), 2);
    let refused =
        |changed: &str| resumed(&case(changed), &saved).expect_err("another problem").to_string();
    let text = two_bodies("").case.to_toml().expect("it is written");
    for (key, from, to) in [
        ("body.1.name", "name = \"disc\"", "name = \"ball\""),
        ("body.1.shape.disc.radius", "radius = 0.2", "radius = 0.21"),
        ("body.0.shape.ellipse.semi_axes", "[\n    0.3,", "[\n    0.31,"),
        ("domain.box.max", "max = [\n    1.0,", "max = [\n    1.1,"),
        ("fluid.viscosity", "viscosity = 0.1", "viscosity = 0.11"),
        ("boundary.top", "top = \"no-slip\"", "top = \"symmetry\""),
    ] {
        assert!(text.contains(from), "{from} is not in\n{text}");
        let told = refused(&text.replacen(from, to, 1));
        assert!(told.contains(&format!("by a case with {key} = ")), "{told}");
    }
}
