//! Several processes on one sweep, some of them killed: each point is run to its end once, and nobody fails.
#![cfg(unix)]

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use crate::command_line::{alewife, done};

/// A run of a few milliseconds.
const TINY: &str = "
title = 'tiny'
geometry = 'planar'
fluid = { model = 'stokes', viscosity = 1.0 }
domain.box = { min = [-4.0, -4.0], max = [4.0, 4.0] }
boundary = { left = 'no-slip', right = 'no-slip', top = 'no-slip', bottom = 'no-slip' }
mesh = { size = 2.0, surface = 0.3, growth = 0.8 }
time.unsteady = { step = 0.1, end = 0.3 }
[[body]]
name = 'a'
shape.disc.radius = 0.5
center = [0.0, 0.0]
motion = 'free'
force = [1.0, 0.0]
";
const VALUES: &str = "fluid.viscosity=1:2:6";

fn sweep(directory: &Path, out: &str) -> Child {
    let mut sweep = Command::new(env!("CARGO_BIN_EXE_alewife"));
    sweep.args(["sweep", "run", "tiny.toml", "--out", out, "--set", VALUES, "--jobs", "1", "-q"]);
    sweep.current_dir(directory).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

/// How often processes have run a point to its end.
fn n_ended(point: &Path) -> usize {
    let text = fs::read(point.join("provenance.json")).unwrap();
    let provenance: serde_json::Value = serde_json::from_slice(&text).unwrap();
    let legs = provenance["legs"].as_array().unwrap();
    legs.iter().filter(|leg| leg["end"] == "finished").count()
}

fn start() -> tempfile::TempDir {
    let place = tempfile::tempdir().unwrap();
    fs::write(place.path().join("tiny.toml"), TINY).unwrap();
    place
}

#[test]
fn processes_on_one_sweep_do_each_point_once_though_some_are_killed() {
    let place = start();
    let tables: Vec<String> = (0..4_u32)
        .map(|trial| {
            let out = format!("s{trial}");
            let mut all: Vec<Child> = (0..4).map(|_| sweep(place.path(), &out)).collect();
            let mut killed = all.swap_remove(0);
            std::thread::sleep(Duration::from_millis(u64::from(15 * trial)));
            killed.kill().unwrap();
            killed.wait().unwrap();
            for one in all {
                let ended = one.wait_with_output().unwrap();
                let told = String::from_utf8_lossy(&ended.stderr).into_owned();
                assert_eq!(ended.status.code(), Some(0), "trial {trial}: {told}");
            }
            for point in 1..=6 {
                let point = place.path().join(&out).join(format!("points/000{point}"));
                assert_eq!(n_ended(&point), 1, "{}", point.display());
            }
            let table = fs::read_to_string(place.path().join(&out).join("sweep.csv")).unwrap();
            let without_cost = |line: &str| line.rsplit_once(',').unwrap().0.to_owned();
            let cut = |line: &str| without_cost(&without_cost(&without_cost(line)));
            table.lines().map(cut).collect::<Vec<_>>().join("\n")
        })
        .collect();
    assert!(tables.iter().all(|table| *table == tables[0]), "{tables:?}");
    assert_eq!(tables[0].matches("finished").count(), 6, "{}", tables[0]);
}

#[test]
fn a_point_in_another_place_is_noticed_by_its_case() {
    let place = start();
    let points = place.path().join("s/points");
    let swap = || {
        fs::rename(points.join("0001"), points.join("x")).unwrap();
        fs::rename(points.join("0002"), points.join("0001")).unwrap();
        fs::rename(points.join("x"), points.join("0002")).unwrap();
    };
    let run = ["sweep", "run", "tiny.toml", "--out", "s", "--set", VALUES, "-q"];
    done(place.path(), &run);
    let table = fs::read_to_string(place.path().join("s/sweep.csv")).unwrap();
    swap();
    for more in [&[][..], &["--retry"], &["--index", "2"]] {
        let output = alewife(place.path(), &[&run[..], more].concat());
        let told = [output.stdout, output.stderr].concat();
        let told = String::from_utf8_lossy(&told);
        assert_eq!(output.status.code(), Some(65), "{told}");
        assert!(told.contains("the run of another case, that of point 1"), "{told}");
    }
    done(place.path(), &["sweep", "collect", "s"]);
    let wrong = fs::read_to_string(place.path().join("s/sweep.csv")).unwrap();
    assert_eq!(wrong.matches("failed").count(), 2, "{wrong}");
    // What changes nothing of what is computed may change
    swap();
    done(place.path(), &[&run[..], &["--set", "output.fields='end'"]].concat());
    assert_eq!(fs::read_to_string(place.path().join("s/sweep.csv")).unwrap(), table);
    // The run of another sweep is no point, either
    done(place.path(), &["run", "tiny.toml", "--out", "other", "-q", "-t", "1", "--overwrite"]);
    fs::rename(points.join("0006"), place.path().join("away")).unwrap();
    let other = ["run", "tiny.toml", "--out", "s/points/0006", "-q", "-t", "1"];
    done(place.path(), &[&other[..], &["--set", "fluid.viscosity=3"]].concat());
    let output = alewife(place.path(), &run);
    assert_eq!(output.status.code(), Some(65));
    let told = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(told.contains("of no point of this sweep"), "{told}");
}

#[test]
fn what_a_process_leaves_that_is_killed_at_its_start_is_taken_over() {
    let place = start();
    let run = ["run", "tiny.toml", "--out", "r", "-q", "-t", "1"];
    let make = |files: &[(&str, &str)]| {
        let _ = fs::remove_dir_all(place.path().join("r"));
        fs::create_dir(place.path().join("r")).unwrap();
        for (name, text) in files {
            fs::write(place.path().join("r").join(name), text).unwrap();
        }
    };
    let host = fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default();
    let mine = format!("process 1 on {host}");
    for files in [
        &[("lock", "")][..],
        &[("lock", mine.as_str())],
        &[("lock", mine.as_str()), (".unfinished-Ab12", "This dir")],
    ] {
        make(files);
        done(place.path(), &run);
        assert!(!place.path().join("r/.unfinished-Ab12").exists());
    }
    // Of a sweep, too
    let sweep = ["sweep", "run", "tiny.toml", "--out", "r", "--set", VALUES, "-q"];
    make(&[("lock", mine.as_str())]);
    done(place.path(), &sweep);
    for files in [&[("lock", "my thesis")][..], &[("lock", ""), ("thesis.tex", "")]] {
        for command in [&run[..], &sweep] {
            make(files);
            let refused = alewife(place.path(), command);
            assert_eq!(refused.status.code(), Some(2));
            let kept = fs::read_to_string(place.path().join("r/lock")).unwrap();
            assert_eq!(kept, files[0].1);
        }
    }
}

#[test]
fn a_link_in_the_place_of_the_lock_is_never_followed() {
    let place = start();
    let thesis = place.path().join("thesis.tex");
    fs::write(&thesis, "my thesis").unwrap();
    let run = ["run", "tiny.toml", "--out", "r", "-q", "-t", "1"];
    done(place.path(), &run);
    let lock = place.path().join("r/lock");
    fs::remove_file(&lock).unwrap();
    std::os::unix::fs::symlink("../thesis.tex", &lock).unwrap();
    for more in [&[][..], &["--overwrite"], &["--continue"]] {
        let refused = alewife(place.path(), &[&run[..], more].concat());
        let told = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert_eq!(refused.status.code(), Some(2), "{told}");
        assert!(told.contains("r/lock is no lock of alewife"), "{told}");
        assert_eq!(fs::read_to_string(&thesis).unwrap(), "my thesis");
    }
    done(place.path(), &["status", "r"]);
}
