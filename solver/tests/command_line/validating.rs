//! A validation that is kept: what is run again and what is not, its companions, and its page.

use std::path::Path;

use serde_json::Value;

use super::{DISC, FLUID, GIVEN_MESH, alewife, done};

const RUN: &str = "kept/c-radius-2";
const COMPANION: &str = "kept/c-radius-2+coarser";

/// A case of several variants in a directory, with its text changed.
fn case(directory: &Path, from: &str, to: &str) {
    let text = done(directory, &["show", "sphere-in-shell", "--source"]);
    assert!(from.is_empty() || text.contains(from));
    std::fs::write(directory.join("c.toml"), text.replace(from, to)).unwrap();
}

fn validated(directory: &Path, more: &[&str]) -> Value {
    let mut arguments = vec!["validate", "c.toml", "--json", "--threads", "1"];
    arguments.extend(more);
    serde_json::from_str(&done(directory, &arguments)).unwrap()
}

fn read(path: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

/// The row of the variant whose runs are looked at.
fn row(json: &Value) -> &Value {
    let rows = json["comparisons"].as_array().unwrap();
    rows.iter().find(|row| row["case"] == "c/radius-2").unwrap()
}

#[test]
fn the_page_has_what_mesh_leaves_by_the_two_runs_that_are_kept() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    case(here, "", "");
    let json = validated(here, &["--out", "kept", "--uncertainty", "--report=page.md"]);
    // The same by the files
    let force = |run: &str| -> f64 {
        let series = alewife::observer::read_series(&here.join(run)).unwrap();
        series.column("sphere.force.x").unwrap()[0]
    };
    let cells = |run: &str| read(&here.join(run).join("mesh.json"))["cells"].as_f64().unwrap();
    let squared_ratio = cells(RUN) / cells(COMPANION);
    assert!((1.7..2.3).contains(&squared_ratio), "{squared_ratio}");
    let per = -6.0 * std::f64::consts::PI * row(&json)["reference"].as_f64().unwrap();
    let own = 3.0 * ((force(RUN) - force(COMPANION)) / per).abs() / (squared_ratio - 1.0);
    let told = row(&json)["numerical_uncertainty"].as_f64().unwrap();
    assert!((told / own - 1.0).abs() < 1e-9, "{told} {own}");
    assert!(row(&json)["difference"].as_f64().unwrap().abs() < told);
    assert_eq!(row(&json)["evidence"], "confirmed");
    // That of another one is smaller by chance, and is raised to the median, which this one is
    let rows = json["comparisons"].as_array().unwrap();
    let nearest = rows.iter().find(|row| row["case"] == "c/radius-4-to-3").unwrap();
    assert!((nearest["numerical_uncertainty"].as_f64().unwrap() / told - 1.0).abs() < 1e-9);
    assert_eq!(row(&read(&here.join(RUN).join("comparison.json"))), row(&json));

    let page = std::fs::read_to_string(here.join("page.md")).unwrap();
    assert!(page.contains("\n## c\n\n**A sphere moving at the centre of"), "{page}");
    assert!(page.contains("5 of 5 values within their band"), "{page}");
    assert!(page.contains(&format!("| radius-2 | {} | ", cells(RUN))), "{page}");
    assert!(page.contains(&format!("| {} cells; ratio", cells(COMPANION))), "{page}");
    assert!(!page.contains("| sphere.force.x | 7.29434 | - |"), "{page}");
    let from = validated(here, &["--from", "kept", "--uncertainty"]);
    assert_eq!(row(&from)["numerical_uncertainty"].as_f64(), Some(told));
}

