//! The error of the displacement of a cycle that a run reports of its steps, beside the true one.

use alewife_core::case::{Case, Model};
use alewife_core::run::RunSummary;
use tests::cases::{case, last, run};
use tests::{resumed, stopped};

/// Estimates are within this factor of the true error.
const FACTOR: f64 = 4.0;

/// Three discs in a box, which move and turn in every way there is, on one mesh.
fn three_discs(scheme: &str, steps: u32) -> Model {
    let step = 1.0 / f64::from(steps);
    case(&format!(
        r#"
        title = "three discs"
        geometry = "planar"
        fluid = {{ model = "stokes", viscosity = 1.0 }}
        domain.box = {{ min = [-2.0, -1.2], max = [2.0, 1.2] }}
        boundary = {{ left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }}
        mesh = {{ size = 0.8, surface = 0.2, growth = 0.4, gap_layers = 1, moving.layers = 1, moving.quality = 0.05 }}
        time.unsteady = {{ step = {step:e}, end = 1.0, scheme = "{scheme}" }}
        [[swimmer]]
        name = "swimmer"
        center = [0.2, -0.3]
        angle = 0.4
        [swimmer.kind.linked-spheres]
        radii = [0.3, 0.2, 0.25]
        arms = [
            {{ sine = {{ mean = 0.9, amplitude = 0.2, period = 1.0, phase = 0.0477465 }} }},
            {{ sine = {{ mean = 0.8, amplitude = 0.15, period = 1.0, phase = 0.270563 }} }},
        ]
        "#
    ))
}

/// Three links that turn by their strokes.
fn three_links(scheme: &str, steps: u32, joint: &str) -> Model {
    let step = 1.0 / f64::from(steps);
    case(&format!(
        r#"
        title = "three links"
        geometry = "planar"
        fluid = {{ model = "stokes", viscosity = 1.0 }}
        domain.disc.radius = 4.0
        boundary.wall = "no-slip"
        mesh = {{ size = 1.5, surface = 0.15, growth = 0.6, gap_layers = 1, moving.layers = 1 }}
        time.unsteady = {{ step = {step:e}, end = 1.0, scheme = "{scheme}" }}
        [[swimmer]]
        name = "swimmer"
        [swimmer.kind.chain]
        links = [[0.4, 0.1], [0.4, 0.1], [0.4, 0.1]]
        gap = 0.2
        joints = [
            {{ bent.angle.sine = {{ amplitude = 0.7, period = 1.0, phase = 0.25 }} }},
            {{ {joint} }},
        ]
        "#
    ))
}

/// The shipped swimmer in a tube, whose rates jump between its legs.
fn three_spheres(scheme: &str, steps: u32) -> Model {
    let step = format!("time.unsteady.step={}", 4.0 / f64::from(steps));
    let scheme = format!("time.unsteady.scheme={scheme}");
    let coarse = "mesh.scale=2.0".to_owned();
    Case::read("three-sphere", &[step, scheme, coarse]).expect("it is shipped").model
}

fn place(outcome: &RunSummary) -> [f64; 2] {
    ["x", "y"].map(|axis| {
        let cycle = outcome.series.column(&format!("swimmer.cycle.{axis}"));
        cycle.and_then(|values| values.last().copied()).unwrap_or(0.0)
    })
}

/// Estimated over true errors of runs, those of a fine one left out.
fn ratios(name: &str, fine: &Model, coarse: &[Model]) -> Vec<f64> {
    let exact = run(fine);
    println!("{name}: {:?}", exact.cycles);
    let ratio = |model: &Model| {
        let outcome = run(model);
        let (one, other) = (place(&outcome), place(&exact));
        let off = (one[0] - other[0]).hypot(one[1] - other[1]);
        let estimate = outcome.cycles[0].error.expect("there are steps enough");
        let remeshes = last(&outcome, "flow.remeshes");
        println!("  off {off:e}, estimated {estimate:e}, {:.2}, {remeshes} meshes", estimate / off);
        estimate / off
    };
    coarse.iter().map(ratio).collect()
}

fn are_near(ratios: &[f64]) -> bool {
    ratios.iter().all(|ratio| (1.0 / FACTOR..FACTOR).contains(ratio))
}

const BENT: &str = "bent.angle.sine = { amplitude = 0.7, period = 1.0 }";

#[test]
fn the_error_of_a_cycle_of_swimmers_that_turn_is_estimated() {
    let links = |scheme: &'static str| move |n: u32| three_links(scheme, n, BENT);
    let fine = links("rk3")(40);
    let explicit = ratios("links, rk3", &fine, &[5, 10, 20].map(links("rk3")));
    let implicit = ratios("links, bdf2", &fine, &[5, 10, 20].map(links("bdf2")));
    assert!(are_near(&explicit) && are_near(&implicit), "{explicit:?} {implicit:?}");
}

/// Beside walls the stages of an explicit step are not on the way, so that only implicit ones are
/// near; errors are not made small.
#[test]
fn the_error_of_a_cycle_between_walls_is_estimated() {
    let fine = three_discs("rk3", 40);
    let implicit = ratios("discs, bdf2", &fine, &[5, 10, 20].map(|n| three_discs("bdf2", n)));
    let explicit = ratios("discs, rk3", &fine, &[3, 5, 10, 20].map(|n| three_discs("rk3", n)));
    assert!(are_near(&implicit), "{implicit:?}");
    assert!(explicit.iter().all(|ratio| *ratio > 1.0 / FACTOR), "{explicit:?}");
}

/// From one step of a leg on, and where they restart at each jump.
#[test]
fn the_error_of_a_cycle_of_legs_is_estimated() {
    let spheres = |scheme: &'static str| move |n: u32| three_spheres(scheme, n);
    let fine = spheres("rk3")(40);
    let explicit = ratios("spheres, rk3", &fine, &[4, 8, 16].map(spheres("rk3")));
    let implicit = ratios("spheres, bdf2", &fine, &[16, 40].map(spheres("bdf2")));
    assert!(are_near(&explicit) && are_near(&implicit), "{explicit:?} {implicit:?}");
}

/// What springs undo is not looked at.
#[test]
fn the_error_of_a_cycle_with_a_spring_is_of_the_right_order() {
    let spring = |n: u32| three_links("bdf2", n, "hinge = { stiffness = 1.0 }");
    let found = ratios("spring", &spring(80), &[10, 20].map(spring));
    assert!(are_near(&found), "{found:?}");
}

/// The estimate is a part of the state.
#[test]
fn a_run_that_resumes_within_its_first_cycle_reports_the_same_error() {
    for scheme in ["rk3", "bdf2"] {
        let model = three_links(scheme, 8, BENT);
        let whole = run(&model);
        let rest = resumed(&model, &stopped::<2>(&model, 5)).expect("it resumes");
        assert_eq!(rest.cycles, whole.cycles, "{scheme}");
        assert!(whole.cycles[0].error.is_some_and(|error| error > 0.0));
    }
}
