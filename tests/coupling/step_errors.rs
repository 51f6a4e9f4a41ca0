//! What steps in time are said to leave, against what they do leave.

use alewife_core::run::{RunSummary, StepErrorReport};
use tests::cases::{case, column, run};

/// A cylinder that is swung in a box at Reynolds number 60.
fn swung(step: f64, end: f64, more: &str) -> RunSummary {
    run(&case(&format!(
        r#"
        title = "a swung cylinder"
        geometry = "planar"
        fluid = {{ model = "navier-stokes", viscosity = 0.02, density = 1.0 }}
        domain.box = {{ min = [-3.0, -2.0], max = [3.0, 2.0] }}
        boundary = {{ left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }}
        mesh = {{ size = 1.0, surface = 0.25 }}
        time.unsteady = {{ step = {step}, end = {end}{more} }}
        [[body]]
        name = "c"
        shape.disc.radius = 0.5
        center = [0.0, 0.0]
        motion.imposed = {{ velocity = [1.0, 0.0], factor.sine.period = 4.0 }}
        "#
    )))
}

fn errors(outcome: &RunSummary) -> StepErrorReport {
    outcome.step_errors.expect("it has steps")
}

/// Root mean square of the difference of the forces of two runs at common times, over the force.
fn difference(coarse: &RunSummary, fine: &RunSummary) -> f64 {
    let [one, other] = [coarse, fine].map(|run| column(run, "c.force.x"));
    let every = (other.len() - 1) / (one.len() - 1);
    let pairs = (20..one.len()).map(|nth| (one[nth], other[nth * every]));
    let [error, size] = pairs.fold([0.0; 2], |[error, size], (one, other)| {
        [error + (one - other).powi(2), size + other * other]
    });
    (error / size).sqrt()
}

#[test]
fn what_steps_leave_is_of_the_size_that_is_told_and_of_second_order() {
    let fine = swung(0.025, 8.0, "");
    for convection in ["extrapolated", "newton"] {
        let more = format!(r#", convection = "{convection}""#);
        let [long, short] = [0.1, 0.05].map(|step| swung(step, 8.0, &more));
        let told = errors(&long).loads.unwrap();
        let found = difference(&long, &fine);
        assert!((1.0..12.0).contains(&(told / found)), "{convection}: {told} for {found}");
        let parts = |run: &RunSummary| {
            let StepErrorReport { velocity, ways, loads } = errors(run);
            [velocity, ways, loads].map(Option::unwrap)
        };
        for (long, short) in parts(&long).into_iter().zip(parts(&short)) {
            assert!((2.5..6.0).contains(&(long / short)), "{convection}: {long} {short}");
        }
    }
}

#[test]
fn a_step_longer_than_vortices_take_leaves_more_than_is_accepted() {
    let StepErrorReport { velocity, .. } = errors(&swung(0.5, 40.0, r#", convection = "newton""#));
    assert!(velocity.unwrap() > 0.02, "{velocity:?}");
}
