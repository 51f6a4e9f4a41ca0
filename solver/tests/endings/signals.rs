//! Commands other than runs of a flow that a signal ends, and searches that come to the same bits when called again.

use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use super::{PLANE, text};
use crate::soft::BAR;

/// Longest time from a signal to the end of a process that is asked for is two seconds; a loaded machine takes its own.
const SOON: Duration = Duration::from_secs(10);

fn begun(directory: &Path, arguments: &[&str]) -> Child {
    Command::new(env!("CARGO_BIN_EXE_alewife"))
        .args(arguments)
        .current_dir(directory)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// How a command ends that gets a signal.
fn signalled(command: Child, signal: &str) -> Output {
    let kill = ["-s", signal, &command.id().to_string()];
    assert!(Command::new("kill").args(kill).status().unwrap().success());
    let sent = Instant::now();
    let output = command.wait_with_output().unwrap();
    assert!(sent.elapsed() < SOON, "{:?}", sent.elapsed());
    output
}

#[test]
fn commands_that_a_signal_ends_say_what_is_left() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    // Minutes of meshing
    let fine = PLANE.replace("size = 1.0, surface = 0.35", "size = 0.01, surface = 0.01");
    std::fs::write(at.join("fine.toml"), fine).unwrap();
    std::fs::write(at.join("bar.toml"), BAR.replace("frames = 8", "frames = 100000")).unwrap();
    for (signal, arguments, left) in [
        ("TERM", vec!["check", "fine.toml", "--threads", "1"], "begins again when it is called"),
        (
            "TERM",
            vec!["run", "robot-eel", "--fidelity", "reduced", "--set", "time.unsteady.end=1e6"],
            "keeps nothing on its way",
        ),
        ("HUP", vec!["run", "bar.toml", "--fidelity", "soft"], "keeps nothing on its way"),
    ] {
        let mut command = begun(at, &arguments);
        std::thread::sleep(Duration::from_millis(700));
        assert!(command.try_wait().unwrap().is_none(), "{arguments:?} has ended by itself");
        let output = signalled(command, signal);
        let told = text(&output.stderr);
        assert_eq!(output.status.code(), Some(75), "{arguments:?}: {told}");
        assert!(told.contains("stopped by a signal") && told.contains(left), "{told}");
    }
}

/// A pipe that nobody writes to is waited for without a look at signals.
#[test]
fn a_stage_that_does_not_look_is_ended_with_the_program() {
    let directory = tempfile::tempdir().unwrap();
    let pipe = directory.path().join("series.csv");
    assert!(Command::new("mkfifo").arg(pipe).status().unwrap().success());
    let command = begun(directory.path(), &["plot", ".", "a.x"]);
    std::thread::sleep(Duration::from_millis(700));
    let output = signalled(command, "TERM");
    let told = text(&output.stderr);
    assert_eq!(output.status.code(), Some(75), "{told}");
    assert!(told.contains("stopped by a signal; it begins again"), "{told}");
}

#[test]
fn a_search_that_signals_stop_comes_to_the_same_bits() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    std::fs::write(at.join("bar.toml"), BAR.replace("frames = 8", "frames = 200")).unwrap();
    let search = |out: &str| begun(at, &["optimise", "bar.toml", "--out", out, "--quiet"]);
    assert!(search("whole").wait().unwrap().success());
    let read = |path: &str| std::fs::read_to_string(at.join(path)).unwrap_or_default();
    // In the first evaluation, and whenever there is another one
    let mut n_stopped = 0;
    for wanted in 1..6 {
        let mut command = search("parts");
        while read("parts/search.journal").lines().count() < wanted
            && command.try_wait().unwrap().is_none()
        {
            std::thread::sleep(Duration::from_millis(5));
        }
        if command.try_wait().unwrap().is_some() {
            break;
        }
        let output = signalled(command, ["TERM", "INT"][wanted % 2]);
        let told = text(&output.stderr);
        assert_eq!(output.status.code(), Some(75), "{told}");
        assert!(told.contains("comes to the same bits"), "{told}");
        assert!(!at.join("parts/report.json").exists());
        n_stopped += 1;
    }
    assert!(n_stopped > 1, "{n_stopped}");
    assert!(at.join("parts/report.json").exists() || search("parts").wait().unwrap().success());
    for file in ["search.journal", "report.json", "case.toml"] {
        assert_eq!(read(&format!("whole/{file}")), read(&format!("parts/{file}")), "{file}");
    }
}
