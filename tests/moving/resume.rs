//! Runs that continue from the state another one left.

use alewife_core::case::{Case, Model, TimeSettings};
use alewife_core::run::{Dimension, RunSummary, SavedState, Solve, simulate};
use tests::cases::{PERIODIC_CHANNEL, case, column, last, run};
use tests::{resumed, stopped, stopped_again, stopped_within_a_step};

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

/// All numbers of all rows, and their times, as bits.
fn bits(outcome: &RunSummary) -> Vec<Vec<u64>> {
    let rows = outcome.series.times.iter().zip(&outcome.series.rows);
    rows.map(|(time, row)| [time].into_iter().chain(row).map(|x| x.to_bits()).collect()).collect()
}

/// Runs a case to its end; stops it after some steps, and what resumes from there after some more.
fn ends_with_the_same_bits<const D: usize>(model: &Model, stops: &[[usize; 2]]) -> RunSummary
where
    Dimension<D>: Solve<D>,
{
    let whole = simulate::<D>(model, &mut []).expect("the case runs");
    let expected = bits(&whole);
    for &[first, second] in stops {
        let saved: SavedState<D> = stopped(model, first);
        let rest = resumed(model, &saved).expect("it continues");
        assert!(bits(&rest) == expected, "{}: stopped after {first} steps", model.case.title);
        let again = stopped_again(model, &saved, second);
        let rest = resumed(model, &again).expect("it continues again");
        assert!(bits(&rest) == expected, "{}: stopped again after {second}", model.case.title);
    }
    whole
}

#[test]
fn bodies_on_a_mesh_that_is_replaced_end_with_the_same_bits() {
    for adaptive in ["", ", adaptive = { tolerance = 5e-3, largest = 0.04 }"] {
        let whole = ends_with_the_same_bits::<2>(&two_bodies(adaptive), &[[3, 5], [50, 58]]);
        assert!(last(&whole, "flow.remeshes") >= 1.0);
        let gaps = column(&whole, "flow.minimum_gap");
        assert!(gaps.iter().any(|&gap| gap < 0.45), "there is contact");
    }
}

/// Here factors serve many steps, with pauses between them.
#[test]
fn a_flow_solved_with_earlier_factors_ends_with_the_same_bits() {
    let model = case(
        r#"
        title = "vortices behind a disc"
        geometry = "planar"
        fluid = { model = "navier-stokes", density = 1.0, viscosity = 0.01 }
        domain.box = { min = [-2.0, -2.0], max = [6.0, 2.2] }
        boundary = { left = { velocity = { value = [1.0, 0.0] } }, right = "do-nothing", bottom = "symmetry", top = "symmetry" }
        mesh = { size = 0.4, surface = 0.08 }
        time.unsteady = { step = 0.05, end = 2.0 }
        [[body]]
        name = "disc"
        shape = { disc = { radius = 0.5 } }
        center = [0.0, 0.0]
        motion = "held"
        "#,
    );
    ends_with_the_same_bits::<2>(&model, &[[1, 2], [17, 29]]);
}

#[test]
fn a_swimmer_without_inertia_ends_with_the_same_bits() {
    let settings = ["mesh.scale=2.0".to_owned(), "time.unsteady.step=0.2".to_owned()];
    let model = Case::read("three-sphere", &settings).expect("the case exists").model;
    ends_with_the_same_bits::<2>(&model, &[[4, 7], [11, 13]]);
}

#[test]
fn a_body_in_space_ends_with_the_same_bits() {
    let model = case(
        r#"
        title = "an ellipsoid falls through its mesh"
        geometry = "spatial"
        fluid = { model = "navier-stokes", viscosity = 1.0, density = 1.0, gravity = [120.0, 40.0, -80.0] }
        domain.sphere = { radius = 6.0 }
        boundary = { wall = "no-slip" }
        mesh = { size = 3.0, surface = 0.9, growth = 1.0, gap_layers = 1 }
        time.unsteady = { step = 0.05, end = 0.3 }
        [[body]]
        name = "body"
        shape.ellipsoid.semi_axes = [1.2, 0.9, 0.7]
        center = [0.1, -0.1, 0.2]
        density = 3.0
        motion = "free"
        "#,
    );
    let whole = ends_with_the_same_bits::<3>(&model, &[[2, 4]]);
    assert!(last(&whole, "flow.remeshes") >= 1.0);
}

/// Signals come at any time: every step is reported once, before the stop or after it.
#[test]
fn no_step_is_lost_where_a_run_is_stopped() {
    for scheme in ["", ", scheme = \"bdf1\"", ", adaptive = { tolerance = 5e-3, largest = 0.04 }"] {
        let mut case = two_bodies(scheme);
        if let TimeSettings::Unsteady(unsteady) = &mut case.case.time {
            unsteady.end = 0.2;
        }
        let whole = run(&case);
        for (after, spared) in [(0, 0), (0, 1), (0, 4), (0, 9), (1, 1), (4, 1), (4, 2)] {
            let stopped = stopped_within_a_step::<2>(&case, after, spared);
            let rest = resumed(&case, stopped.state.as_ref().expect("it left a state"))
                .expect("it continues");
            assert!(rest.series.times.starts_with(&stopped.times));
            let [rest, whole] = [&rest, &whole].map(bits);
            let row = rest.iter().zip(&whole).position(|(one, other)| one != other);
            assert!(rest == whole, "{scheme}, {after}, {spared}: from row {row:?} on");
        }
    }
}

#[test]
fn a_state_of_another_problem_is_refused_by_its_key() {
    let saved = stopped::<2>(&two_bodies(""), 2);
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
        let message = refused(&text.replacen(from, to, 1));
        assert!(message.contains(&format!("by a case with {key} = ")), "{message}");
    }
}
