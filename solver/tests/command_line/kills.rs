//! Runs that are killed again and again, and end with the bytes of those that are not.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use super::{DISC, FLUID};

/// Threads of the parts of a run, in turn.
const THREADS: [&str; 3] = ["1", "2", "3"];

const MESH: &str = "
mesh = { size = 0.15, surface = 0.05 }
output.checkpoint = { wall = '0.05 s', keep = 2 }
";

/// Steady steps with earlier factors, a mesh that is replaced, contact, and adaptive steps.
fn cases() -> [String; 4] {
    let held = DISC.replace("'free'", "'held'");
    let fluid = format!("{FLUID}{MESH}");
    let along = fluid.replace(
        "left = 'no-slip', right = 'no-slip'",
        "left = { velocity = { value = [1.0, 0.0] } }, right = 'do-nothing'",
    );
    let steps = |step: f64, end: f64| format!("time.unsteady = {{ step = {step}, end = {end} }}\n");
    let contact = "contact.barrier = { range = 0.1, stiffness = 50.0 }\n";
    let adaptive = "time.unsteady = { step = 0.01, end = 0.6, adaptive = { tolerance = 5e-3, largest = 0.03 } }\n";
    [
        format!("{along}{}{held}", steps(0.02, 2.4)),
        format!("{fluid}{}{DISC}", steps(0.01, 0.5)),
        format!(
            "{fluid}{}{contact}{}",
            steps(0.01, 0.5),
            DISC.replace("[0.1, 0.2]", "[0.1, -0.6]")
        ),
        format!("{fluid}{adaptive}{contact}{DISC}"),
    ]
}

fn run(directory: &Path, out: &str, threads: &str) -> Command {
    let mut run = Command::new(env!("CARGO_BIN_EXE_alewife"));
    run.args(["run", "case.toml", "--out", out, "--continue", "--quiet", "--threads", threads]);
    run.current_dir(directory).stdout(Stdio::null()).stderr(Stdio::piped());
    run
}

/// What a run left of its series, and of its last state.
fn end(directory: &Path, out: &str) -> [Vec<u8>; 2] {
    let out = directory.join(out);
    let states = std::fs::read_dir(out.join("checkpoints")).unwrap();
    let last = states.map(|entry| entry.unwrap().path()).max().unwrap();
    [out.join("series.csv"), last].map(|path| std::fs::read(path).unwrap())
}

/// Kills runs of all cases, so many in all; how many of the runs that ended had resumed.
fn kill(n: usize) -> usize {
    let (mut kills, mut resumed, mut random) = (0, 0, 1_u64);
    for (index, text) in cases().into_iter().enumerate() {
        let place = tempfile::tempdir().unwrap();
        let directory = place.path();
        std::fs::write(directory.join("case.toml"), text).unwrap();
        let started = std::time::Instant::now();
        let whole = run(directory, "whole", "1").output().unwrap();
        assert!(whole.status.success(), "{}", String::from_utf8_lossy(&whole.stderr));
        let longest = started.elapsed().as_millis();
        let due = n * (index + 1) / 4;
        let mut round = 0;
        while kills < due {
            let out = format!("killed-{round}");
            round += 1;
            let is_given_up;
            loop {
                // Each part on another number of threads
                let mut running = run(directory, &out, THREADS[kills % 3]).spawn().unwrap();
                // A linear congruential generator (Knuth, MMIX): the same moments in each test
                random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                let wait = u64::try_from(u128::from(random >> 33) % (longest / 2)).unwrap();
                std::thread::sleep(Duration::from_millis(wait));
                if kills < due && running.try_wait().unwrap().is_none() {
                    running.kill().unwrap();
                    running.wait().unwrap();
                    kills += 1;
                    continue;
                }
                let output = running.wait_with_output().unwrap();
                let told = String::from_utf8_lossy(&output.stderr);
                // Three kills before the first checkpoint after a restart: it is not restarted again
                is_given_up = output.status.code() == Some(76);
                assert!(is_given_up || output.status.success(), "{told}");
                break;
            }
            if is_given_up {
                continue;
            }
            let log = std::fs::read_to_string(directory.join(&out).join("log.jsonl")).unwrap();
            resumed += usize::from(log.contains("\"resumed\""));
            let [one, other] = [&out[..], "whole"].map(|out| end(directory, out));
            let same = [0, 1].map(|file| one[file] == other[file]);
            assert_eq!(same, [true; 2], "case {index}, {out}: series and state");
        }
    }
    println!("{kills} kills, {resumed} runs resumed");
    resumed
}

#[test]
fn kills_leave_no_trace() {
    let resumed = kill(12);
    assert!(resumed >= 1, "none of the runs resumed from a checkpoint");
}

#[test]
#[ignore = "long: minutes; small: kills_leave_no_trace"]
fn fifty_kills_leave_no_trace() {
    let resumed = kill(50);
    assert!(resumed >= 4, "{resumed} of the runs resumed from a checkpoint");
}
