//! Wrong cases are refused with exit code 65, the place in the file, and a remedy.
#![expect(clippy::unwrap_used, reason = "a test that cannot write its files has failed")]

mod bodies;
mod cures;
mod domain;
mod hints;
mod keys;
mod reading;
mod references;
mod shear;
mod space;
mod swimmers;
mod time;

use std::path::Path;
use std::process::Command;

/// A case with nothing wrong in it: a disc held in a channel. Lines are counted from 1.
const RIGHT: &str = r#"title = "A disc in a channel"
geometry = "planar"

[fluid]
model = "navier-stokes"
viscosity = 0.001
density = 1.0

[domain.channel]
length = 2.2
height = 0.41

[boundary]
left = { parabolic = { peak = 0.3 } }
right = "do-nothing"
bottom = "no-slip"
top = "no-slip"

[[body]]
name = "disc"
shape = { disc = { radius = 0.05 } }
center = [0.2, 0.2]
motion = "held"

[mesh]
size = 0.1
surface = 0.02

[time.steady]

[scales]
length = 0.1
velocity = 0.2

[numbers]
reynolds = 20.0

[[probe]]
name = "drop"
point = [0.15, 0.2]
minus = [0.25, 0.2]

[[reference]]
quantity = "disc.drag_coefficient"
value = 5.579535
relative = 0.05
kind = "literature"
source = "a published benchmark"

[[variant]]
name = "slow"
set = { "boundary.left.parabolic.peak" = 0.03, "numbers.reynolds" = 2.0, "scales.velocity" = 0.02 }
"#;

struct Said {
    code: i32,
    stdout: String,
    stderr: String,
}

fn alewife(directory: &Path, arguments: &[&str]) -> Said {
    said(Command::new(env!("CARGO_BIN_EXE_alewife")).args(arguments).current_dir(directory))
}

fn said(command: &mut Command) -> Said {
    let output = command.env_remove("RUST_BACKTRACE").output().unwrap();
    Said {
        code: output.status.code().unwrap_or_else(|| panic!("{}", output.status)),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

/// Checks a text as `wrong.toml`, with more arguments behind it, within a second.
fn check(text: &str, arguments: &[&str]) -> Said {
    check_within(1, text, arguments)
}

/// The same within some seconds of CPU time, which do not depend on what else the machine does.
fn check_within(seconds: u32, text: &str, arguments: &[&str]) -> Said {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("wrong.toml"), text).unwrap();
    let mut limited = Command::new("sh");
    limited.args(["-c", &format!("ulimit -t {seconds} && exec \"$0\" \"$@\"")]);
    limited.args([env!("CARGO_BIN_EXE_alewife"), "check", "--no-mesh", "wrong.toml"]);
    said(limited.args(arguments).current_dir(directory.path()))
}

/// The right case with one stretch of it replaced.
fn edited(from: &str, to: &str) -> String {
    edited_in(RIGHT, from, to)
}

/// A right case with one stretch of it replaced.
#[track_caller]
fn edited_in(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "`{from}` is not in the right case");
    text.replacen(from, to, 1)
}

fn without_variant(text: &str) -> &str {
    text.split("[[variant]]").next().unwrap()
}

#[track_caller]
fn assert_accepted(said: &Said) {
    assert_eq!(said.code, 0, "{}{}", said.stdout, said.stderr);
}

#[track_caller]
fn assert_refused(said: &Said, wanted: &[&str]) {
    assert_eq!(said.code, 65, "{}{}", said.stdout, said.stderr);
    for text in wanted {
        assert!(said.stderr.contains(text), "`{text}` is not in:\n{}", said.stderr);
    }
}

#[track_caller]
fn refused(from: &str, to: &str, wanted: &[&str]) {
    assert_refused(&check(&edited(from, to), &[]), wanted);
}

/// The right case as an unsteady run with its disc free, and these lines of the body.
fn unsteady(lines: &str) -> String {
    without_variant(RIGHT)
        .replace("[time.steady]", "[time.unsteady]\nstep = 0.1\nend = 1.0")
        .replace("motion = \"held\"", &format!("motion = \"free\"\n{lines}"))
}
