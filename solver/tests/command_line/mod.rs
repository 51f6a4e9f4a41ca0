//! The program does what it says: lists, shows, meshes, runs and validates the shipped example.
#![expect(clippy::unwrap_used, reason = "a test that cannot write its files has failed")]

mod commands;
mod continuing;
mod costs;
mod faults;
mod kills;
mod live;
mod plotting;
mod shell;
mod skin;
mod stopping;
mod surfaces;
mod sweeps;
mod validating;
mod verifying;
mod warnings;

use std::path::Path;
use std::process::{Command, Output};

/// A box of fluid in which things sink, for runs that are disturbed, stopped and killed.
const FLUID: &str = "
title = 'disturbed'
geometry = 'planar'
fluid = { model = 'navier-stokes', density = 1.0, viscosity = 0.1, gravity = [0.0, -10.0] }
domain.box = { min = [-1.0, -1.0], max = [1.0, 1.0] }
boundary = { left = 'no-slip', right = 'no-slip', bottom = 'no-slip', top = 'no-slip' }
";
/// A disc that sinks in it.
const DISC: &str = "
[[body]]
name = 'disc'
shape.disc.radius = 0.2
center = [0.1, 0.2]
density = 2.0
motion = 'free'
";

pub fn alewife(directory: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_alewife"))
        .args(arguments)
        .current_dir(directory)
        .output()
        .unwrap()
}

#[track_caller]
pub fn done(directory: &Path, arguments: &[&str]) -> String {
    let output = alewife(directory, arguments);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{stderr}");
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn every_shipped_case_and_variant_is_right() {
    let directory = tempfile::tempdir().unwrap();
    let list = done(directory.path(), &["list"]);
    assert!(list.contains("squirmer-alone"), "{list}");
    for shipped in alewife::case::library::list() {
        // The quick validation reads this one and runs it, which takes its mesh, as all that asks for its sides
        if shipped.name == "vessel-surface" {
            continue;
        }
        done(directory.path(), &["check", "--no-mesh", shipped.name]);
    }
}

#[test]
fn the_source_of_a_case_is_a_case() {
    let directory = tempfile::tempdir().unwrap();
    let text = done(directory.path(), &["show", "squirmer-alone", "--source"]);
    std::fs::write(directory.path().join("mine.toml"), text).unwrap();
    let said = done(directory.path(), &["check", "--no-mesh", "mine.toml"]);
    assert!(said.starts_with("mine  A squirmer alone"), "{said}");
}

#[test]
fn a_run_leaves_its_files_and_is_not_replaced_unasked() {
    let directory = tempfile::tempdir().unwrap();
    let run = |more: &[&str]| {
        let settings = ["run", "squirmer-alone", "--threads", "1", "--set", "mesh.scale=2"];
        let arguments: Vec<&str> = settings.iter().chain(more).copied().collect();
        alewife(directory.path(), &arguments)
    };
    let first = run(&[]);
    assert_eq!(first.status.code(), Some(0), "{}", String::from_utf8_lossy(&first.stderr));
    let said = String::from_utf8(first.stdout).unwrap();
    assert!(said.contains("squirmer.velocity.x") && said.contains("verdict"), "{said}");
    let out = directory.path().join("runs/squirmer-alone");
    for file in ["case.toml", "series.csv", "status.json", "comparison.json"] {
        assert!(out.join(file).is_file(), "no {file}");
    }
    // What is known before a run is what the run measures.
    let series = std::fs::read_to_string(out.join("series.csv")).unwrap();
    let columns: Vec<&str> = series.lines().next().unwrap().split(',').skip(1).collect();
    let model = alewife::case::Case::read("squirmer-alone", &[]).unwrap().model;
    assert_eq!(columns, alewife::case::known_quantities(&model));

    // The case as it was run is a case, and the same one.
    let again = done(directory.path(), &["check", "--no-mesh", "runs/squirmer-alone/case.toml"]);
    assert!(again.contains("squirmer: sphere of radius 1"), "{again}");

    let second = run(&[]);
    assert_eq!(second.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&second.stderr).contains("--overwrite"));
    assert_eq!(run(&["--overwrite", "--quiet"]).status.code(), Some(0));
}

