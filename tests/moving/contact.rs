//! Bodies that meet walls and each other in whole runs.

use alewife_core::run::{RunError, simulate};
use tests::cases::{case, last, run};

use super::tank;

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
    let gap = outcome.series.column("flow.minimum_gap").expect("the mesh moves");
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

/// A law that cannot carry a body says so, with the names and what would help.
#[test]
fn a_law_too_weak_for_a_body_is_named() {
    let text = tank("navier-stokes", "step = 0.02, end = 4.0", "size = 0.3, surface = 0.1")
        + r#"
        contact.quadratic = { range = 0.05, epsilon = 1e-2 }
        [[body]]
        name = "anvil"
        shape = { disc = { radius = 0.25 } }
        center = [0.0, -1.1]
        density = 20.0
        motion = "free"
        "#;
    let error = simulate::<2>(&case(&text), &mut []).expect_err("it sinks through");
    let message = error.to_string();
    assert!(matches!(error, RunError::Contact { .. }), "{message}");
    for word in ["`anvil`", "`bottom`", "lower epsilon", "step "] {
        assert!(message.contains(word), "{word}: {message}");
    }
}

/// A body that is driven into a wall stops the run with both names and the gap that is left; where bodies
/// could give way, contact is proposed.
#[test]
fn a_body_driven_into_a_wall_stops_the_run() {
    let alone = tank("stokes", "step = 0.1, end = 4.0", "size = 0.3, surface = 0.1")
        + r#"
        [[body]]
        name = "piston"
        shape = { disc = { radius = 0.25 } }
        center = [0.0, -1.0]
        motion.imposed = { velocity = [0.0, -0.5] }
        "#;
    let other = r#"
        [[body]]
        name = "other"
        shape = { disc = { radius = 0.25 } }
        center = [0.0, 0.6]
        motion = "free"
        "#;
    for (text, is_proposed) in [(alone.clone(), false), (alone + other, true)] {
        let error = simulate::<2>(&case(&text), &mut []).expect_err("there is a wall");
        let message = error.to_string();
        println!("{message}");
        for word in ["`piston`", "`bottom`", "step 5 ", "failure/"] {
            assert!(message.contains(word), "{word}: {message}");
        }
        assert_eq!(message.contains("[contact] keeps bodies apart"), is_proposed, "{message}");
    }
}
