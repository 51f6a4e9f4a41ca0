//! Soft cases from the command line: what is run, found and refused, and what is written.
#![expect(clippy::unwrap_used, reason = "a test that cannot write its files has failed")]

mod everywhere;

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// A bar in the plane with fibres along one side.
pub(crate) const BAR: &str = r#"
title = "a bar"
geometry = "planar"
[[solid]]
name = "bar"
order = "linear"
grid = { from = [0.0, -0.06], to = [0.012, 0.06], cells = [2, 12] }
material = { law = "neo-hookean", young = 4e4, poisson = 0.3, density = 1000.0 }
[[solid.fibre]]
name = "below"
region = { from = [-inf, -0.06], to = [0.006, 0.06] }
direction = [0.0, 1.0]
stiffness = 1e5
stretch.wave = { mean = 0.95, amplitude = 0.04, frequency = 3.0 }
[[solid.hold]]
region = { from = [-inf, -0.011], to = [inf, 0.011] }
axes = ["y"]
[soft]
frame = 0.04
frames = 8
[loads]
density = 1000.0
drag.bezier = [0.05, 0.05, 1.85, 2.05]
thrust.bezier = [-0.8, -0.5, 0.1, 2.5]
[[marker]]
name = "tip"
at = [0.0, 0.06]
[optimisation.objective.travel]
direction = [1.0, 0.0]
[[optimisation.parameter]]
name = "amplitude"
keys = ["solid.0.fibre.0.stretch.wave.amplitude"]
bounds = [0.001, 0.045]
scale = 0.01
[optimisation.search]
evaluations = 5
[[reference]]
quantity = "time"
value = 0.32
relative = 1e-9
kind = "exact"
source = "eight frames"
"#;

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

fn refused(directory: &Path, arguments: &[&str], code: i32) -> String {
    let output = alewife(directory, arguments);
    assert_eq!(output.status.code(), Some(code));
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn a_soft_case_is_checked_and_run_and_what_is_written_runs_with_the_same_bits() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    fs::write(at.join("bar.toml"), BAR).unwrap();
    assert!(done(at, &["check", "bar.toml"]).contains("48 cells"));
    // The only model there is
    let said = done(at, &["run", "bar.toml", "--out", "r"]);
    assert!(said.starts_with("a case without a flow: --fidelity soft"), "{said}");
    assert!(said.contains("within   time"), "{said}");
    done(at, &["run", "r/case.toml", "--fidelity", "soft", "--out", "s"]);
    for file in ["series.csv", "fields/frame-0008.vtu", "fields.pvd", "case.toml"] {
        assert_eq!(
            fs::read(at.join("r").join(file)).unwrap(),
            fs::read(at.join("s").join(file)).unwrap()
        );
    }
    let said = done(at, &["validate", "bar.toml"]);
    assert!(said.contains("time") && said.contains("1 of 1 values"), "{said}");
    let again = refused(at, &["run", "bar.toml", "--fidelity", "soft", "--out", "r"], 2);
    assert!(again.contains("--overwrite"), "{again}");
    done(at, &["run", "bar.toml", "--fidelity", "soft", "--out", "r", "--overwrite"]);
    // A case of somebody is not replaced
    fs::create_dir(at.join("mine")).unwrap();
    fs::write(at.join("mine/case.toml"), BAR).unwrap();
    let mine = ["run", "mine", "--fidelity", "soft", "--out", "mine", "--overwrite"];
    assert!(refused(at, &mine, 2).contains("not of such a command"));
    assert_eq!(fs::read_to_string(at.join("mine/case.toml")).unwrap(), BAR);
}