#[test]
fn validation_judges_and_its_json_has_all_there_is_to_know() {
    let directory = tempfile::tempdir().unwrap();
    let json = done(directory.path(), &["validate", "squirmer-alone", "--json", "--threads", "1"]);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["counts"]["exact"]["values"], json["counts"]["exact"]["within"]);
    let rows = &json["comparisons"];
    let keys = [
        "case",
        "quantity",
        "computed",
        "reference",
        "kind",
        "tolerance",
        "source",
        "verdict",
        "dofs",
        "cpu_seconds",
    ];
    for key in keys {
        assert!(!rows[0][key].is_null(), "no {key} in {json}");
    }
    assert_eq!(rows[0]["verdict"], "within");

    // The same with a wrong reference.
    let text = done(directory.path(), &["show", "squirmer-alone", "--source"]);
    let wrong = text.replace("0.997524975", "1.05");
    std::fs::write(directory.path().join("wrong.toml"), wrong).unwrap();
    let output = alewife(directory.path(), &["validate", "wrong.toml", "--threads", "1"]);
    assert_eq!(output.status.code(), Some(20));
    assert!(String::from_utf8_lossy(&output.stdout).contains("OUTSIDE"));
}

#[test]
fn validation_checks_all_cases_and_variants_before_it_runs_one() {
    let directory = tempfile::tempdir().unwrap();
    let right = done(directory.path(), &["show", "squirmer-alone", "--source"]);
    let wrong = |n: usize| {
        let set = format!("[variant.set]\n\"fluid.viscosity\" = -{n}.0\n");
        format!("[[variant]]\nname = \"wrong-{n}\"\n{set}\n")
    };
    std::fs::write(directory.path().join("right.toml"), &right).unwrap();
    let mine = format!("{right}\n{}{}", wrong(1), wrong(2));
    std::fs::write(directory.path().join("mine.toml"), mine).unwrap();
    let asked = ["validate", "right.toml", "mine.toml", "absent", "--threads", "1"];
    let output = alewife(directory.path(), &asked);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(65), "{said}");
    for name in ["mine.toml/wrong-1", "mine.toml/wrong-2", "absent"] {
        assert!(said.contains(&format!("{name}:")), "{said}");
    }
    assert!(!said.contains("[1/") && output.stdout.is_empty(), "{said}");
}

#[test]
fn a_mesh_is_written_with_its_quality() {
    let directory = tempfile::tempdir().unwrap();
    let said = done(directory.path(), &["mesh", "squirmer-alone", "--out", "m.vtu"]);
    assert!(said.contains("smallest angle"), "{said}");
    assert!(directory.path().join("m.vtu").metadata().unwrap().len() > 1000);
    for (name, options, start) in [
        ("m.msh", &[][..], "$MeshFormat\n4.1 1 8\n"),
        ("t.msh", &["--text"][..], "$MeshFormat\n4.1 0 8\n"),
    ] {
        let arguments = [&["mesh", "squirmer-alone", "--out", name], options].concat();
        done(directory.path(), &arguments);
        let bytes = std::fs::read(directory.path().join(name)).unwrap();
        assert!(bytes.starts_with(start.as_bytes()), "{name}");
    }
    let output = alewife(directory.path(), &["mesh", "squirmer-alone", "--text"]);
    assert_eq!(output.status.code(), Some(2));
}

/// A run keeps the mesh it was made on; its own case file is enough to run it again.
/// A channel in the mesh of a file.
const GIVEN_MESH: &str = "title = 't'
description = 'A channel: water flows.'
geometry = 'planar'
fluid = { model = 'stokes', viscosity = 1.0 }
domain.mesh.file = 'a.msh'
boundary = { inlet = { parabolic = { peak = 1.0 } }, outlet = 'do-nothing', wall = 'no-slip' }
mesh.size = 0.5
time.steady = {}
[[probe]]
name = 'a'
point = [0.5, 0.5]
minus = [1.5, 0.5]
[[reference]]
quantity = 'a.pressure'
value = 8.0
relative = 1e-9
kind = 'exact'
source = 'Poiseuille flow'
";

#[test]
fn a_run_in_a_given_mesh_keeps_it() {
    let directory = tempfile::tempdir().unwrap();
    let meshes = concat!(env!("CARGO_MANIFEST_DIR"), "/../mesh/tests/msh/data");
    std::fs::copy(format!("{meshes}/square-1-text.msh"), directory.path().join("a.msh")).unwrap();
    std::fs::write(directory.path().join("c.toml"), GIVEN_MESH).unwrap();
    let said = done(directory.path(), &["check", "c.toml"]);
    assert!(said.contains("mesh of") && said.contains("in a.msh, of area 2"), "{said}");
    let said = done(directory.path(), &["run", "c.toml", "--out", "r/c"]);
    assert!(said.contains("within"), "{said}");
    let said = done(directory.path(), &["validate", "c.toml", "--from", "r"]);
    assert!(said.contains("within"), "{said}");
    std::fs::remove_file(directory.path().join("a.msh")).unwrap();
    let said = done(directory.path(), &["run", "r/c/case.toml", "--out", "s"]);
    assert!(said.contains("within"), "{said}");
    let kept = |run: &str| std::fs::read(directory.path().join(run).join("domain.msh")).unwrap();
    assert!(kept("r/c") == kept("s"));
}

