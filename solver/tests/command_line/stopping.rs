//! Runs that a signal stops, that resume, and whose files cannot grow.
#![cfg(unix)]

use std::path::Path;
use std::process::Command;

use super::alewife;

/// A run of a falling sphere far too long to end by itself, stopped in `fall` once it has written rows;
/// what it says.
fn stopped_fall(directory: &Path) -> String {
    stopped_fall_by("INT", directory)
}

/// The same by another signal.
fn stopped_fall_by(signal: &str, directory: &Path) -> String {
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
    let kill = ["-s", signal, &run.id().to_string()];
    assert!(Command::new("kill").args(kill).status().unwrap().success());
    let output = run.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(75), "{signal}");
    String::from_utf8(output.stderr).unwrap()
}

/// Names of the checkpoints of a run.
fn checkpoints(run: &Path) -> Vec<String> {
    let Ok(folder) = std::fs::read_dir(run.join("checkpoints")) else { return Vec::new() };
    folder.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

#[test]
fn a_signal_ends_a_run_after_its_step_with_all_files_complete() {
    let directory = tempfile::tempdir().unwrap();
    let told = stopped_fall(directory.path());
    let command = " run sphere-free-fall --set time.unsteady.end=1e6 --set mesh.scale=2 --out fall \
                   --threads 1 --quiet";
    assert!(told.contains(command), "{told}");
    let out = directory.path().join("fall");
    let status = std::fs::read_to_string(out.join("status.json")).unwrap();
    assert!(status.contains("\"stopped\""), "{status}");
    assert!(out.join("fields/stopped.vtu").is_file());
    let series = std::fs::read_to_string(out.join("series.csv")).unwrap();
    assert!(series.ends_with('\n') && series.lines().count() > 1);
}

/// What a batch system sends, and a terminal that is closed.
#[test]
fn all_signals_that_end_programs_leave_a_state() {
    for signal in ["TERM", "HUP", "XCPU", "USR1"] {
        let directory = tempfile::tempdir().unwrap();
        let told = stopped_fall_by(signal, directory.path());
        assert!(told.contains("it continues with"), "{signal}: {told}");
        assert_eq!(checkpoints(&directory.path().join("fall")).len(), 1, "{signal}");
    }
}

#[test]
fn a_steady_run_that_is_stopped_says_so() {
    let directory = tempfile::tempdir().unwrap();
    // A cavity that takes seconds on any machine
    let mut run = Command::new(env!("CARGO_BIN_EXE_alewife"))
        .args(["run", "lid-driven-cavity", "--out", "cavity", "--threads", "1"])
        .args(["--set", "mesh.size=0.008", "--set", "reference=[]"])
        .current_dir(directory.path())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let log = directory.path().join("cavity/log.jsonl");
    while !std::fs::read_to_string(&log).is_ok_and(|text| text.contains("newton")) {
        assert!(run.try_wait().unwrap().is_none(), "the run ended by itself");
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    assert!(Command::new("kill").arg(run.id().to_string()).status().unwrap().success());
    let output = run.wait_with_output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(75), "{told}");
    assert!(told.contains("it left no state to resume from"), "{told}");
    let status = std::fs::read_to_string(directory.path().join("cavity/status.json")).unwrap();
    assert!(status.contains("\"stopped\""), "{status}");
}

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
    // The state is not lost by a run of another case
    let refused = with(arguments("fall"), &["--set", &end, "--set", "fluid.viscosity=2.5"]);
    assert_eq!(refused.status.code(), Some(2));
    let told = String::from_utf8_lossy(&refused.stderr);
    assert!(told.contains("fluid.viscosity: ") && told.contains(" there, 2.5 here"), "{told}");
    // What is advised would be accepted
    assert!(told.contains("--overwrite") && !told.contains("--resume"), "{told}");
    let step = ["--set", &end, "--set", "time.unsteady.step=0.002"];
    let refused = with(arguments("fall"), &step);
    assert_eq!(refused.status.code(), Some(2));
    let told = String::from_utf8_lossy(&refused.stderr);
    assert!(told.contains("or --resume fall to continue from its state"), "{told}");
    assert_eq!(read("fall/series.csv"), before);

    // The directory of a run stands for its state
    let resumed = with(arguments("fall"), &["--set", &end, "--resume", "fall"]);
    assert_eq!(resumed.status.code(), Some(0), "{}", String::from_utf8_lossy(&resumed.stderr));
    let provenance: serde_json::Value =
        serde_json::from_str(&read("fall/provenance.json")).unwrap();
    let legs = provenance["legs"].as_array().unwrap();
    assert_eq!(legs.len(), 2);
    assert!(!provenance["argv"].to_string().contains("--resume"), "{provenance}");
    assert!(legs[1]["argv"].to_string().contains("--resume"), "{provenance}");
    assert!(read("fall/log.jsonl").contains("\"resumed\""));
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
    assert_eq!(checkpoints(&directory.path().join("fall")).len(), 2, "one is of the end");
    assert!(!read("fall/fields.pvd").contains("stopped"));
    assert!(!directory.path().join("fall/fields/stopped.vtu").exists());
}

