//! Runs that something outside of them disturbs: full disks, names that are taken, other processes, restarts.
#![cfg(unix)]

use std::path::Path;
use std::process::{Command, Output};

use super::alewife;
use super::continuing::{LONG, start, stopped, told, under_way};
use super::{DISC, FLUID};

/// Checkpoints and field files of a disc that sinks at every turn.
const RUN: &str = "
mesh = { size = 0.1, surface = 0.06 }
output.checkpoint = { wall = '1 h', time = 0.05, keep = 2 }
output.fields = { time = 0.02 }
time.unsteady = { step = 0.01, end = 0.4 }
";

fn case(directory: &Path) {
    std::fs::write(directory.join("case.toml"), format!("{FLUID}{RUN}{DISC}")).unwrap();
}

fn run(directory: &Path, out: &str, more: &[&str]) -> Output {
    let arguments = ["run", "case.toml", "--out", out, "--threads", "1", "--quiet"];
    alewife(directory, &[&arguments, more].concat())
}

/// Files of a run that do not tell of when and where it was made, with their content.
fn results(run: &Path) -> Vec<(String, Vec<u8>)> {
    let mut found = Vec::new();
    for folder in ["", "fields", "checkpoints"] {
        for entry in std::fs::read_dir(run.join(folder)).into_iter().flatten() {
            let path = entry.unwrap().path();
            let name = path.strip_prefix(run).unwrap().to_str().unwrap().to_owned();
            let is_result =
                [".vtu", ".pvd", ".csv", ".state"].iter().any(|end| name.ends_with(end));
            if is_result {
                found.push((name, std::fs::read(path).unwrap()));
            }
        }
    }
    found.sort();
    // One that comes due while another is being written is left out
    let last = found.iter().rposition(|(name, _)| name.starts_with("checkpoints/"));
    let (_, last) = found.swap_remove(last.unwrap());
    found.retain(|(name, _)| !name.starts_with("checkpoints/"));
    found.sort();
    found.push(("the last state".to_owned(), last));
    found
}

#[track_caller]
fn assert_same(one: &Path, other: &Path) {
    let [one, other] = [one, other].map(results);
    let names = |all: &[(String, Vec<u8>)]| -> Vec<String> {
        all.iter().map(|(name, _)| name.clone()).collect()
    };
    assert_eq!(names(&one), names(&other));
    for ((name, one), (_, other)) in one.iter().zip(&other) {
        assert!(one == other, "{name} differs");
    }
}

