//! Bodies that meet walls and each other in whole runs.

use super::tank;
use tests::cases::{case, last, run};

const DISCS: &str = r#"
contact.barrier = { range = 0.05, stiffness = 200.0 }
[[body]]
name = "low"
shape = { disc = { radius = 0.25 } }
center = [0.02, -1.15]
density = 2.0
motion = "free"
[[body]]
name = "high"
shape = { disc = { radius = 0.25 } }
center = [-0.05, -0.5]
density = 1.5
motion = "free"
"#;

/// Contact and fluid carry the weight of bodies at rest, each reported by itself.
#[test]
fn a_pile_comes_to_rest_and_its_forces_balance() {
    let mesh = "size = 0.3, surface = 0.1, gap_layers = 2.5";
    let text = tank("navier-stokes", "step = 0.02, end = 4.0", mesh) + DISCS;
    let outcome = run(&case(&text));
    let gap = outcome.series.column("flow.least_gap").expect("the mesh moves");
    assert!(gap.iter().all(|gap| *gap > 0.0));
    for (name, net) in [("low", 1.0), ("high", 0.5)] {
        let weight = net * 10.0 * std::f64::consts::PI * 0.0625;
        let value = |what: &str| last(&outcome, &format!("{name}.{what}"));
        let mass = (1.0 + net) * std::f64::consts::PI * 0.0625;
        let sum = value("force.y") + value("contact_force.y") - weight;
        let defect = (sum - mass * value("acceleration.y")).abs() / weight;
        assert!(defect < 1e-9, "{name}: {defect:e}");
    }
    let speed = last(&outcome, "low.velocity.y").abs();
    assert!(speed < 2e-3, "{speed}");
}

/// Contacts, new meshes and all, to the last bit.
#[test]
fn a_run_with_contact_has_the_same_bits_on_any_number_of_threads() {
    let mesh = "size = 0.3, surface = 0.1, gap_layers = 2.5";
    let text = tank("navier-stokes", "step = 0.04, end = 1.2", mesh) + DISCS;
    let case = case(&text);
    let on = |n: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("threads start");
        let outcome = pool.install(|| run(&case));
        assert!(last(&outcome, "flow.remeshes") >= 1.0);
        let bits = outcome.series.rows.iter().flatten().map(|value| value.to_bits());
        bits.collect::<Vec<u64>>()
    };
    let alone = on(1);
    assert!(alone == on(2) && alone == on(5));
}
