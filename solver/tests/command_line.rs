//! The program does what it says: lists, shows, meshes, runs and validates the shipped example.
#![expect(clippy::unwrap_used, reason = "a test that cannot write its files has failed")]

use std::path::Path;
use std::process::{Command, Output};

fn alewife(directory: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_alewife"))
        .args(arguments)
        .current_dir(directory)
        .output()
        .unwrap()
}

#[track_caller]
fn done(directory: &Path, arguments: &[&str]) -> String {
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
    let rows: serde_json::Value = serde_json::from_str(&json).unwrap();
    let keys = [
        "case",
        "quantity",
        "computed",
        "published",
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

    // The same with a wrong published value.
    let text = done(directory.path(), &["show", "squirmer-alone", "--source"]);
    let wrong = text.replace("value = 0.997524975", "value = 1.05");
    std::fs::write(directory.path().join("wrong.toml"), wrong).unwrap();
    let output = alewife(directory.path(), &["validate", "wrong.toml", "--threads", "1"]);
    assert_eq!(output.status.code(), Some(20));
    assert!(String::from_utf8_lossy(&output.stdout).contains("OUTSIDE"));
}

#[test]
fn a_mesh_is_written_with_its_quality() {
    let directory = tempfile::tempdir().unwrap();
    let said = done(directory.path(), &["mesh", "squirmer-alone", "--out", "m.vtu"]);
    assert!(said.contains("smallest angle"), "{said}");
    assert!(directory.path().join("m.vtu").metadata().unwrap().len() > 1000);
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
fn completions_are_printed_and_colours_are_not() {
    let directory = tempfile::tempdir().unwrap();
    assert!(done(directory.path(), &["completions", "bash"]).contains("validate"));
    assert!(!done(directory.path(), &["show", "squirmer-alone"]).contains('\x1b'));
}

/// A run of a falling sphere far too long to end by itself, stopped in `fall` once it has written rows;
/// what it says.
#[cfg(unix)]
fn stopped_fall(directory: &Path) -> String {
    let mut run = Command::new(env!("CARGO_BIN_EXE_alewife"))
        .args(["run", "sphere-free-fall", "--out", "fall", "--quiet", "--threads", "1"])
        .args(["--set", "time.unsteady.end=1e6", "--set", "mesh.scale=2"])
        .current_dir(directory)
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let has_begun = || {
        std::fs::read_to_string(directory.join("fall/series.csv"))
            .is_ok_and(|text| text.lines().count() > 2)
    };
    while !has_begun() {
        assert!(run.try_wait().unwrap().is_none(), "the run ended by itself");
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    let killed = Command::new("kill").args(["-INT", &run.id().to_string()]).status().unwrap();
    assert!(killed.success());
    let output = run.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(75));
    String::from_utf8(output.stderr).unwrap()
}

#[cfg(unix)]
#[test]
fn a_signal_ends_a_run_after_its_step_with_all_files_complete() {
    let directory = tempfile::tempdir().unwrap();
    let told = stopped_fall(directory.path());
    let command = "alewife run sphere-free-fall --out fall --quiet --threads 1 --set \
                   time.unsteady.end=1e6 --set mesh.scale=2 --resume fall/state.json";
    assert!(told.contains(command), "{told}");
    let out = directory.path().join("fall");
    let status = std::fs::read_to_string(out.join("status.json")).unwrap();
    assert!(status.contains("\"stopped\""), "{status}");
    assert!(out.join("fields/stopped.vtu").is_file());
    let series = std::fs::read_to_string(out.join("series.csv")).unwrap();
    assert!(series.ends_with('\n') && series.lines().count() > 1);
}

#[cfg(unix)]
#[test]
fn a_run_that_resumes_in_its_directory_goes_on_with_its_series() {
    let directory = tempfile::tempdir().unwrap();
    stopped_fall(directory.path());
    let read = |file: &str| std::fs::read_to_string(directory.path().join(file)).unwrap();
    let before = read("fall/series.csv");
    let time = |line: &str| -> f64 { line.split(',').next().unwrap().parse().unwrap() };
    let times: Vec<f64> = before.lines().skip(1).map(time).collect();
    let end = format!("time.unsteady.end={}", times[times.len() - 1] + 3.0 * (times[2] - times[1]));
    let arguments = |out: &'static str| {
        let mut all = vec!["run", "sphere-free-fall", "--out", out, "--quiet", "--threads", "1"];
        all.extend(["--set", "mesh.scale=2", "--set", "reference=[]", "--set", "variant=[]"]);
        all
    };
    let with = |mut all: Vec<&'static str>, more: &[&str]| {
        let more = more.iter().map(|word| (*word).to_owned());
        let all: Vec<String> = all.drain(..).map(str::to_owned).chain(more).collect();
        alewife(directory.path(), &all.iter().map(String::as_str).collect::<Vec<_>>())
    };
    // The state is not lost by a run that was meant to resume
    let refused = with(arguments("fall"), &["--set", &end]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("--resume fall/state.json"));
    assert_eq!(read("fall/series.csv"), before);

    let resumed = with(arguments("fall"), &["--set", &end, "--resume", "fall/state.json"]);
    assert_eq!(resumed.status.code(), Some(0), "{}", String::from_utf8_lossy(&resumed.stderr));
    let whole = with(arguments("whole"), &["--set", &end]);
    assert_eq!(whole.status.code(), Some(0), "{}", String::from_utf8_lossy(&whole.stderr));
    let (resumed, whole) = (read("fall/series.csv"), read("whole/series.csv"));
    assert!(resumed.starts_with(&before) && resumed.len() > before.len());
    assert_eq!(resumed.lines().count(), whole.lines().count());
    let speed = |line: &str| -> f64 { line.split(',').nth(4).unwrap().parse().unwrap_or(f64::NAN) };
    for (one, other) in resumed.lines().zip(whole.lines()).skip(1) {
        assert_eq!(time(one), time(other));
        assert!((speed(one) - speed(other)).abs() <= 1e-9 * speed(other).abs(), "{one}\n{other}");
    }
    assert!(!directory.path().join("fall/state.json").exists());
    assert!(!read("fall/fields.pvd").contains("stopped"));
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

/// Three links above a wall, their joints bent in quadrature, at steps of a size.
const THREE_LINKS: &str = r#"
title = "three links above a wall"
geometry = "planar"
fluid = { model = "stokes", viscosity = 1.0 }
domain.box = { min = [-4.0, 0.0], max = [4.0, 4.0] }
boundary = { left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }
mesh = { size = 1.5, surface = 0.2, growth = 0.5, gap_layers = 1 }
time.unsteady = { step = 0.05, end = 1.0 }
[[swimmer]]
name = "links"
center = [0.0, 1.0]
[swimmer.kind.chain]
links = [[0.5, 0.12], [0.5, 0.12], [0.5, 0.12]]
gap = 0.3
joints = [
    { bent = { angle = { sine = { amplitude = 0.7, period = 1.0 } } } },
    { bent = { angle = { sine = { amplitude = 0.7, period = 1.0, phase = 1.5707963 } } } },
]
"#;

#[test]
fn a_run_warns_of_the_error_of_a_stroke() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("links.toml"), THREE_LINKS).unwrap();
    let swim = |scheme: &str, steps: usize| -> ([f64; 2], Option<f64>) {
        let scheme = format!("time.unsteady.scheme={scheme}");
        let step = format!("time.unsteady.step={}", 1.0 / steps as f64);
        let replace = ["run", "links.toml", "--overwrite", "--threads", "1"];
        let output = alewife(
            directory.path(),
            &[&replace[..], &["--set", &scheme, "--set", &step]].concat(),
        );
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{told}");
        let series = std::fs::read_to_string(directory.path().join("runs/links/series.csv"));
        let series = series.unwrap();
        let row = |line: &str| line.split(',').map(str::to_owned).collect::<Vec<_>>();
        let (names, values) =
            (row(series.lines().next().unwrap()), row(series.lines().last().unwrap()));
        let value = |name: &str| -> f64 {
            let column = names.iter().position(|known| known == name).unwrap();
            values[column].parse().unwrap()
        };
        let percent = told.split("uncertain by about ").nth(1);
        let percent = percent.map(|rest| rest.split(' ').next().unwrap().parse().unwrap());
        (["links.cycle.x", "links.cycle.y"].map(value), percent)
    };
    let (exact, none) = swim("rk3", 40);
    assert_eq!(none, None);
    for (scheme, steps) in [("bdf2", 5), ("bdf2", 10), ("bdf2", 20)] {
        let ([x, y], percent) = swim(scheme, steps);
        let error = (x - exact[0]).hypot(y - exact[1]) / x.hypot(y);
        let percent = percent.expect("an error is warned of");
        println!("{scheme}, {steps} steps: {:.2} % off, {percent} % estimated", 100.0 * error);
        assert!(percent > 50.0 * error && percent < 200.0 * error, "{steps}: {error}, {percent} %");
    }
    assert_eq!(swim("rk3", 10).1, None);
}
