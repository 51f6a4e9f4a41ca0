//! `verify`: a run or a sweep as it was left is sound, and whatever is damaged in it is named.

use std::fs;
use std::path::Path;

use serde_json::Value;

use super::{alewife, done};

/// A run with everything: inertia, a body, states and fields.
const CASE: &str = "
title = 't'
geometry = 'planar'
fluid = { model = 'navier-stokes', density = 1.0, viscosity = 1.0 }
domain.box = { min = [-2.0, -2.0], max = [2.0, 2.0] }
boundary = { left = 'no-slip', right = 'no-slip', top = 'no-slip', bottom = 'no-slip' }
mesh = { size = 1.0, surface = 0.3, growth = 0.8 }
time.unsteady = { step = 0.1, end = 0.6 }
output = { fields = { steps = 3 }, checkpoint = { wall = '10 min', time = 0.3 } }
[[body]]
name = 'a'
shape.disc.radius = 0.5
center = [0.0, 0.0]
density = 2.0
motion = 'free'
force = [1.0, 0.0]
";

fn start() -> tempfile::TempDir {
    let place = tempfile::tempdir().unwrap();
    fs::write(place.path().join("c.toml"), CASE).unwrap();
    place
}

/// What is wrong in `r`: files with their problems.
fn problems(directory: &Path, of: &str) -> Vec<[String; 2]> {
    let output = alewife(directory, &["verify", of, "--json"]);
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    let json: Value = serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{told}"));
    let text = |value: &Value| value.as_str().unwrap().to_owned();
    let problems = json[0]["problems"].as_array().unwrap();
    let code = if problems.is_empty() { 0 } else { 65 };
    assert_eq!((output.status.code(), &json[0]["sound"]), (Some(code), &(code == 0).into()));
    problems.iter().map(|one| [text(&one["file"]), text(&one["problem"])]).collect()
}

#[test]
fn damage_in_any_file_of_a_run_is_named() {
    let place = start();
    let run = ["run", "c.toml", "--out", "r", "-q", "-t", "1"];
    done(place.path(), &run);
    let said = done(place.path(), &["verify", "r"]);
    assert!(said.contains("r: sound; finished; rows: 7, states: 2, fields: 3"), "{said}");
    let r = place.path().join("r");
    let replaced = |file: &str, from: &str, to: &str| {
        let text = fs::read_to_string(r.join(file)).unwrap();
        assert!(text.contains(from), "{from} in {file}");
        text.replacen(from, to, 1).into_bytes()
    };
    let cut = |file: &str| {
        let bytes = fs::read(r.join(file)).unwrap();
        bytes[..bytes.len() / 2].to_vec()
    };
    let flipped = |file: &str| {
        let mut bytes = fs::read(r.join(file)).unwrap();
        let middle = bytes.len() / 2;
        bytes[middle] ^= 1;
        bytes
    };
    let series = fs::read_to_string(r.join("series.csv")).unwrap();
    let lines: Vec<&str> = series.lines().collect();
    let without = |nth: usize| {
        let kept = lines.iter().enumerate().filter(|(index, _)| *index != nth);
        (kept.map(|(_, line)| format!("{line}\n")).collect::<String>()).into_bytes()
    };
    let twice = format!("{series}{}\n", lines[7]).into_bytes();
    for (file, damage, named, said) in [
        (
            "case.toml",
            replaced("case.toml", "0.5", "0.51"),
            "case.toml",
            "the latest leg ran a case of",
        ),
        ("case.toml", cut("case.toml"), "case.toml", ""),
        ("status.json", Vec::new(), "status.json", "EOF"),
        (
            "status.json",
            replaced("status.json", "\"step\": 6", "\"step\": 5"),
            "series.csv",
            "7 rows, and 5 steps",
        ),
        (
            "provenance.json",
            replaced("provenance.json", "\"end\": \"finished\"", "\"end\": null"),
            "provenance.json",
            "has not ended as finished",
        ),
        ("series.csv", without(3), "series.csv", "6 rows, and 6 steps"),
        ("series.csv", twice, "series.csv", "does not come after"),
        ("series.csv", cut("series.csv"), "series.csv", ""),
        (
            "series.csv",
            replaced("series.csv", "\n0.1,", "\n0.1,1"),
            "series.csv",
            "line 3 has other values than in checkpoints/",
        ),
        (
            "checkpoints/000006.state",
            flipped("checkpoints/000006.state"),
            "checkpoints/000006.state",
            "damaged",
        ),
        (
            "checkpoints/000003.state",
            fs::read(r.join("checkpoints/000006.state")).unwrap(),
            "checkpoints/000003.state",
            "it is of step 6",
        ),
        ("fields/000003.vtu", cut("fields/000003.vtu"), "fields/000003.vtu", "it is not whole"),
        (
            "fields/000004.vtu",
            fs::read(r.join("fields/000003.vtu")).unwrap(),
            "fields/000004.vtu",
            "not in fields.pvd",
        ),
        (
            "fields.pvd",
            replaced("fields.pvd", "000003", "000009"),
            "fields/000009.vtu",
            "it is missing",
        ),
        ("run.mcap", flipped("run.mcap"), "run.mcap", ""),
        ("log.jsonl", b"{\n".to_vec(), "log.jsonl", "line 1 is no JSON"),
    ] {
        let before = fs::read(r.join(file)).ok();
        fs::write(r.join(file), damage).unwrap();
        let found = problems(place.path(), "r");
        let is_named = found.iter().any(|[one, what]| one == named && what.contains(said));
        assert!(is_named, "{file}, {said}: {found:?}");
        match before {
            Some(before) => fs::write(r.join(file), before).unwrap(),
            None => fs::remove_file(r.join(file)).unwrap(),
        }
        assert!(problems(place.path(), "r").is_empty(), "{file} is as before");
    }
    fs::remove_file(r.join("series.csv")).unwrap();
    assert_eq!(problems(place.path(), "r")[0], ["series.csv", "it is missing"]);
    let none = alewife(place.path(), &["verify", "."]);
    assert_eq!(none.status.code(), Some(66));
}

