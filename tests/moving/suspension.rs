//! Bodies that fill a doubly periodic cell: its sides, its mean velocity, and what they do in it.

use std::f64::consts::PI;
use std::fmt::Write as _;

use alewife_core::run::{RunSummary, simulate};
use tests::cases::{PERIODIC_BOX, case, last, run};
use tests::figure;

/// Place and heading of swimmers in a cell of this length, which leave no straight strip free.
const LENGTH: f64 = 6.0;
const SWIMMERS: [[f64; 3]; 5] =
    [[1.2, 1.3, 0.3], [4.3, 1.1, 2.9], [2.6, 3.0, -1.4], [5.4, 3.3, 1.9], [1.1, 4.7, -0.6]];

/// A cell with swimmers, moved by a vector and back into it by whole periods.
fn cell(time: &str, by: [f64; 2], more: &str) -> String {
    let mut text = format!(
        r#"
        title = "swimmers in a cell"
        geometry = "planar"
        fluid = {{ model = "stokes", viscosity = 1.0 }}
        domain.box = {{ min = [0.0, 0.0], max = [{LENGTH}, {LENGTH}] }}
        mesh = {{ size = 0.5, surface = 0.18, growth = 0.35, gap_layers = 2 }}
        time.{time}
        {PERIODIC_BOX}
        {more}
        "#
    );
    for (i, [x, y, heading]) in SWIMMERS.iter().enumerate() {
        let (x, y) = ((x + by[0]).rem_euclid(LENGTH), (y + by[1]).rem_euclid(LENGTH));
        let stroke = [2.0, 0.0, -2.0][i % 3];
        write!(
            text,
            r#"
            [[body]]
            name = "s{i}"
            shape.disc.radius = 0.8
            center = [{x}, {y}]
            motion = "free"
            gait.squirmer = {{ modes = [2.0, {stroke}], heading = {heading} }}
            "#
        )
        .expect("a string takes all");
    }
    text
}

fn velocities(outcome: &RunSummary) -> Vec<f64> {
    let quantities = ["velocity.x", "velocity.y", "angular_velocity"];
    let names = (0..SWIMMERS.len()).flat_map(|i| quantities.map(|q| format!("s{i}.{q}")));
    names.map(|name| last(outcome, &name)).collect()
}

fn farthest(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Straight sides where bodies leave them alone, or a torus: one flow.
#[test]
fn velocities_do_not_depend_on_where_the_cell_is_cut() {
    let at = |by: [f64; 2]| velocities(&run(&case(&cell("steady = {}", by, ""))));
    let first = at([0.0, 0.0]);
    // Moved by the first of these they are whole in the box, and its sides are those of the mesh
    for (by, tolerance) in [([-0.25, 0.1], 5e-4), ([0.5 * LENGTH, 0.5 * LENGTH], 1e-8)] {
        let moved = at(by);
        figure!(farthest(&first, &moved), "moved by {by:?}");
        assert!(farthest(&first, &moved) < tolerance, "{first:?} {moved:?}");
    }
}

/// The triangles of a torus follow the bodies: to rounding.
#[test]
fn swimmers_moved_by_half_a_cell_swim_alike() {
    let contact = "contact.barrier = { range = 0.1, stiffness = 500.0 }";
    let time = "unsteady = { step = 0.05, end = 1.5 }";
    let path = |by: [f64; 2]| {
        let outcome = run(&case(&cell(time, by, contact)));
        let column = |name: String| outcome.series.column(&name).expect("is there");
        let way = |name: String| {
            let all = column(name);
            all.iter().map(|x| x - all[0]).collect::<Vec<f64>>()
        };
        let gap = column("flow.minimum_gap".into()).into_iter().fold(f64::INFINITY, f64::min);
        let ways: Vec<f64> = (0..SWIMMERS.len())
            .flat_map(|i| ["x", "y", "angle"].map(|q| way(format!("s{i}.{q}"))))
            .flatten()
            .collect();
        (ways, gap, last(&outcome, "flow.remeshes"), outcome)
    };
    // Neither leaves the bodies whole in the box
    let (one, gap, remeshes, outcome) = path([0.8, 0.7]);
    let (other, ..) = path([0.8 - 0.5 * LENGTH, 0.7 - 0.5 * LENGTH]);
    figure!(farthest(&one, &other), "across the sides");
    figure!(gap, "least gap");
    assert!(remeshes >= 2.0 && gap > 0.0 && gap < 0.1, "{remeshes} meshes, gap {gap}");
    assert!(farthest(&one, &other) < 1e-6, "{:e}", farthest(&one, &other));
    // No force acts on any of them, contact and fluid together, nor on all by the fluid
    for axis in ["x", "y"] {
        let mut sum = 0.0;
        for i in 0..SWIMMERS.len() {
            let force = last(&outcome, &format!("s{i}.force.{axis}"));
            let contact = last(&outcome, &format!("s{i}.contact_force.{axis}"));
            assert!((force + contact).abs() < 1e-8, "{force} {contact}");
            sum += force;
        }
        assert!(sum.abs() < 1e-8, "{sum:e}");
    }
}

/// A square array of neutral squirmers is one of dipoles in a potential flow: where no net volume
/// crosses the cell all others move one by -phi U0, with phi the part of the area they take. That
/// their flow is not the same everywhere on a surface slows them further, by about 1.3 phi^3.
#[test]
fn an_array_of_neutral_squirmers_swims_slower_by_its_own_volume() {
    for length in [4.0, 8.0] {
        let phi: f64 = PI / (length * length);
        let text = format!(
            r#"
            title = "a square array of neutral squirmers"
            geometry = "planar"
            fluid = {{ model = "stokes", viscosity = 1.0 }}
            domain.box = {{ min = [0.0, 0.0], max = [{length}, {length}] }}
            mesh = {{ size = 0.5, surface = 0.07, growth = 0.15 }}
            time.steady = {{}}
            {PERIODIC_BOX}
            [[body]]
            name = "s"
            shape.disc.radius = 1.0
            center = [0.3, 2.0]
            motion = "free"
            gait.squirmer = {{ modes = [2.0, 0.0], heading = 0.0 }}
            "#
        );
        let outcome = run(&case(&text));
        let speed = last(&outcome, "s.velocity.x");
        let beyond = (1.0 - phi - speed) / phi.powi(3);
        figure!(beyond, "length {length}: beyond phi");
        assert!((0.5..2.0).contains(&beyond), "{speed}: {beyond}");
        assert!(last(&outcome, "s.velocity.y").abs() < 1e-4);
    }
}

#[test]
fn forces_that_nothing_balances_are_refused() {
    let text = cell("steady = {}", [0.0; 2], "").replacen(
        "motion = \"free\"",
        "motion = \"free\"\nforce = [0.0, 0.3]",
        1,
    );
    let refused =
        simulate::<2>(&case(&text), &mut []).map(|_| ()).expect_err("is refused").to_string();
    assert!(refused.contains("sum up to") && refused.contains("along y"), "{refused}");
}
