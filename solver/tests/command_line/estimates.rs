//! What `check` estimates, beside what runs took: CPU times of docs/validation.md, memory of a run.

use std::path::Path;
use std::time::Instant;

use super::{alewife, done};

/// What an estimate may be off by, as a factor.
const FACTOR: f64 = 1.5;

/// Part of an estimate that the mesh may take on this machine for the estimate to count.
const MESHING: f64 = 0.3;

/// Sections of this day are not counted: the machine took 1.7 to 2.8 times as long as on the days of all others.
const SLOW_DAY: &str = ", 2026-11-26.";

/// CPU time of a member by its row in docs/validation.md (s).
#[derive(Debug, Clone)]
struct Measured {
    member: String,
    seconds: f64,
}

/// All members that count, the longest first.
fn measured() -> Vec<Measured> {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/validation.md");
    let text = std::fs::read_to_string(page).unwrap();
    let mut all: Vec<Measured> = Vec::new();
    let mut case = "";
    let mut is_slow = false;
    for line in text.lines() {
        if let Some(name) = line.strip_prefix("## ") {
            case = name.trim();
            is_slow = false;
        }
        is_slow |= line.starts_with("Runs by") && line.contains(SLOW_DAY);
        if is_slow {
            continue;
        }
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        // Of a table of runs, or of values in a section of an earlier form
        let column = match cells.len() {
            9 => 6,
            13 => 11,
            _ => continue,
        };
        let Ok(seconds) = cells[column].parse::<f64>() else { continue };
        let variant = cells[1];
        let separator = if variant.is_empty() { "" } else { "/" };
        let member = format!("{case}{separator}{variant}");
        if all.last().is_none_or(|last| last.member != member) {
            all.push(Measured { member, seconds });
        }
    }
    all.sort_by(|one, other| other.seconds.total_cmp(&one.seconds));
    all
}

/// The number after a word of `check`'s table, in seconds or bytes.
fn estimate(member: &str, what: &str) -> f64 {
    let directory = tempfile::tempdir().unwrap();
    let said = done(directory.path(), &["check", member]);
    let line = said.lines().find(|line| line.trim_start().starts_with(what)).unwrap();
    let rest = line.split(what).nth(1).unwrap().trim().replace("less than a second", "0.7 s");
    let mut words = rest.split([' ', ',']);
    let number: f64 = words.next().unwrap().parse().unwrap();
    let unit = match words.next().unwrap() {
        "s" => 1.0,
        "min" => 60.0,
        "h" => 3600.0,
        "MB" => 1e6,
        "GB" => 1e9,
        other => panic!("{member}: {other} in {line}"),
    };
    number * unit
}

/// Measured over estimated CPU time.
fn ratio(measured: &Measured) -> f64 {
    measured.seconds / estimate(&measured.member, "CPU time")
}

fn is_near(ratio: f64) -> bool {
    (1.0 / FACTOR..FACTOR).contains(&ratio)
}

#[test]
fn the_cpu_time_of_a_run_is_estimated() {
    let all = measured();
    // One of each kind: fixed and moving meshes, fish, tails, links, films, contact, adaptive steps
    for member in [
        "dfg-2d-2",
        "oscillating-cylinder",
        "vortex-induced-vibration",
        "carangiform",
        "tandem-fish/distance-0.5",
        "sperm-2d/prescribed",
        "purcell-three-link/forwards",
        "robot-eel",
        "squirmer-wall/neutral",
        "squirmer-pair/neutral-re-1",
        "disc-settling/fast",
        "drafting-kissing-tumbling",
    ] {
        let row = all.iter().find(|row| row.member == member).expect(member);
        let ratio = ratio(row);
        assert!(is_near(ratio), "{member}: {} s, {ratio:.2} of the estimate", row.seconds);
    }
}

/// Every sixth of the members that docs/performance.md counts, since each is meshed. An estimate has in it what the
/// mesh takes on this machine, beside other tests, while the page is of another one: where that is a large part, the
/// ratio says nothing of the rest.
#[test]
fn most_cpu_times_are_estimated() {
    let long = measured().into_iter().filter(|row| row.seconds >= 1.2);
    let long: Vec<Measured> = long.step_by(6).collect();
    let mut ratios: Vec<f64> = Vec::new();
    for row in &long {
        let start = Instant::now();
        let estimate = estimate(&row.member, "CPU time");
        let meshing = start.elapsed().as_secs_f64();
        let ratio = row.seconds / estimate;
        let counts = meshing < MESHING * estimate;
        println!("{:45} {:8.1} s, {ratio:.2} of the estimate, {counts}", row.member, row.seconds);
        if counts {
            ratios.push(ratio);
        }
    }
    let near = ratios.iter().filter(|ratio| is_near(**ratio)).count();
    ratios.sort_by(f64::total_cmp);
    let median = ratios[ratios.len() / 2];
    println!("{near} of {} within a factor {FACTOR}, median {median:.2}", ratios.len());
    assert!(ratios.len() >= 15, "{}", ratios.len());
    // Of all, nine in ten are near; on a slow machine fewer
    assert!(near as f64 >= 0.75 * ratios.len() as f64 && (0.8..1.25).contains(&median));
}

#[test]
fn the_memory_of_a_run_is_estimated() {
    for member in ["squirmer-re/puller-5-re-5", "sphere-in-sphere-3d/moved-2"] {
        check_memory(member);
    }
}

fn check_memory(member: &str) {
    let directory = tempfile::tempdir().unwrap();
    let run = ["run", member, "--out", "run", "--threads", "1", "--quiet"];
    let output = alewife(directory.path(), &run);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let text = std::fs::read_to_string(directory.path().join("run/status.json")).unwrap();
    let status: serde_json::Value = serde_json::from_str(&text).unwrap();
    // Not every system tells
    let Some(peak) = status["peak_memory"].as_f64() else { return };
    let ratio = peak / estimate(member, "memory");
    assert!((0.75..1.33).contains(&ratio), "{member}: {ratio:.2} of the estimate");
}