/// A file system of a few hundred kilobytes, in a namespace of its own.
#[test]
fn a_run_on_a_full_disk_goes_on_once_there_is_space() {
    let is_permitted = Command::new("unshare")
        .args(["-rm", "sh", "-c", "mount -t tmpfs none /mnt"])
        .output()
        .is_ok_and(|output| output.status.success());
    if !is_permitted {
        println!("no file system may be mounted here: not tested");
        return;
    }
    let place = tempfile::tempdir().unwrap();
    let directory = place.path();
    case(directory);
    let whole = run(directory, "whole", &[]);
    assert_eq!(whole.status.code(), Some(0), "{}", told(&whole));
    std::fs::create_dir(directory.join("disk")).unwrap();
    let mut continued = 0;
    for kilobytes in [600, 1800, 2600, 3300] {
        let script = format!(
            "mount -t tmpfs -o size={kilobytes}k none disk
             run() {{ '{}' run case.toml --out disk/run --threads 1 --quiet; }}
             run; echo \"code $?\" >&2
             ls -A disk/run disk/run/* >before
             mount -o remount,size=64m disk
             run; echo \"code $?\" >&2
             rm -rf run; cp -r disk/run run",
            env!("CARGO_BIN_EXE_alewife")
        );
        let output = Command::new("unshare")
            .args(["-rm", "sh", "-c", &script])
            .current_dir(directory)
            .output()
            .unwrap();
        let told = told(&output);
        let (first, second) = told.split_once("code 74\n").expect(&told);
        assert!(first.contains("disk/run/") && first.contains("No space left"), "{told}");
        assert!(second.ends_with("code 0\n"), "{told}");
        let before = std::fs::read_to_string(directory.join("before")).unwrap();
        assert!(!before.contains(".unfinished"), "{before}");
        let log = std::fs::read_to_string(directory.join("run/log.jsonl")).unwrap();
        assert_eq!(log.contains("\"resumed\""), before.contains(".state"), "{kilobytes}: {before}");
        continued += usize::from(before.contains(".state"));
        assert_same(&directory.join("run"), &directory.join("whole"));
    }
    assert!(continued >= 2, "{continued} runs went on from a checkpoint");
}

#[test]
fn the_second_run_in_a_directory_is_told_who_is_there_and_a_killed_one_bars_nobody() {
    let place = tempfile::tempdir().unwrap();
    let directory = place.path();
    let mut first = under_way(directory);
    for more in [&[][..], &["--overwrite"], &["--continue"], &["--resume", "fall"]] {
        let second = start(directory, &[], more).wait_with_output().unwrap();
        assert_eq!(second.status.code(), Some(74), "{}", told(&second));
        let expected = format!("(process {}", first.id());
        assert!(told(&second).contains(&expected), "{}", told(&second));
    }
    first.kill().unwrap();
    first.wait().unwrap();
    // What the process left says nothing: the system has given the lock free
    let lock = std::fs::read_to_string(directory.join("fall/lock")).unwrap();
    assert!(lock.starts_with(&format!("process {}", first.id())), "{lock}");
    let third = start(directory, &[], &["--quiet", "--max-walltime", "1 s"]);
    let third = third.wait_with_output().unwrap();
    assert_eq!(third.status.code(), Some(75), "{}", told(&third));
}

/// On network file systems names go wrong in more ways than on others. Here a folder stands where a file is to be,
/// which not even the superuser can replace by one.
#[test]
fn what_cannot_be_replaced_is_named() {
    let place = tempfile::tempdir().unwrap();
    let directory = place.path();
    case(directory);
    let half = run(directory, "half", &["--max-walltime", "1 s"]);
    assert_eq!(half.status.code(), Some(75), "{}", told(&half));
    let whole = run(directory, "whole", &["--set", "time.unsteady.end=0.1"]);
    assert_eq!(whole.status.code(), Some(0), "{}", told(&whole));
    let files = [
        "case.toml",
        "bodies.json",
        "provenance.json",
        "series.csv",
        "run.mcap",
        "fields.pvd",
        "log.jsonl",
    ];
    let late = ["status.json", "comparison.json", "fields/000022.vtu", "checkpoints/000015.state"];
    for (out, name) in
        files.iter().map(|name| ("whole", *name)).chain(late.iter().map(|name| ("late", *name)))
    {
        let taken = directory.join(out).join(name);
        let mut more = vec!["--set", "time.unsteady.end=0.25", "--continue"];
        if out == "late" {
            let _ = std::fs::remove_dir_all(directory.join("late"));
            let begun = run(directory, "late", &["--set", "time.unsteady.end=0.1"]);
            assert_eq!(begun.status.code(), Some(0), "{}", told(&begun));
        }
        if name == "comparison.json" {
            more.extend(["--set", REFERENCE]);
        }
        let kept = std::fs::read(&taken).ok();
        let _ = std::fs::remove_file(&taken);
        std::fs::create_dir_all(taken.join("taken")).unwrap();
        let output = run(directory, out, &more);
        let told = told(&output);
        let code = output.status.code().unwrap();
        assert!([2, 65, 74].contains(&code), "{name}: {code}, {told}");
        assert!(told.contains(&format!("{out}/{name}")) || name == "status.json", "{name}: {told}");
        std::fs::remove_dir_all(&taken).unwrap();
        if let Some(kept) = kept {
            std::fs::write(&taken, kept).unwrap();
        }
    }
    let output = run(directory, "whole", &["--set", "time.unsteady.end=0.25", "--continue"]);
    assert_eq!(output.status.code(), Some(0), "{}", told(&output));
    let unbroken = run(directory, "unbroken", &["--set", "time.unsteady.end=0.25"]);
    assert_eq!(unbroken.status.code(), Some(0), "{}", told(&unbroken));
    let series = |out: &str| std::fs::read(directory.join(out).join("series.csv")).unwrap();
    assert!(series("whole") == series("unbroken"));
}

const REFERENCE: &str = "reference=[{ quantity = 'disc.y', value = 0.0, absolute = 9.0, kind = 'exact', source = 's' }]";

#[test]
fn a_job_that_is_started_again_and_again_without_a_checkpoint_ends() {
    let place = tempfile::tempdir().unwrap();
    let directory = place.path();
    let again = |count: &str, arguments: &[&str]| {
        let mut run = Command::new(env!("CARGO_BIN_EXE_alewife"));
        run.args(arguments).current_dir(directory).env("SLURM_RESTART_COUNT", count);
        run.output().unwrap()
    };
    let arguments = [&LONG[..], &["--quiet", "--max-walltime", "1 s"]].concat();
    // No time for a single step
    let first = again("0", &arguments);
    assert_eq!(first.status.code(), Some(75), "{}", told(&first));
    for state in std::fs::read_dir(directory.join("fall/checkpoints")).into_iter().flatten() {
        std::fs::remove_file(state.unwrap().path()).unwrap();
    }
    assert_eq!(again("3", &arguments).status.code(), Some(75));
    for state in std::fs::read_dir(directory.join("fall/checkpoints")).into_iter().flatten() {
        std::fs::remove_file(state.unwrap().path()).unwrap();
    }
    let refused = again("4", &arguments);
    assert_eq!(refused.status.code(), Some(76), "{}", told(&refused));
    assert!(told(&refused).contains("fall holds no checkpoint"), "{}", told(&refused));
    // Of a steady solution there never is one; it is done where it has been found
    let steady =
        ["run", "squirmer-alone", "--out", "steady", "--set", "mesh.scale=2", "--threads", "1"];
    assert_eq!(again("0", &steady).status.code(), Some(0));
    let done = again("1", &steady);
    assert_eq!(done.status.code(), Some(0), "{}", told(&done));
    let status = directory.join("steady/status.json");
    let text = std::fs::read_to_string(&status).unwrap();
    std::fs::write(&status, text.replace("\"finished\"", "\"running\"")).unwrap();
    assert_eq!(again("4", &steady).status.code(), Some(76));
    assert_eq!(again("2", &steady).status.code(), Some(0));
}

#[test]
fn a_requeued_job_goes_on_without_being_asked() {
    let place = tempfile::tempdir().unwrap();
    let directory = place.path();
    case(directory);
    assert_eq!(run(directory, "r", &["--set", "time.unsteady.end=0.1"]).status.code(), Some(0));
    let longer = ["--set", "time.unsteady.end=0.15"];
    let refused = run(directory, "r", &longer);
    assert_eq!(refused.status.code(), Some(2), "{}", told(&refused));
    for (count, code) in [("0", 2), ("1", 0)] {
        let output = Command::new(env!("CARGO_BIN_EXE_alewife"))
            .args(["run", "case.toml", "--out", "r", "--threads", "1"])
            .args(longer)
            .current_dir(directory)
            .env("SLURM_RESTART_COUNT", count)
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(code), "{}", told(&output));
    }
}

#[test]
fn a_run_in_legs_says_where_it_comes_from_as_one_in_a_single_one_does() {
    let place = tempfile::tempdir().unwrap();
    let directory = place.path();
    let mut run = under_way(directory);
    std::fs::write(directory.join("fall/CHECKPOINT"), "").unwrap();
    super::continuing::wait_for(|| !super::continuing::checkpoints(directory).is_empty());
    let read = |file: &str| std::fs::read_to_string(directory.join("fall").join(file)).unwrap();
    let json = |file: &str| -> serde_json::Value { serde_json::from_str(&read(file)).unwrap() };
    let mut first = json("provenance.json");
    let end = first["legs"][0]["end"].clone();
    assert!(end.is_null(), "{first}");
    run.kill().unwrap();
    run.wait().unwrap();
    stopped(directory);
    let end = json("status.json")["time"].as_f64().unwrap() + 0.05;
    let mut last = LONG[..4].to_vec();
    let end = format!("time.unsteady.end={end}");
    last.extend(["--set", "mesh.scale=2", "--set", &end, "--no-references", "--threads", "2"]);
    let output = alewife(directory, &last);
    assert_eq!(output.status.code(), Some(0), "{}", told(&output));

    let provenance = json("provenance.json");
    let legs = provenance["legs"].as_array().unwrap().clone();
    assert_eq!(legs.len(), 3, "{provenance}");
    let ends: Vec<&str> = legs.iter().map(|leg| leg["end"].as_str().unwrap()).collect();
    assert_eq!((ends[0], ends[2]), ("killed", "finished"));
    assert!(ends[1].starts_with("stopped"), "{ends:?}");
    for pair in legs.windows(2) {
        let [to, from] = [&pair[0]["to"]["step"], &pair[1]["from"]["step"]];
        let [to, from] = [to, from].map(|step| step.as_u64().unwrap());
        assert!(0 < from && from <= to, "{provenance}");
    }
    assert_eq!(legs[2]["to"]["step"], json("status.json")["step"]);
    let threads: Vec<u64> = legs.iter().map(|leg| leg["threads"].as_u64().unwrap()).collect();
    assert_eq!(threads, [1, 1, 2]);
    // What it comes from is unchanged
    for key in ["alewife", "case_hash", "started_at", "argv", "threads", "git", "rustc", "target"] {
        assert_eq!(first[key].take(), provenance[key], "{key}");
    }
    let line = format!("case {}", provenance["case_hash"].as_str().unwrap());
    for entry in std::fs::read_dir(directory.join("fall/fields")).unwrap() {
        let bytes = std::fs::read(entry.unwrap().path()).unwrap();
        let head = String::from_utf8_lossy(&bytes[..300]).into_owned();
        assert!(head.lines().nth(1).unwrap().contains(&line), "{head}");
    }
    assert!(read("fields.pvd").contains(&line));
    let messages = std::fs::read(directory.join("fall/run.mcap")).unwrap();
    let summary = mcap::Summary::read(&messages).unwrap().unwrap();
    let metadata = mcap::read::metadata(&messages, &summary.metadata_indexes[0]).unwrap().metadata;
    assert_eq!(metadata["started_at"], provenance["started_at"]);
    let in_messages: Vec<serde_json::Value> = serde_json::from_str(&metadata["legs"]).unwrap();
    assert_eq!(in_messages.len(), 3);
    assert_eq!(in_messages[..2], legs[..2]);

    let status = alewife(directory, &["status", "fall"]);
    let said = String::from_utf8_lossy(&status.stdout).into_owned();
    for (leg, end) in
        [(1, "1 thread: killed"), (2, "1 thread: stopped"), (3, "2 threads: finished")]
    {
        let line = said.lines().find(|line| line.contains(&format!("leg {leg}: steps ")));
        assert!(line.is_some_and(|line| line.contains(end)), "{said}");
    }
}

/// A disc that turns as it sinks beside a wall, on meshes that are replaced: what one was generated for is that of a run
/// that was never interrupted, however often it is resumed in between.
#[test]
fn a_mesh_that_is_replaced_after_a_run_was_resumed_is_that_of_the_unbroken_run() {
    let place = tempfile::tempdir().unwrap();
    let directory = place.path();
    let text = format!("{FLUID}{RUN}{DISC}")
        .replace("min = [-1.0, -1.0]", "min = [-1.0, -4.0]")
        .replace("size = 0.1", "size = 0.15")
        .replace("center = [0.1, 0.2]", "center = [0.5, 0.6]")
        .replace("density = 2.0", "density = 3.0")
        .replace(
            "{ wall = '1 h', time = 0.05, keep = 2 }",
            "{ wall = '1 h', time = 0.3, keep = 99 }",
        )
        .replace("output.fields = { time = 0.02 }", "output.fields = 'never'")
        .replace("step = 0.01, end = 0.4", "step = 0.03, end = 3.6");
    std::fs::write(directory.join("case.toml"), text).unwrap();
    let whole = run(directory, "whole", &[]);
    assert_eq!(whole.status.code(), Some(0), "{}", told(&whole));
    let read = |file: String| std::fs::read_to_string(directory.join(file)).unwrap();
    let steps = |out: &str| -> Vec<u64> {
        let log = read(format!("{out}/log.jsonl"));
        let events =
            log.lines().map(|line| serde_json::from_str::<serde_json::Value>(line).unwrap());
        let remeshed = events.filter(|event| event["fields"]["message"] == "remeshed");
        remeshed.map(|event| event["fields"]["step"].as_u64().unwrap()).collect()
    };
    let remeshed = steps("whole");
    assert!(remeshed.len() >= 3, "{remeshed:?}");
    let last = results(&directory.join("whole"));
    // From a state between each two meshes
    let mut resumed = 0;
    for pair in remeshed.windows(2) {
        let states = std::fs::read_dir(directory.join("whole/checkpoints")).unwrap();
        let step =
            |path: &Path| path.file_stem().unwrap().to_str().unwrap().parse::<u64>().unwrap();
        let between = states
            .map(|entry| entry.unwrap().path())
            .find(|path| (pair[0] + 1..=pair[1]).contains(&step(path)));
        let Some(state) = between else { continue };
        let out = format!("from-{}", step(&state));
        let from = run(directory, &out, &["--resume", state.to_str().unwrap()]);
        assert_eq!(from.status.code(), Some(0), "{}", told(&from));
        assert!(results(&directory.join(&out)) == last, "resumed from {}", state.display());
        resumed += 1;
    }
    assert!(resumed >= 2, "{resumed} between {remeshed:?}");
}
