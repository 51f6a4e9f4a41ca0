//! Sweeps that are stopped, or killed with their processes, and end with the bytes of those that are not.
#![cfg(unix)]

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::command_line::{DISC, FLUID};

/// A run with checkpoints all the time.
const RUN: &str = "
mesh = { size = 0.15, surface = 0.08 }
time.unsteady = { step = 0.01, end = 0.8 }
output.checkpoint = { wall = '0.02 s', keep = 2 }
";

/// Its points.
const SWEEP: &str = "
[sweep.grid]
body.0.density = [1.5, 2.0, 3.0]
";

/// Time after which a test gives up.
const PATIENCE: Duration = Duration::from_secs(120);

fn sweep(directory: &Path, out: &str) -> Command {
    let mut sweep = Command::new(env!("CARGO_BIN_EXE_alewife"));
    sweep.args(["sweep", "run", "case.toml", "--out", out, "--jobs", "1", "--quiet"]);
    sweep.current_dir(directory).stdout(Stdio::null()).stderr(Stdio::piped());
    sweep
}

/// A sweep whose point has written checkpoints.
fn under_way(directory: &Path, point: &str) -> Child {
    let sweep = sweep(directory, "other").spawn().unwrap();
    let checkpoints = directory.join("other/points").join(point).join("checkpoints");
    let started = Instant::now();
    while std::fs::read_dir(&checkpoints).map_or(0, Iterator::count) < 2 {
        assert!(started.elapsed() < PATIENCE, "no checkpoint in {}", checkpoints.display());
        std::thread::sleep(Duration::from_millis(5));
    }
    sweep
}

fn ends(mut sweep: Command) {
    let output = sweep.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn a_sweep_that_is_stopped_or_killed_continues_with_the_same_bytes() {
    let place = tempfile::tempdir().unwrap();
    let directory = place.path();
    let text = format!("{FLUID}{RUN}{DISC}{SWEEP}");
    std::fs::write(directory.join("case.toml"), text).unwrap();
    ends(sweep(directory, "whole"));

    // A signal to the sweep alone stops its points
    let stopped = under_way(directory, "0001");
    let kill = ["-s", "TERM", &stopped.id().to_string()];
    assert!(Command::new("kill").args(kill).status().unwrap().success());
    let output = stopped.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(75), "{}", String::from_utf8_lossy(&output.stderr));
    let status = directory.join("other/points/0001/status.json");
    assert!(std::fs::read_to_string(status).unwrap().contains("\"stopped\""));

    // So does a file
    let stopped = under_way(directory, "0001");
    std::fs::write(directory.join("other/STOP"), "").unwrap();
    assert_eq!(stopped.wait_with_output().unwrap().status.code(), Some(75));
    assert!(!directory.join("other/STOP").exists());

    // Without the process of the sweep its points stop by themselves, or are killed by the test
    let mut killed = under_way(directory, "0002");
    killed.kill().unwrap();
    killed.wait().unwrap();
    ends(sweep(directory, "other"));

    let read = |sweep: &str, point: &str, file: &str| {
        std::fs::read(directory.join(sweep).join("points").join(point).join(file)).unwrap()
    };
    for point in ["0001", "0002", "0003"] {
        let [one, other] = ["whole", "other"].map(|sweep| read(sweep, point, "series.csv"));
        assert!(one == other, "series of point {point}");
    }
    let log = read("other", "0002", "log.jsonl");
    assert!(String::from_utf8_lossy(&log).contains("\"resumed\""), "point 2 was continued");
}
