//! Runs that continue: what asks for checkpoints, what stops in time, and what is refused.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use super::{DISC, FLUID, alewife, done};

/// A run of a falling sphere far too long to end by itself.
pub(super) const LONG: [&str; 10] = [
    "run",
    "sphere-free-fall",
    "--out",
    "fall",
    "--threads",
    "1",
    "--set",
    "mesh.scale=2",
    "--set",
    "time.unsteady.end=1e6",
];

/// Time after which a test gives up.
const PATIENCE: Duration = Duration::from_secs(120);

pub(super) fn start(directory: &Path, environment: &[(&str, &str)], more: &[&str]) -> Child {
    Command::new(env!("CARGO_BIN_EXE_alewife"))
        .args(LONG)
        .args(more)
        .envs(environment.iter().copied())
        .current_dir(directory)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// The same until it has written rows.
pub(super) fn under_way(directory: &Path) -> Child {
    let run = start(directory, &[], &["--quiet"]);
    let series = directory.join("fall/series.csv");
    wait_for(|| std::fs::read_to_string(&series).is_ok_and(|text| text.lines().count() > 2));
    run
}

pub(super) fn wait_for(mut has_come: impl FnMut() -> bool) {
    let started = Instant::now();
    while !has_come() {
        assert!(started.elapsed() < PATIENCE, "it did not come");
        std::thread::sleep(Duration::from_millis(20));
    }
}

pub(super) fn checkpoints(directory: &Path) -> Vec<PathBuf> {
    let Ok(folder) = std::fs::read_dir(directory.join("fall/checkpoints")) else {
        return Vec::new();
    };
    let names = folder.map(|entry| entry.unwrap().path());
    let mut states: Vec<PathBuf> =
        names.filter(|path| path.extension().is_some_and(|ending| ending == "state")).collect();
    states.sort();
    states
}

/// A run with checkpoints after each second that ended at a request, to be continued.
pub(super) fn stopped(directory: &Path) {
    let run = under_way(directory);
    std::fs::write(directory.join("fall/STOP"), "").unwrap();
    let output = run.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(75), "{}", told(&output));
}

pub(super) fn told(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Continues to an end a little later than what was reached.
fn continued(directory: &Path, more: &[&str]) -> Output {
    let mut arguments = LONG[..8].to_vec();
    arguments.extend(["--set", "time.unsteady.end=1e6", "--max-walltime", "10.1 s"]);
    arguments.extend(more);
    alewife(directory, &arguments)
}

#[test]
fn files_in_its_directory_stop_a_run_and_have_it_write_its_state() {
    let place = tempfile::tempdir().unwrap();
    let directory = place.path();
    let mut run = under_way(directory);
    assert!(checkpoints(directory).is_empty());
    let request = directory.join("fall/CHECKPOINT");
    std::fs::write(&request, "").unwrap();
    wait_for(|| checkpoints(directory).len() == 1);
    assert!(!request.exists());
    let status = || {
        let status = alewife(directory, &["status", "fall"]);
        String::from_utf8_lossy(&status.stdout).into_owned()
    };
    assert!(status().contains("fall: running, step "), "{}", status());
    run.kill().unwrap();
    run.wait().unwrap();
    // At once: its status is a second old at most
    let said = status();
    assert!(said.contains("fall: killed, step ") && said.contains("run it again to"), "{said}");
    stopped(directory);
    assert_eq!(checkpoints(directory).len(), 2);
    assert!(!directory.join("fall/STOP").exists());
    let log = std::fs::read_to_string(directory.join("fall/log.jsonl")).unwrap();
    assert!(log.contains("\"resumed\""), "the second run continued the first");

    let said = status();
    assert!(said.contains("fall: stopped, step ") && said.contains("latest checkpoint"), "{said}");
    let status = alewife(directory, &["status", "--json", "fall"]);
    let all: serde_json::Value = serde_json::from_slice(&status.stdout).unwrap();
    assert_eq!(all[0]["state"], "stopped");
    assert!(all[0]["part"].as_f64().unwrap() < 1.0);
    assert_eq!(alewife(directory, &["status", "elsewhere"]).status.code(), Some(66));
}

#[test]
fn a_run_stops_before_its_time_on_the_clock_is_over() {
    for (is_job, options) in [(false, vec!["--max-walltime", "12 s"]), (true, vec![])] {
        let place = tempfile::tempdir().unwrap();
        let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).unwrap();
        let end = (now.as_secs() + 14).to_string();
        let job = [("SLURM_JOB_END_TIME", end.as_str())];
        let environment = if is_job { &job[..] } else { &[] };
        let output = start(place.path(), environment, &options).wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(75), "{}", told(&output));
        let said = told(&output);
        assert!(
            said.contains("limit of its time on the clock") && !said.contains("signal"),
            "{said}"
        );
        assert_eq!(checkpoints(place.path()).len(), 1);
    }
    let place = tempfile::tempdir().unwrap();
    let wrong = start(place.path(), &[], &["--max-walltime", "soon"]).wait_with_output().unwrap();
    assert_eq!(wrong.status.code(), Some(2));
    assert!(told(&wrong).contains("\"soon\" is no time on a clock"), "{}", told(&wrong));
}