#[test]
fn the_schema_knows_every_key_of_the_shipped_cases() {
    let directory = tempfile::tempdir().unwrap();
    let schema: serde_json::Value =
        serde_json::from_str(&done(directory.path(), &["schema"])).unwrap();
    for shipped in alewife::case::library::list() {
        let case: toml::Table = shipped.text.parse().unwrap();
        for key in case.keys() {
            assert!(schema["properties"][key].is_object(), "{}: {key}", shipped.name);
        }
    }
    let described = schema["$defs"]["Fluid"]["properties"]["viscosity"]["description"].as_str();
    assert!(described.unwrap().contains("Pa s"));
}

#[test]
fn colours_are_for_terminals() {
    let directory = tempfile::tempdir().unwrap();
    assert!(!done(directory.path(), &["show", "squirmer-alone"]).contains('\x1b'));
}

#[test]
fn files_of_others_are_never_replaced() {
    let directory = tempfile::tempdir().unwrap();
    let text = done(directory.path(), &["show", "squirmer-alone", "--source"]);
    std::fs::write(directory.path().join("case.toml"), &text).unwrap();
    let refused = alewife(directory.path(), &["run", "case.toml", "--out", ".", "--overwrite"]);
    assert_eq!(refused.status.code(), Some(2));
    let case = || std::fs::read_to_string(directory.path().join("case.toml")).unwrap();
    assert_eq!(case(), text);
    let own = ["run", "squirmer-alone", "--out", "own", "--set", "mesh.scale=2", "--quiet"];
    done(directory.path(), &own);
    let of_run = ["run", "own/case.toml", "--out", "own", "--overwrite"];
    let refused = alewife(directory.path(), &of_run);
    assert_eq!(refused.status.code(), Some(2));
    let told = String::from_utf8_lossy(&refused.stderr);
    assert!(told.contains("own/case.toml lies in own"), "{told}");
}

/// The free unknowns `check` tells are those of the run, be the domain closed, periodic or cut.
#[test]
fn check_counts_the_unknowns_of_the_run() {
    let directory = tempfile::tempdir().unwrap();
    let number_before = |text: &str, word: &str| -> usize {
        let before = text.split(word).next().unwrap().trim_end();
        let digits = before.rsplit(|c: char| !c.is_ascii_digit()).next().unwrap();
        digits.parse().unwrap()
    };
    for case in ["squirmer-alone", "neutral-squirmer-2d", "lid-driven-cavity"] {
        let coarse = ["--set", "mesh.scale=2"];
        let checked = done(directory.path(), &[&["check", case], &coarse[..]].concat());
        let arguments = [&["run", case, "--threads", "1", "--quiet"], &coarse[..]].concat();
        let run = alewife(directory.path(), &arguments);
        let ran = String::from_utf8(run.stdout).unwrap();
        let counted = number_before(&checked, " free ones");
        assert_eq!(counted, number_before(&ran, " unknowns, "), "{case}: {ran}");
    }
}

#[test]
fn the_references_of_variants_are_shown() {
    let directory = tempfile::tempdir().unwrap();
    let said = done(directory.path(), &["show", "squirmer-wall"]);
    let (_, after) = said.split_once("squirmer-wall/pusher").unwrap();
    assert!(after.contains("flow.energy_defect = 0") && after.contains("property:"), "{said}");
}

#[test]
fn a_case_without_references_is_no_validation() {
    let directory = tempfile::tempdir().unwrap();
    let source = done(directory.path(), &["show", "squirmer-alone", "--source"]);
    let (without, _) = source.split_once("[references]").unwrap();
    std::fs::write(directory.path().join("mine.toml"), without).unwrap();
    let output = alewife(directory.path(), &["validate", "mine.toml"]);
    assert_eq!(output.status.code(), Some(65));
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(told.contains("no reference to compare with"), "{told}");
}
