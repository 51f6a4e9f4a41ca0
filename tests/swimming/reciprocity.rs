//! Without inertia the way does not depend on how fast it is gone, and to and fro leads nowhere.

use tests::cases::{case, last, run};
use tests::figure;

/// Purcell's swimmer in a container, or a scallop, with a stroke of a given period.
fn swim(kind: &str, time: &str) -> [f64; 3] {
    let text = format!(
        r#"
        title = "a swimmer without inertia"
        geometry = "planar"
        fluid = {{ model = "stokes", viscosity = 1.0 }}
        domain.disc.radius = 3.0
        boundary.wall = "no-slip"
        mesh = {{ size = 1.0, surface = 0.2, growth = 0.5, gap_layers = 1, moving.layers = 1, moving.quality = 0.05 }}
        time.unsteady = {{ {time} }}
        [[swimmer]]
        name = "swimmer"
        center = [0.4, 0.3]
        angle = 0.3
        [swimmer.kind]
        {kind}
        "#
    );
    let outcome = run(&case(&text));
    assert_eq!(last(&outcome, "flow.remeshes"), 0.0);
    if time.contains("rk3") {
        // Implicit steps end a trifle off where the flow was solved for.
        assert!(last(&outcome, "flow.energy_defect").abs() < 1e-8);
    }
    ["x", "y", "angle"].map(|part| last(&outcome, &format!("swimmer.cycle.{part}")))
}

fn purcell(period: f64) -> String {
    let bent = |knots: [f64; 4]| {
        let knots = [0.0, 0.25, 0.5, 0.75].map(|part| part * period).into_iter().zip(knots);
        let knots: Vec<String> = knots.map(|(time, angle)| format!("[{time}, {angle}]")).collect();
        let knots = knots.join(", ");
        format!(
            "{{ bent = {{ angle = {{ legs = {{ period = {period}, knots = [{knots}] }} }} }} }}"
        )
    };
    format!(
        "chain = {{ links = [[0.4, 0.1], [0.4, 0.1], [0.4, 0.1]], gap = 0.3, joints = [{}, {}] }}",
        bent([0.4, 0.4, -0.4, -0.4]),
        bent([0.4, -0.4, -0.4, 0.4])
    )
}

#[test]
fn the_way_of_a_cycle_does_not_depend_on_its_rate() {
    for scheme in ["rk3", "bdf2"] {
        let at = |period: f64| {
            let time = format!("step = {}, end = {period}, scheme = \"{scheme}\"", period / 16.0);
            swim(&purcell(period), &time)
        };
        let (slow, fast) = (at(1.0), at(0.25));
        let off = slow.iter().zip(fast).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
        figure!(off, "{scheme}: rate");
        assert!(slow[0].hypot(slow[1]) > 1e-3);
        assert!(off < 1e-9, "{scheme}: {slow:?} {fast:?}");
    }
}

/// One arm, shortened fast and let out slowly, and one pivot. What is left is the error of the steps,
/// of third order at least.
#[test]
fn a_scallop_is_back_where_it_was() {
    let arm = "linked-spheres = { radii = [0.3, 0.5], \
               arms = [{ legs = { period = 1.0, knots = [[0.0, 1.5], [0.2, 1.3]] } }] }";
    let pivot = "chain = { links = [[0.5, 0.15], [0.3, 0.1]], gap = 0.3, \
                 joints = [{ bent = { angle = { sine = { mean = 0.4, amplitude = 0.2, period = 1.0 } } } }] }";
    for (name, kind, step) in [("arm", arm, 0.02), ("pivot", pivot, 0.01)] {
        let left = [2.0 * step, step].map(|step| {
            let way = swim(kind, &format!("step = {step}, end = 1.0, scheme = \"rk3\""));
            way.iter().fold(0.0f64, |most, part| most.max(part.abs()))
        });
        figure!(left[1], "{name}");
        assert!(left[1] < 1e-8 && left[1] < left[0] / 6.0, "{name}: {left:?}");
    }
}