#[test]
fn steps_are_counted_on_when_a_run_resumes_with_another_length() {
    let directory = tempfile::tempdir().unwrap();
    stopped_fall(directory.path());
    let status = || -> serde_json::Value {
        let text = std::fs::read_to_string(directory.path().join("fall/status.json")).unwrap();
        serde_json::from_str(&text).unwrap()
    };
    let (made, time) = (status()["step"].as_u64().unwrap(), status()["time"].as_f64().unwrap());
    let step = time / made as f64;
    let mut arguments = vec!["run", "sphere-free-fall", "--out", "fall", "--quiet"];
    let settings = [
        format!("time.unsteady.step={}", 0.5 * step),
        format!("time.unsteady.end={}", (made + 3) as f64 * step),
    ];
    arguments.extend(["--threads", "1", "--set", "mesh.scale=2", "--no-references"]);
    arguments.extend(settings.iter().flat_map(|setting| ["--set", setting.as_str()]));
    arguments.extend(["--resume", "fall"]);
    let resumed = alewife(directory.path(), &arguments);
    assert_eq!(resumed.status.code(), Some(0), "{}", String::from_utf8_lossy(&resumed.stderr));
    let said = String::from_utf8_lossy(&resumed.stdout);
    assert!(said.contains(&format!("{} steps", made + 6)), "{said}");
    assert_eq!(
        (status()["step"].as_u64(), status()["steps"].as_u64()),
        (Some(made + 6), Some(made + 6))
    );
}

#[test]
fn a_validation_that_is_stopped_prints_what_is_done() {
    let directory = tempfile::tempdir().unwrap();
    let text = alewife::case::Case::text("lid-driven-cavity").unwrap();
    let long = directory.path().join("long.toml");
    std::fs::write(&long, text.replacen("[mesh]", "[mesh]\nscale = 0.25", 1)).unwrap();
    let mut run = Command::new(env!("CARGO_BIN_EXE_alewife"))
        .args(["validate", "sphere-in-shell", "long.toml", "--threads", "1"])
        .current_dir(directory.path())
        .stderr(std::process::Stdio::piped())
        .stdout(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    // The first case takes a fraction of a second, the second one minutes
    let mut lines = std::io::BufRead::lines(std::io::BufReader::new(run.stderr.take().unwrap()));
    assert!(lines.any(|line| line.unwrap().contains("long")), "the second case has not begun");
    std::thread::sleep(std::time::Duration::from_millis(300));
    assert!(Command::new("kill").args(["-INT", &run.id().to_string()]).status().unwrap().success());
    let output = run.wait_with_output().unwrap();
    let told: Vec<String> = lines.map_while(Result::ok).collect();
    assert_eq!(output.status.code(), Some(75), "{told:?}");
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(said.contains("sphere-in-shell") && said.contains("within"), "{said}");
    assert!(told.iter().any(|line| line.contains("stopped by a signal in long")), "{told:?}");
}

#[test]
fn a_refused_resume_changes_nothing() {
    let directory = tempfile::tempdir().unwrap();
    stopped_fall(directory.path());
    let files = ["case.toml", "provenance.json", "status.json", "series.csv", "run.mcap"];
    let content =
        || files.map(|file| std::fs::read(directory.path().join("fall").join(file)).unwrap());
    let before = content();
    for out in ["fall", "other"] {
        let mut arguments = vec!["run", "sphere-free-fall", "--out", out, "--threads", "1"];
        arguments.extend(["--set", "mesh.scale=2", "--set", "fluid.viscosity=2.5"]);
        arguments.extend(["--resume", "fall"]);
        let refused = alewife(directory.path(), &arguments);
        assert_eq!(refused.status.code(), Some(65));
        let told = String::from_utf8_lossy(&refused.stderr);
        assert!(told.contains("fluid.viscosity = ") && told.contains("it is 2.5"), "{told}");
    }
    assert!(content() == before && !directory.path().join("other").exists());
}

/// The system lets no file grow beyond a size: what a full disk does, without one.
#[test]
fn a_file_that_cannot_grow_is_named_and_the_run_failed() {
    let directory = tempfile::tempdir().unwrap();
    let mut named = std::collections::BTreeSet::new();
    for blocks in [2, 8, 24, 64, 300] {
        let out = format!("fall-{blocks}");
        let script = format!(
            "ulimit -f {blocks}; exec {} run sphere-free-fall --out {out} --quiet --threads 1 \
             --set time.unsteady.end=1e6 --set mesh.scale=2 --set output.fields.steps=40",
            env!("CARGO_BIN_EXE_alewife")
        );
        let output = Command::new("sh")
            .args(["-c", &script])
            .current_dir(directory.path())
            .output()
            .unwrap();
        let told = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(74), "{blocks}: {told}");
        assert!(told.contains("File too large"), "{told}");
        let start = told.find(&format!("{out}/")).unwrap();
        named.insert(told[start + out.len()..].split([':', ' ']).next().unwrap().to_owned());
        let out = directory.path().join(out);
        let status = std::fs::read_to_string(out.join("status.json")).unwrap_or_default();
        assert!(status.is_empty() || status.contains("\"failed\""), "{blocks}: {status}");
        let series = std::fs::read_to_string(out.join("series.csv")).unwrap_or_default();
        let mut lines = series.lines();
        let n_columns = lines.next().map_or(0, |header| header.split(',').count());
        assert!(series.is_empty() || series.ends_with('\n'), "{blocks}: a row is not whole");
        assert!(lines.all(|line| line.split(',').count() == n_columns), "{blocks}");
        let left = std::fs::read_dir(&out).unwrap().map(|entry| entry.unwrap().file_name());
        let unfinished = left.filter(|name| name.to_string_lossy().starts_with(".unfinished-"));
        assert_eq!(unfinished.count(), 0, "{blocks}");
    }
    assert!(named.len() > 1, "{named:?}");
}

