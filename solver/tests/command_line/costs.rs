//! What `check` tells of a run from one step, beside what the run takes.

use std::path::Path;

use super::{alewife, done};

/// What figures of `check` may be off by, as a factor.
const FACTOR: f64 = 2.0;

/// The number with a unit after a word, in seconds or bytes.
fn quantity(said: &str, what: &str) -> f64 {
    let line = said.lines().find(|line| line.trim_start().starts_with(what)).expect(what);
    let rest = line.split(what).nth(1).unwrap().trim().replace("less than a second", "0.7 s");
    let mut words = rest.split([' ', ',', ':', ';']);
    let number: f64 = words.next().unwrap().parse().unwrap();
    let unit = match words.next().unwrap() {
        "ms" => 1e-3,
        "s" => 1.0,
        "min" => 60.0,
        "kB" => 1e3,
        "MB" => 1e6,
        other => panic!("{other} in {line}"),
    };
    number * unit
}

/// Bytes of all files below a directory.
fn size_of(directory: &Path) -> f64 {
    let entries = std::fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().path());
    let size = |path: std::path::PathBuf| match path.is_dir() {
        true => size_of(&path),
        false => path.metadata().unwrap().len() as f64,
    };
    entries.map(size).sum()
}

/// One with the explicit scheme and jumps of its rates, one with inertia from rest on a moving mesh.
#[test]
fn a_step_that_check_makes_tells_what_a_run_takes() {
    let short = ", and 7 more short ones";
    for (case, end, more) in
        [("three-sphere", "4.0", "\n"), ("vortex-induced-vibration", "1.2", short)]
    {
        let place = tempfile::tempdir().unwrap();
        let end = format!("time.unsteady.end={end}");
        let settings = ["--set", &end];
        let said = done(place.path(), &[&["check", case], &settings[..]].concat());
        let run = ["run", case, "--out", "run", "--threads", "1", "--quiet"];
        done(place.path(), &[&run[..], &settings[..]].concat());
        let directory = place.path().join("run");
        let text = std::fs::read_to_string(directory.join("status.json")).unwrap();
        let status: serde_json::Value = serde_json::from_str(&text).unwrap();
        let steps = format!("steps            {}{more}", status["steps"]);
        assert!(said.contains(&steps), "{steps}{said}");
        let mut taken =
            vec![("CPU time", status["cpu_seconds"]["total"].as_f64()), ("output", None)];
        // Not every system tells
        taken.push(("memory", status["peak_memory"].as_f64()));
        taken[1].1 = Some(size_of(&directory));
        for (what, taken) in taken {
            let Some(taken) = taken else { continue };
            let ratio = taken / quantity(&said, what);
            println!("{case}, {what}: {ratio:.2} of what `check` tells");
            assert!((1.0 / FACTOR..FACTOR).contains(&ratio), "{what}: {ratio}\n{said}");
        }
    }
}

#[test]
fn check_says_what_its_figures_are_of() {
    let place = tempfile::tempdir().unwrap();
    let check = |case: &str, more: &[&str]| done(place.path(), &[&["check", case], more].concat());
    let steady = check("squirmer-alone", &["--set", "mesh.scale=2"]);
    assert!(steady.contains("for one linear system, as it took just now"), "{steady}");
    let adaptive = "time.unsteady.adaptive={ largest = 0.5 }";
    let said = check("three-sphere", &["--set", adaptive, "--set", "time.unsteady.step=0.25"]);
    assert!(said.contains("by their errors: 8 at least, and 16 if all were of the"), "{said}");
    assert!(said.contains("a step of 3 linear systems, as one took just now"), "{said}");
    assert!(said.contains("new meshes and thin films as bodies move"), "{said}");
    let without = check("three-sphere", &["--no-step"]);
    assert!(without.contains("P2 nodes") && !without.contains("CPU time"), "{without}");
}

/// It is no failure: a run would try shorter ones.
#[test]
fn check_says_why_no_step_is_made() {
    let place = tempfile::tempdir().unwrap();
    let text = r#"
        title = "a disc that is thrown at a wall"
        geometry = "planar"
        fluid = { model = "stokes", viscosity = 1.0 }
        domain.box = { min = [-3.0, -3.0], max = [3.0, 3.0] }
        boundary = { left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }
        mesh = { size = 2.0, surface = 0.3, growth = 0.6, gap_layers = 1 }
        time.unsteady = { step = 1.0, end = 2.0, scheme = "rk3" }
        [[body]]
        name = "disc"
        shape.disc.radius = 0.5
        center = [0.0, 0.0]
        motion = "free"
        force = [1000.0, 0.0]
    "#;
    std::fs::write(place.path().join("disc.toml"), text).unwrap();
    let output = alewife(place.path(), &["check", "disc.toml"]);
    let said = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.contains("not known: a step of 1 is not made in one ("), "{said}");
}