#[test]
fn a_damaged_checkpoint_gives_way_to_the_one_before() {
    let place = tempfile::tempdir().unwrap();
    let directory = place.path();
    stopped(directory);
    let output = continued(directory, &[]);
    assert_eq!(output.status.code(), Some(75), "{}", told(&output));
    let [before, latest] = &checkpoints(directory)[..] else { panic!("two are kept") };
    let mut bytes = std::fs::read(latest).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    std::fs::write(latest, bytes).unwrap();
    let output = continued(directory, &[]);
    let name = before.file_name().unwrap().to_str().unwrap();
    assert!(told(&output).contains(&format!("from fall/checkpoints/{name}")), "{}", told(&output));
    for state in checkpoints(directory) {
        std::fs::write(state, "nothing").unwrap();
    }
    let output = continued(directory, &[]);
    assert_eq!(output.status.code(), Some(65), "{}", told(&output));
    assert!(told(&output).contains(".state: this is no state of a run"), "{}", told(&output));
    assert!(told(&output).contains("--overwrite the run to start again"), "{}", told(&output));
}

#[test]
fn a_run_that_makes_no_progress_is_not_restarted_for_ever() {
    let place = tempfile::tempdir().unwrap();
    let directory = place.path();
    stopped(directory);
    let path = directory.join("fall/status.json");
    let mut status: serde_json::Value =
        serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
    let step: u64 =
        checkpoints(directory)[0].file_stem().unwrap().to_str().unwrap().parse().unwrap();
    status["restarts"] = serde_json::json!({ "step": step, "count": 3 });
    std::fs::write(&path, status.to_string()).unwrap();
    let output = continued(directory, &[]);
    assert_eq!(output.status.code(), Some(76), "{}", told(&output));
    assert!(told(&output).contains("3 runs in a row began at step"), "{}", told(&output));
    status["restarts"] = serde_json::json!({ "step": step + 1, "count": 3 });
    std::fs::write(&path, status.to_string()).unwrap();
    assert_eq!(continued(directory, &[]).status.code(), Some(75));
}

#[test]
fn a_finished_run_continues_to_a_later_end_where_that_is_asked_for() {
    let place = tempfile::tempdir().unwrap();
    let run = |end: &str, more: &[&str]| {
        let end = format!("time.unsteady.end={end}");
        let mut arguments = LONG[..8].to_vec();
        arguments.extend(["--set", &end, "--no-references"]);
        arguments.extend(more);
        let output = alewife(place.path(), &arguments);
        (output.status.code(), told(&output), String::from_utf8_lossy(&output.stdout).into_owned())
    };
    assert_eq!(run("0.02", &[]).0, Some(0));
    let (code, refused, _) = run("0.04", &[]);
    assert_eq!(code, Some(2));
    assert!(refused.contains("holds a finished run"), "{refused}");
    let (code, _, said) = run("0.02", &["--continue"]);
    assert_eq!(code, Some(0));
    assert!(said.contains("has come to its end before"), "{said}");
    let (code, told, _) = run("0.04", &["--continue"]);
    assert_eq!(code, Some(0), "{told}");
    assert!(told.contains("continues at step"), "{told}");
}

#[test]
fn a_run_whose_status_is_lost_continues_from_its_latest_checkpoint() {
    let place = tempfile::tempdir().unwrap();
    let short = format!(
        "{FLUID}mesh = {{ size = 0.5, surface = 0.1 }}\ntime.unsteady = {{ step = 0.01, end = 0.05 }}\n{DISC}"
    );
    std::fs::write(place.path().join("case.toml"), short).unwrap();
    let run = ["run", "case.toml", "--threads", "1", "--out", "r"];
    done(place.path(), &run);
    let status = place.path().join("r/status.json");
    for lost in [Some(""), Some("{"), None] {
        match lost {
            Some(text) => std::fs::write(&status, text).unwrap(),
            None => std::fs::remove_file(&status).unwrap(),
        }
        let said = done(place.path(), &run);
        assert!(said.contains("has come to its end before"), "{said}");
        done(place.path(), &["verify", "r"]);
    }
    std::fs::write(&status, "").unwrap();
    let later = [&run[..], &["--set", "time.unsteady.end=0.08"]].concat();
    let output = alewife(place.path(), &later);
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{told}");
    assert!(told.contains("continues at step 5"), "{told}");
    done(place.path(), &["verify", "r"]);
}
