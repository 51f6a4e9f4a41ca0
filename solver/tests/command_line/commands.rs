//! Cases that wait for commands: refused by themselves, repeated from what was recorded.

use std::path::Path;

use super::{DISC, FLUID, alewife, done};

/// What is asked of the load of the disc, in steps and within one.
const COMMANDS: &str = "time,command,target
# Written by hand
0.0,disc.load,1.0
0.05,disc.load,-0.5
0.125,,
0.15,disc.load,0.25
";

fn place() -> tempfile::TempDir {
    let place = tempfile::tempdir().unwrap();
    let case = format!(
        "{FLUID}mesh = {{ size = 0.5, surface = 0.2 }}\ntime.unsteady = {{ step = 0.05, end = 0.25 }}\n{DISC}\
         force = [4.0, 0.0]\nload_factor.command = {{ limits = [-1.0, 1.0], filter = 0.02 }}\n"
    );
    std::fs::write(place.path().join("disc.toml"), case).unwrap();
    std::fs::write(place.path().join("commands.csv"), COMMANDS).unwrap();
    place
}

/// A run that repeats the commands into a directory.
fn repeat<'a>(out: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let replay = ["run", "disc.toml", "--quiet", "--threads", "1", "--replay", "commands.csv"];
    [&replay[..], &["--out", out], more].concat()
}

fn read(place: &Path, file: &str) -> String {
    std::fs::read_to_string(place.join(file)).unwrap()
}

#[test]
fn what_is_recorded_is_repeated_and_goes_on_where_it_ended() {
    let place = place();
    let at = place.path();
    done(at, &repeat("whole", &[]));
    let series = read(at, "whole/series.csv");
    // A step ends where it pauses
    assert!(series.lines().any(|row| row.starts_with("0.125,")), "{series}");
    done(at, &repeat("part", &["--set", "time.unsteady.end=0.1"]));
    done(at, &repeat("part", &["--continue"]));
    assert_eq!(read(at, "part/series.csv"), series);
    // Its own record is as good, and so is that of a part
    std::fs::copy(at.join("whole/commands.csv"), at.join("commands.csv")).unwrap();
    done(at, &repeat("again", &[]));
    assert_eq!(read(at, "again/series.csv"), series);
    assert_eq!(read(at, "again/commands.csv"), read(at, "whole/commands.csv"));
    // Another past
    std::fs::write(at.join("commands.csv"), COMMANDS.replace("0.05,disc.load,-0.5", "0.05,,"))
        .unwrap();
    std::fs::remove_dir_all(at.join("part")).unwrap();
    done(at, &repeat("part", &["--set", "time.unsteady.end=0.1"]));
    std::fs::write(at.join("commands.csv"), COMMANDS).unwrap();
    let other = alewife(at, &repeat("part", &["--continue"]));
    let said = String::from_utf8_lossy(&other.stderr).into_owned();
    assert_eq!(other.status.code(), Some(65), "{said}");
    assert!(said.contains("is not what is recorded"), "{said}");
}

#[test]
fn what_nobody_commands_and_what_is_no_record_is_refused() {
    let place = place();
    let at = place.path();
    let refused = |arguments: &[&str], code: i32, wanted: &[&str]| {
        let output = alewife(at, arguments);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{said}");
        wanted.iter().for_each(|text| assert!(said.contains(text), "{said}"));
        assert!(!at.join("out").exists());
    };
    let by_itself = ["run", "disc.toml", "--out", "out"];
    refused(&by_itself, 65, &["disc.toml:", "`disc.load` waits", "--replay commands.csv"]);
    for (commands, wanted) in [
        ("0.0,disc.lode,1", "did you mean disc.load?"),
        ("0.0,disc.load,nan", "line 2: target is `nan`; write a finite number"),
        ("0.2,disc.load,1\n0.1,disc.load,1", "line 3: time 0.1 comes after 0.2"),
    ] {
        std::fs::write(at.join("commands.csv"), format!("time,command,target\n{commands}\n"))
            .unwrap();
        refused(&repeat("out", &[]), 65, &["--replay commands.csv: ", wanted]);
    }
    std::fs::remove_file(at.join("commands.csv")).unwrap();
    refused(&repeat("out", &[]), 66, &["--replay commands.csv: "]);
    for (key, value, wanted) in [
        ("limits", "[1.0, -1.0]", "write limits = [lowest, highest]"),
        ("start", "2.0", "is not within the limits"),
        ("filter", "0.0", "filter"),
        ("filter", "-1.0", "filter"),
        ("rate", "0.0", "rate"),
        ("start", "nan", "finite"),
    ] {
        let setting = format!("body.0.load_factor.command.{key}={value}");
        refused(&["check", "--no-mesh", "disc.toml", "--set", &setting], 65, &[wanted]);
    }
    let said = done(at, &["check", "--no-mesh", "disc.toml"]);
    assert!(said.contains("commands   disc.load"), "{said}");
}
