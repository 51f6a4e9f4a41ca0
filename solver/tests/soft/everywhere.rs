//! Soft cases where cases of flows go: variants, sweeps, `status`, `verify`; and runs by a reduced model there.

use std::fs;
use std::path::Path;

use super::{BAR, alewife, done, refused};

const VARIANT: &str = r#"
[[variant]]
name = "stiff"
set = { "solid.0.material.young" = 8e4 }
[[variant.reference]]
quantity = "time"
value = 0.32
relative = 1e-9
kind = "exact"
source = "eight frames"
[sweep]
grid = { "solid.0.material.young" = [4e4, 8e4] }
quantities = ["tip.x", "max energy.elastic"]
"#;

fn cell(at: &Path, table: &str, row: usize, column: &str) -> String {
    let text = fs::read_to_string(at.join(table)).unwrap();
    let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let names = lines.next().unwrap();
    let column = names.iter().position(|name| *name == column).unwrap();
    lines.nth(row).unwrap()[column].to_owned()
}

#[test]
fn a_variant_of_a_soft_case_is_run_shown_and_compared() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    fs::write(at.join("bar.toml"), format!("{BAR}{VARIANT}")).unwrap();
    let said = done(at, &["show", "bar.toml"]);
    assert!(said.contains("variant bar/stiff: solid.0.material.young"), "{said}");
    done(at, &["run", "bar.toml/stiff", "--fidelity", "soft"]);
    done(at, &["run", "bar.toml", "--fidelity", "soft"]);
    let set = "solid.0.material.young=8e4";
    done(at, &["run", "bar.toml", "--fidelity", "soft", "--set", set, "--out", "set"]);
    let series = |run: &str| fs::read(at.join(run).join("series.csv")).unwrap();
    assert_eq!(series("runs/bar-stiff"), series("set"));
    assert_ne!(series("runs/bar-stiff"), series("runs/bar"));
    let said = done(at, &["validate", "bar.toml"]);
    assert!(said.contains("bar/stiff") && said.contains("3 of 3 values"), "{said}");
    let wrong = refused(at, &["run", "bar.toml/soft", "--fidelity", "soft"], 65);
    assert!(wrong.contains("no variant `soft`") && wrong.contains("stiff"), "{wrong}");
}

#[test]
fn a_soft_case_is_swept_and_the_sweep_is_verified() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    fs::write(at.join("bar.toml"), format!("{BAR}{VARIANT}")).unwrap();
    assert!(done(at, &["sweep", "expand", "bar.toml"]).contains("80000"));
    let said = done(at, &["sweep", "run", "bar.toml", "--quiet"]);
    assert!(said.contains("2 of 2 points finished"), "{said}");
    let run = ["run", "bar.toml/stiff", "--fidelity", "soft", "--out", "r"];
    done(at, &run);
    let table = "sweeps/bar/sweep.csv";
    let last = fs::read_to_string(at.join("r/series.csv")).unwrap();
    let names = last.lines().next().unwrap().split(',').position(|name| name == "tip.x");
    let tip = last.lines().last().unwrap().split(',').nth(names.unwrap()).unwrap().to_owned();
    assert_eq!(cell(at, table, 1, "tip.x"), tip);
    assert_eq!(cell(at, table, 1, "time verdict"), "within");
    let largest: f64 = cell(at, table, 0, "energy.elastic (max)").parse().unwrap();
    assert!(largest > 0.0);
    assert!(done(at, &["sweep", "status", "sweeps/bar"]).contains("2 finished"));
    assert!(done(at, &["verify", "sweeps/bar"]).contains("sound; 2 finished"));
    // Points are kept, and their directories known as theirs
    let again = done(at, &["sweep", "run", "bar.toml", "--quiet"]);
    assert!(again.contains("2 of 2 points finished"), "{again}");
    let points = at.join("sweeps/bar/points");
    fs::rename(points.join("0001"), at.join("kept")).unwrap();
    fs::rename(points.join("0002"), points.join("0001")).unwrap();
    fs::rename(at.join("kept"), points.join("0002")).unwrap();
    let wrong = refused(at, &["sweep", "run", "bar.toml", "--quiet"], 65);
    assert!(wrong.is_empty() || wrong.contains("another case"), "{wrong}");
    let unknown = ["sweep", "run", "bar.toml", "--quantity", "tip.z", "--out", "s"];
    assert!(refused(at, &unknown, 65).contains("no quantity `tip.z`"));
    let set = "solid.0.material.poisson=0.3,0.7";
    let wrong = refused(at, &["sweep", "run", "bar.toml", "--set", set, "--out", "s"], 65);
    assert!(wrong.contains("0.5 at most") && wrong.contains("nothing was run"), "{wrong}");
}

