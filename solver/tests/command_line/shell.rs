//! Completions as bash asks for them, and the pages of the manual.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::done;

/// What bash offers for the last of some words, behind the name of the program.
fn offered(directory: &Path, words: &[&str]) -> Vec<String> {
    let script = r#"
        source <("$1" completions bash)
        shift
        COMP_WORDS=(alewife "$@") COMP_CWORD=$# COMP_TYPE=9
        _clap_complete_alewife alewife "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD - 1]}"
        printf '%s\n' "${COMPREPLY[@]}"
    "#;
    let output = Command::new("bash")
        .args(["-c", script, "bash", env!("CARGO_BIN_EXE_alewife")])
        .args(words)
        .current_dir(directory)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap().lines().map(str::to_owned).collect()
}

#[test]
fn bash_completes_commands_cases_and_variants() {
    let directory = tempfile::tempdir().unwrap();
    let of = |words: &[&str]| offered(directory.path(), words);
    assert_eq!(of(&["val"]), ["validate"]);
    assert_eq!(of(&["sweep", "ex"]), ["expand"]);
    assert_eq!(of(&["run", "--max"]), ["--max-walltime"]);
    assert_eq!(of(&["run", "squirmer-pair-i"]), ["squirmer-pair-in-line"]);
    assert_eq!(of(&["sweep", "run", "squirmer-pair-i"]), ["squirmer-pair-in-line"]);
    assert_eq!(of(&["validate", "scallop", "squirmer-pair-i"]), ["squirmer-pair-in-line"]);
    // All variants of a case, and nothing else
    let variants = alewife::case::Case::read("sphere-in-tube", &[]).unwrap().variants;
    let wanted: Vec<String> =
        variants.iter().map(|name| format!("sphere-in-tube/{name}")).collect();
    assert!(!wanted.is_empty());
    assert_eq!(of(&["show", "sphere-in-tube/"]), wanted);
    std::fs::write(directory.path().join("squirmer-pair-mine.toml"), "").unwrap();
    let found = of(&["check", "squirmer-pair-"]);
    assert!(found.contains(&"squirmer-pair-mine.toml".to_owned()), "{found:?}");
}

#[test]
fn bash_completes_keys_of_the_case_and_quantities_of_the_run() {
    let directory = tempfile::tempdir().unwrap();
    let keys = |words: &[&str]| offered(directory.path(), words);
    assert_eq!(keys(&["run", "squirmer-alone", "--set", "fluid.v"]), ["fluid.viscosity="]);
    // Tables of a list by their number, lists of numbers as a whole
    let modes = keys(&["run", "squirmer-alone", "--set", "body.0.gait."]);
    assert!(modes.contains(&"body.0.gait.squirmer.modes=".to_owned()), "{modes:?}");
    let swept = ["sweep", "run", "squirmer-alone", "--set", "fluid.v"];
    assert_eq!(keys(&swept), ["fluid.viscosity="]);
    let run = directory.path().join("runs/one");
    std::fs::create_dir_all(&run).unwrap();
    std::fs::write(run.join("series.csv"), "time,a.speed,a.load,flow.cfl\n0,1,2,3\n").unwrap();
    assert_eq!(keys(&["plot", "runs/one", "a."]), ["a.speed", "a.load"]);
    assert_eq!(keys(&["plot", "runs/one", "a.speed", "flow"]), ["flow.cfl"]);
    assert_eq!(keys(&["status", "runs/o"]), ["runs/one/"]);
}

#[test]
fn all_shells_are_told_how_to_ask() {
    let directory = tempfile::tempdir().unwrap();
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let text = done(directory.path(), &["completions", shell]);
        assert!(text.contains("ALEWIFE_COMPLETE") && text.contains("alewife"), "{shell}: {text}");
    }
}

/// Where the pages lie that are installed with the Python packages.
fn installed_pages() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../postprocess/commands/data/share/man/man1")
}

/// Names of the files in a directory.
fn names(directory: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(directory).unwrap();
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn the_installed_pages_of_the_manual_are_up_to_date() {
    let (place, shipped) = (tempfile::tempdir().unwrap(), installed_pages());
    let made = place.path().join("man1");
    if std::env::var_os("ALEWIFE_UPDATE").is_some() {
        let _ = std::fs::remove_dir_all(&shipped);
        done(place.path(), &["manual", shipped.to_str().unwrap()]);
    }
    done(place.path(), &["manual", "man1"]);
    let remedy = "ALEWIFE_UPDATE=1 cargo test --release -p alewife --test program pages";
    assert_eq!(names(&made), names(&shipped), "to write them again: {remedy}");
    for name in names(&made) {
        let of = |folder: &Path| std::fs::read_to_string(folder.join(&name)).unwrap();
        assert!(of(&made) == of(&shipped), "{name} is not up to date: {remedy}");
    }
    // One page a command, those of commands under another one included
    let pages = names(&made);
    for page in ["alewife.1", "alewife-run.1", "alewife-sweep.1", "alewife-sweep-collect.1"] {
        assert!(pages.contains(&page.to_owned()), "no {page} in {pages:?}");
    }
}