#[test]
fn an_optimum_is_found_and_runs_and_a_search_called_again_is_the_same() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    fs::write(at.join("bar.toml"), BAR).unwrap();
    let said = done(at, &["optimise", "bar.toml", "--out", "o", "--quiet"]);
    assert!(said.contains("optimisation after"), "{said}");
    done(at, &["run", "o/case.toml", "--fidelity", "soft", "--out", "r"]);
    let report = fs::read(at.join("o/report.json")).unwrap();
    let journal = fs::read_to_string(at.join("o/search.journal")).unwrap();
    let kept: Vec<&str> = journal.lines().take(3).collect();
    fs::create_dir(at.join("p")).unwrap();
    fs::write(at.join("p/search.journal"), kept.join("\n") + "\n1.0 2.").unwrap();
    let told = done(at, &["status", "p"]);
    assert!(told.contains("p: stopped, optimisation, 2 evaluations, the best there "), "{told}");
    assert!(done(at, &["verify", "p"]).contains("p: sound; stopped; journals: 1, evaluations: 2"));
    done(at, &["optimise", "bar.toml", "--out", "p", "--quiet"]);
    assert!(done(at, &["status", "p"]).contains("p: finished, optimisation, "));
    assert!(done(at, &["verify", "p"]).contains("p: sound; finished"));
    assert_eq!(fs::read(at.join("p/report.json")).unwrap(), report);
    assert_eq!(fs::read_to_string(at.join("p/search.journal")).unwrap(), journal);
    let other = ["optimise", "bar.toml", "--set", "soft.frames=7", "--out", "q", "--quiet"];
    fs::create_dir(at.join("q")).unwrap();
    fs::write(at.join("q/search.journal"), &journal).unwrap();
    assert!(refused(at, &other, 2).contains("journal of another search"));
    // A case with another number than was found
    let case = fs::read_to_string(at.join("p/case.toml")).unwrap();
    let other = case
        .lines()
        .map(|line| if line.starts_with("amplitude = ") { "amplitude = 0.03" } else { line });
    fs::write(at.join("p/case.toml"), other.collect::<Vec<_>>().join("\n")).unwrap();
    let verified = || String::from_utf8(alewife(at, &["verify", "p"]).stdout).unwrap();
    let said = verified();
    assert!(said.contains("case.toml: `amplitude` is 0.03, and that of the best"), "{said}");
    // And one that was not sought
    let frames = case.lines().find(|line| line.starts_with("frames = ")).unwrap();
    fs::write(at.join("p/case.toml"), case.replace(frames, "frames = 9")).unwrap();
    let said = verified();
    assert!(said.contains("case.toml: it is not as the search has written it"), "{said}");
    fs::write(at.join("p/case.toml"), case).unwrap();
    // A journal whose best evaluation went is not that of the report
    let end = journal.lines().min_by(|a, b| objective(a).total_cmp(&objective(b))).unwrap();
    fs::write(at.join("p/search.journal"), journal.replace(&format!("{end}\n"), "")).unwrap();
    let output = alewife(at, &["verify", "p"]);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(output.status.code(), Some(65), "{said}");
    assert!(said.contains("report.json: it has") && said.contains("`amplitude` is not"), "{said}");
}

/// The objective of a line of a journal; that of its first line is larger than all.
fn objective(line: &str) -> f64 {
    line.split(' ').next().and_then(|word| word.parse().ok()).unwrap_or(f64::INFINITY)
}

#[test]
fn one_process_searches_in_a_directory_and_the_lock_of_a_dead_one_is_taken_over() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    fs::write(at.join("bar.toml"), BAR).unwrap();
    fs::create_dir(at.join("o")).unwrap();
    // What a process has left that was killed
    let host = fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default();
    fs::write(at.join("o/lock"), format!("process 999999999 on {}\n", host.trim())).unwrap();
    // As a search holds it, by the lock of the system
    let lock = fs::File::options().read(true).write(true).open(at.join("o/lock")).unwrap();
    lock.lock().unwrap();
    for command in [
        &["optimise", "bar.toml", "--out", "o"][..],
        &["run", "bar.toml", "--fidelity", "soft", "--out", "o"],
    ] {
        let said = refused(at, command, 74);
        assert!(said.contains("process 999999999") && said.contains("--out"), "{said}");
    }
    assert!(!at.join("o/search.journal").exists());
    drop(lock);
    done(at, &["optimise", "bar.toml", "--out", "o", "--quiet"]);
    assert!(!at.join("o/lock").exists(), "it goes with its process");
}

#[test]
fn soft_cases_and_flows_are_not_taken_for_each_other() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    fs::write(at.join("bar.toml"), BAR).unwrap();
    let flow = ["run", "bar.toml", "--fidelity", "ale"];
    assert!(refused(at, &flow, 65).contains("--fidelity soft"));
    assert!(refused(at, &["run", "dfg-2d-1", "--fidelity", "soft"], 65).contains("[soft]"));
    assert!(
        refused(at, &["run", "bar.toml", "--fidelity", "soft", "--live"], 2).contains("--live")
    );
    assert!(refused(at, &["calibrate", "bar.toml"], 65).contains("[calibration]"));
    let set = "solid.0.material.poisson=0.7";
    let wrong = refused(at, &["check", "bar.toml", "--set", set], 65);
    assert!(wrong.contains("0.5 at most") && wrong.contains("--set"), "{wrong}");
    fs::write(at.join("bad.toml"), BAR.replace("1.85, 2.05]", "1.85]")).unwrap();
    let wrong = refused(at, &["run", "bad.toml", "--fidelity", "soft"], 65);
    assert!(wrong.contains("bad.toml:23") && wrong.contains("has four"), "{wrong}");
}

/// The data of a shipped case that does not come with the program is brought to where this is called.
#[test]
fn data_that_is_elsewhere_is_asked_for_and_left_out_of_a_validation() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    fs::write(at.join("bar.toml"), BAR).unwrap();
    assert!(done(at, &["list"]).contains("starfish  "));
    assert!(done(at, &["show", "starfish"]).contains("needs starfish.msh"));
    let said = refused(at, &["calibrate", "starfish"], 66);
    assert!(said.contains("not in this folder") && said.contains("diff_pd_public"), "{said}");
    let said = refused(at, &["validate", "starfish"], 66);
    assert!(said.contains("starfish is left out"), "{said}");
    let output = alewife(at, &["validate", "starfish", "bar.toml"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.contains("starfish is left out"), "{said}");

    for name in ["starfish.msh", "data_horizontal_cyclic1.csv"] {
        fs::write(at.join(name), "nothing").unwrap();
    }
    let said = refused(at, &["check", "starfish"], 65);
    assert!(!said.contains("does not come with"), "{said}");
}