#[test]
fn what_is_kept_is_run_again_only_where_the_case_or_the_program_has_changed() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    case(here, "", "");
    let json = validated(here, &["--out", "kept"]);
    // A mark that a new run would remove
    let mark = |run: &str| here.join(run).join("STOP");
    let is_kept = |more: &[&str]| {
        std::fs::write(mark(RUN), "").unwrap();
        let json = validated(here, &[&["--out", "kept"], more].concat());
        (mark(RUN).is_file(), json)
    };
    assert_eq!(is_kept(&[]), (true, json));
    case(here, " 7.294", " 7.394");
    let output = alewife(here, &["validate", "c.toml", "--out", "kept", "--threads", "1"]);
    assert_eq!(output.status.code(), Some(20));
    assert!(mark(RUN).is_file(), "only a reference has changed");
    case(here, "surface = 0.08 ", "surface = 0.079 ");
    // Nothing tells that these runs are those of a validation
    let output = alewife(here, &["validate", "c.toml", "--out", "kept", "--threads", "1"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("holds a finished run"));
    case(here, "", "");
    done(here, &["validate", "c.toml", "--out", "kept", "--report=page.md", "--threads", "1"]);
    case(here, "surface = 0.08 ", "surface = 0.079 ");
    assert!(!is_kept(&[]).0, "the case has changed");
    assert!(is_kept(&[]).0);

    let provenance = here.join(RUN).join("provenance.json");
    let text = std::fs::read_to_string(&provenance).unwrap();
    let executable = read(&provenance)["executable"].as_str().unwrap().to_owned();
    std::fs::write(&provenance, text.replace(&executable, "crc32:00000000")).unwrap();
    assert!(is_kept(&["--any-program"]).0);
    assert!(!is_kept(&[]).0, "another program made it");
}

/// However few rows its case asks for.
#[test]
fn a_run_that_is_kept_has_all_steps_and_is_taken_again() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let reference = "
[[reference]]
quantity = 'disc.velocity.y'
statistic = 'min'
value = -0.7
absolute = 1.0
kind = 'regression'
date = '2026-11-25'
source = 'none'
uncertainty = 0.1
";
    let time =
        "[time.unsteady]\nstep = 0.02\nend = 0.2\n[mesh]\nsize = 0.4\n[output]\nseries = 'end'\n";
    let text = format!("{FLUID}{DISC}{time}{reference}");
    std::fs::write(here.join("c.toml"), text).unwrap();
    let in_memory = validated(here, &[]);
    let kept = validated(here, &["--out", "kept"]);
    std::fs::write(here.join("kept/c/STOP"), "").unwrap();
    let again = validated(here, &["--out", "kept"]);
    assert!(here.join("kept/c/STOP").is_file());
    for one in [&kept, &again, &validated(here, &["--from", "kept"])] {
        assert_eq!(one["comparisons"][0]["computed"], in_memory["comparisons"][0]["computed"]);
    }
    // What `run` leaves has one row
    done(here, &["run", "c.toml", "--out", "runs/c", "--quiet", "--threads", "1"]);
    let output = alewife(here, &["validate", "c.toml", "--from", "runs", "--threads", "1"]);
    assert_eq!(output.status.code(), Some(65));
    assert!(String::from_utf8_lossy(&output.stderr).contains("does not have every step"));
}

#[test]
fn a_companion_that_cannot_be_is_told_and_the_value_stays() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let mesh = concat!(env!("CARGO_MANIFEST_DIR"), "/../mesh/tests/msh/data/square-1-text.msh");
    std::fs::copy(mesh, here.join("a.msh")).unwrap();
    std::fs::write(here.join("c.toml"), GIVEN_MESH).unwrap();
    let json = validated(here, &["--uncertainty", "--report=page.md"]);
    assert!(json["comparisons"][0]["numerical_uncertainty"].is_null());
    assert_eq!(json["comparisons"][0]["verdict"], "within");
    let page = std::fs::read_to_string(here.join("page.md")).unwrap();
    assert!(page.contains("| none: a mesh file gives its sides, which a companion would share |"));
    assert_eq!(json["comparisons"][0]["evidence"], "confirmed");
    assert!(page.contains("**t.** A channel.\n"), "{page}");
    assert!(page.contains("|  | a.pressure | 8 | - | 8 | - | exact | "), "{page}");
}