#[test]
fn soft_runs_are_known_to_status_and_verify() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    fs::write(at.join("bar.toml"), BAR).unwrap();
    done(at, &["run", "bar.toml", "--fidelity", "soft", "--out", "r"]);
    let said = done(at, &["status", "r"]);
    assert!(said.contains("finished, step 8 of 8") && said.contains("soft model"), "{said}");
    let said = done(at, &["verify", "r"]);
    assert!(said.contains("sound; finished; rows: 9, fields: 9"), "{said}");
    let series = fs::read_to_string(at.join("r/series.csv")).unwrap();
    let short: Vec<&str> = series.lines().take(7).collect();
    fs::write(at.join("r/series.csv"), short.join("\n") + "\n").unwrap();
    fs::remove_file(at.join("r/fields/frame-0003.vtu")).unwrap();
    let output = alewife(at, &["verify", "r"]);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(output.status.code(), Some(65));
    assert!(said.contains("it has 6 rows, and 8 frames were made"), "{said}");
    assert!(said.contains("fields/frame-0003.vtu: it is missing"), "{said}");
    fs::write(at.join("r/case.toml"), BAR.replace("4e4", "5e4")).unwrap();
    let output = alewife(at, &["verify", "r"]);
    assert!(String::from_utf8_lossy(&output.stdout).contains("its checksum is"));
    // One that fails leaves why
    let set = "solid.0.fibre.0.stretch.wave.mean=1e-3";
    let more = "solid.0.fibre.0.stretch.wave.amplitude=0.0";
    let stiff = "solid.0.fibre.0.stiffness=1e15";
    let fails = ["run", "bar.toml", "--fidelity", "soft", "--out", "f"];
    let output =
        alewife(at, &[&fails[..], &["--set", set, "--set", more, "--set", stiff]].concat());
    if output.status.code() == Some(10) {
        assert!(done(at, &["status", "f"]).contains("failed"));
        done(at, &fails);
    }
}

#[test]
fn the_mesh_of_a_soft_body_is_written() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    fs::write(at.join("bar.toml"), BAR).unwrap();
    let said = done(at, &["mesh", "bar.toml"]);
    assert!(said.contains("48") && said.contains("written to bar.vtu"), "{said}");
    let said = done(at, &["mesh", "bar.toml", "--out", "bar.msh"]);
    assert!(said.contains("written to bar.msh"), "{said}");
    // Which is one that a body can be made of
    let grid = "grid = { from = [0.0, -0.06], to = [0.012, 0.06], cells = [2, 12] }";
    let text = BAR.replace(grid, "mesh = { file = \"bar.msh\" }");
    fs::write(at.join("given.toml"), text).unwrap();
    assert!(done(at, &["check", "given.toml"]).contains("48 cells"));
}

#[test]
fn runs_by_a_reduced_model_are_known_to_status_and_verify() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    let run = ["run", "tendon-fish", "--out", "r", "--set", "time.unsteady.end=0.5"];
    let output = alewife(at, &run);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(done(at, &["status", "r"]).contains("reduced model"));
    assert!(done(at, &["verify", "r"]).contains("sound; finished"));
    assert!(refused(at, &run, 2).contains("--overwrite"));
    done(at, &[&run[..], &["--overwrite"]].concat());
}
