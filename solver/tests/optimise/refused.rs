//! What a search of a steady flow is refused for, and how one ends that fails on its way.

use std::fs;

use super::{alewife, done, refused};

/// A disc in a channel, whose place across is sought.
const DISC: &str = r#"
title = "disc in a channel"
geometry = "planar"
fluid = { model = "navier-stokes", viscosity = 0.02, density = 1.0 }
domain.channel = { length = 4.0, height = 2.0 }
boundary = { left = { parabolic = { peak = 1.0 } }, right = "do-nothing", bottom = "no-slip", top = "no-slip" }
mesh = { size = 0.4, surface = 0.12 }
time.steady = {}
[[body]]
name = "disc"
shape = { disc = { radius = 0.25 } }
center = [1.2, 0.9]
motion = "held"
[optimisation.objective]
sum = [{ quantity = "disc.force.x", weight = -1.0 }]
[[optimisation.parameter]]
name = "height"
keys = ["body.0.center.1"]
bounds = [0.5, 1.5]
scale = 0.1
[optimisation.search]
evaluations = 4
"#;

#[test]
fn what_cannot_be_sought_is_refused_where_it_is_written() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    fs::write(at.join("disc.toml"), DISC).unwrap();
    let with = |from: &str, to: &str, code: i32| {
        assert!(DISC.contains(from));
        fs::write(at.join("wrong.toml"), DISC.replace(from, to)).unwrap();
        refused(at, &["optimise", "wrong.toml", "--out", "w"], code)
    };
    let found = with("body.0.center.1", "domain.channel.height", 65);
    assert!(
        found.contains("sides of the domain stay") && found.contains("wrong.toml:18"),
        "{found}"
    );
    let found = with("body.0.center.1", "body.0.centre.1", 65);
    assert!(found.contains("did you mean `body.0.center.1`"), "{found}");
    let found = with("[0.5, 1.5]", "[0.1, 1.5]", 65);
    assert!(found.contains("at its bound 0.1") && found.contains("wrong.toml:19"), "{found}");
    let found = with("[0.5, 1.5]", "[1.4, 1.5]", 65);
    assert!(found.contains("not between its bounds") && found.contains("wrong.toml:19"), "{found}");
    // A run is no search
    let output = alewife(at, &["check", "wrong.toml", "--no-mesh"]);
    let warned = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success() && warned.contains("not between its bounds"), "{warned}");
    let found = with("disc.force.x", "disc.surface_force.x", 65);
    assert!(found.contains("not known") && found.contains("wrong.toml:15"), "{found}");
    let found = with("time.steady = {}", "time.unsteady = { step = 0.1, end = 1.0 }", 65);
    assert!(found.contains("write [time.steady]"), "{found}");
    let found = refused(at, &["optimise", "dfg-2d-1", "--out", "w"], 65);
    assert!(found.contains("no [optimisation]"), "{found}");
    let found = refused(at, &["calibrate", "disc.toml", "--out", "w"], 65);
    assert!(found.contains("no [calibration]"), "{found}");
    assert!(!at.join("w").exists());
}

#[test]
fn a_search_ends_with_its_evaluations_and_says_how_long_it_takes() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    fs::write(at.join("disc.toml"), DISC).unwrap();
    let output = alewife(at, &["optimise", "disc.toml"]);
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(told.contains("round 1 [4/4]") && told.contains("s left at most"), "{told}");
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(said.contains("its evaluations are used up"), "{said}");
    // The least drag is at the wall, where the flow is slowest: nearer to it than the start at any rate
    let table = fs::read_to_string(at.join("runs/disc-optimisation/evaluations.csv")).unwrap();
    assert!(table.starts_with("evaluation,objective,height,slope.height\n1,"), "{table}");
    assert_eq!(table.lines().count(), 5);
    // The case is one of a run all the same
    let checked = done(at, &["check", "disc.toml"]);
    assert!(checked.contains("`alewife optimise`: disc.force.x by height"), "{checked}");
}