/// How many values that are known exactly differ from them by no more than their uncertainty, and of how many.
fn covered(arguments: &[&str]) -> [usize; 2] {
    let directory = tempfile::tempdir().unwrap();
    let all = [&["validate", "--json", "--uncertainty", "--threads", "1"], arguments].concat();
    let json: Value = serde_json::from_str(&done(directory.path(), &all)).unwrap();
    let rows = json["comparisons"].as_array().unwrap();
    let number = |row: &Value, key: &str| row[key].as_f64();
    let exact: Vec<[f64; 2]> = rows
        .iter()
        .filter(|row| row["kind"] == "exact")
        .filter_map(|row| Some([number(row, "difference")?, number(row, "numerical_uncertainty")?]))
        .collect();
    let told = |word: &str| rows.iter().filter(|row| row["evidence"] == word).count();
    assert_eq!(json["evidence"]["confirmed"], told("confirmed"));
    assert_eq!(json["evidence"]["consistent"], told("consistent"));
    [exact.iter().filter(|[difference, own]| difference.abs() <= *own).count(), exact.len()]
}

#[test]
fn exact_values_are_within_the_uncertainty() {
    let [n, of] = covered(&["sphere-in-shell", "disc-in-shell"]);
    assert!(of >= 15 && n == of, "{n} of {of}");
}

#[test]
#[ignore = "long: minutes; small: exact_values_are_within_the_uncertainty"]
fn nineteen_of_twenty_exact_values_are_within_the_uncertainty() {
    let [n, of] = covered(&["--quick"]);
    assert!(of > 150 && 20 * n >= 19 * of, "{n} of {of}");
}

#[test]
fn a_page_takes_what_runs_there_are_and_no_other_file() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    case(here, "", "");
    std::fs::copy(here.join("c.toml"), here.join("d.toml")).unwrap();
    validated(here, &["--out", "kept"]);
    let both = ["validate", "c.toml", "d.toml", "--from", "kept", "--threads", "1"];
    let output = alewife(here, &[&both[..], &["--report=page.md"]].concat());
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{told}");
    assert!(told.contains("d: its section stays as it is"), "{told}");
    let page = std::fs::read_to_string(here.join("page.md")).unwrap();
    assert!(page.contains("\n## c\n") && !page.contains("\n## d\n"), "{page}");
    assert_eq!(alewife(here, &both).status.code(), Some(66));

    std::fs::write(here.join("thesis.md"), "# Thesis\n").unwrap();
    for (option, code, reason) in [
        ("--report=thesis.md", 2, "thesis.md: it does not begin as the page of a validation"),
        ("--report=absent/page.md", 66, "there is no such directory"),
        ("--report", 66, "there is no docs/validation.md here or above; write --report=FILE"),
    ] {
        let output = alewife(here, &[&both[..], &[option]].concat());
        let told = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{option}: {told}");
        assert!(told.contains(reason), "{option}: {told}");
    }
    assert_eq!(std::fs::read_to_string(here.join("thesis.md")).unwrap(), "# Thesis\n");
    // That of the project is found from below
    std::fs::create_dir_all(here.join("docs/deep")).unwrap();
    std::fs::copy(here.join("page.md"), here.join("docs/validation.md")).unwrap();
    let kept = here.join("kept").display().to_string();
    let deep = here.join("docs/deep");
    std::fs::copy(here.join("c.toml"), deep.join("c.toml")).unwrap();
    done(&deep, &["validate", "c.toml", "--from", &kept, "--uncertainty", "--report"]);
    let page = std::fs::read_to_string(here.join("docs/validation.md")).unwrap();
    assert!(page.contains(" | none: not run |\n"), "{page}");
    assert!(!page.contains(&kept), "{page}");
}