/// Its status cannot be written any more.
#[test]
fn a_run_whose_directory_vanishes_ends_with_its_name() {
    let directory = tempfile::tempdir().unwrap();
    let mut run = Command::new(env!("CARGO_BIN_EXE_alewife"))
        .args(["run", "sphere-free-fall", "--out", "fall", "--quiet", "--threads", "1"])
        .args(["--set", "time.unsteady.end=1e6", "--set", "mesh.scale=2"])
        .current_dir(directory.path())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let out = directory.path().join("fall");
    // The last of the files that are made at the start
    while !out.join("status.json").is_file() {
        assert!(run.try_wait().unwrap().is_none(), "the run ended by itself");
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    // Files may be made while others are removed
    while std::fs::remove_dir_all(&out).is_err() {}
    let output = run.wait_with_output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(74), "{told}");
    assert!(told.contains("fall/status.json: "), "{told}");
}

/// Longest time from a signal to the end of a process, which is asked for; a loaded machine takes its own.
const SOON: std::time::Duration = std::time::Duration::from_secs(10);

#[test]
fn a_signal_is_heard_while_a_mesh_is_made() {
    let directory = tempfile::tempdir().unwrap();
    // Minutes of meshing
    let space = "geometry = 'spatial'\ndomain.sphere = { center = [0, 0, 0], radius = 8.0 }\n\
                 boundary.wall = 'no-slip'\nmesh = { size = 0.35, surface = 0.05, growth = 0.1 }\n\
                 [[body]]\nname = 'a'\nshape.sphere.radius = 1.0\ncenter = [0, 0, 0]\nmotion = 'held'\n";
    let plane = "geometry = 'planar'\ndomain.disc = { center = [0, 0], radius = 8.0 }\n\
                 boundary.wall = 'no-slip'\nmesh = { size = 0.02, surface = 0.02 }\n\
                 [[body]]\nname = 'a'\nshape.disc.radius = 1.0\ncenter = [0, 0]\nmotion = 'held'\n";
    for (name, text) in [("space", space), ("plane", plane)] {
        let head =
            "title = 't'\nfluid = { model = 'stokes', viscosity = 1.0 }\ntime = { steady = {} }\n";
        std::fs::write(directory.path().join("large.toml"), format!("{head}{text}")).unwrap();
        let mut run = Command::new(env!("CARGO_BIN_EXE_alewife"))
            .args(["run", "large.toml", "--out", name, "--quiet", "--threads", "1"])
            .current_dir(directory.path())
            .stdout(std::process::Stdio::null())
            .stderr(std::process::Stdio::piped())
            .spawn()
            .unwrap();
        while !directory.path().join(name).join("status.json").is_file() {
            if run.try_wait().unwrap().is_some() {
                let output = run.wait_with_output().unwrap();
                panic!("{name}: {}", String::from_utf8_lossy(&output.stderr));
            }
            std::thread::sleep(std::time::Duration::from_millis(20));
        }
        std::thread::sleep(std::time::Duration::from_millis(300));
        let kill = ["-s", "TERM", &run.id().to_string()];
        assert!(Command::new("kill").args(kill).status().unwrap().success());
        let sent = std::time::Instant::now();
        let output = run.wait_with_output().unwrap();
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(75), "{name}: {told}");
        assert!(sent.elapsed() < SOON, "{name}: {:?}", sent.elapsed());
        let status = std::fs::read_to_string(directory.path().join(name).join("status.json"));
        assert!(status.unwrap().contains("\"stopped\""), "{name}");
    }
}