#[test]
fn sound_are_runs_of_all_kinds_and_sweeps_and_not_those_whose_points_were_exchanged() {
    let place = start();
    let run = ["run", "c.toml", "-q", "-t", "1", "--out"];
    for (out, settings) in [
        (
            "steady",
            &[
                "time={ steady = {} }",
                "fluid={ model = 'stokes', viscosity = 1.0 }",
                "body.0.motion='held'",
            ][..],
        ),
        ("adaptive", &["time.unsteady={ step = 0.1, end = 0.5, adaptive = {} }"]),
        ("seldom", &["output.series={ time = 0.2 }", "output.fields='never'"]),
        ("never", &["output.series='never'", "output.checkpoint.keep=0"]),
    ] {
        let settings = settings.iter().flat_map(|one| ["--set", one]);
        let arguments: Vec<&str> = run.into_iter().chain([out]).chain(settings).collect();
        done(place.path(), &arguments);
        assert_eq!(problems(place.path(), out), [[""; 2]; 0], "{out}");
    }
    // A run in two legs
    let two: Vec<&str> = run.into_iter().chain(["seldom", "--continue"]).collect();
    let later = [
        "--set",
        "output.series={ time = 0.2 }",
        "--set",
        "output.fields='never'",
        "--set",
        "time.unsteady.end=0.8",
    ];
    done(place.path(), &[&two[..], &later].concat());
    assert_eq!(problems(place.path(), "seldom"), [[""; 2]; 0]);

    let sweep = ["sweep", "run", "c.toml", "-q", "--out", "s", "--set", "fluid.viscosity=1,2,3"];
    done(place.path(), &sweep);
    let said = done(place.path(), &["verify", "s", "seldom"]);
    assert!(said.contains("s: sound; 3 finished; points: 3\nseldom: sound"), "{said}");
    let points = place.path().join("s/points");
    fs::write(points.join("0002/series.csv"), "time,a\n").unwrap();
    let found = problems(place.path(), "s");
    assert!(found.iter().any(|[file, _]| file == "points/0002/series.csv"), "{found:?}");
    fs::rename(points.join("0001"), points.join("x")).unwrap();
    fs::rename(points.join("0003"), points.join("0001")).unwrap();
    fs::rename(points.join("x"), points.join("0003")).unwrap();
    let found = problems(place.path(), "s");
    let misplaced = found.iter().filter(|[_, what]| what.contains("the run of another case"));
    assert_eq!(misplaced.count(), 2, "{found:?}");
}
