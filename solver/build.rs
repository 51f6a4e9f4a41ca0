//! Embeds `cases/*/case.toml` in the program, and what is known of the build for provenance.

use std::error::Error;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

fn main() -> Result<(), Box<dyn Error>> {
    tell_build();
    let cases = Path::new(&env::var("CARGO_MANIFEST_DIR")?).join("../cases");
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed={}", cases.display());

    let mut folders: Vec<PathBuf> = Vec::new();
    if cases.is_dir() {
        for entry in fs::read_dir(&cases)? {
            folders.push(entry?.path());
        }
    }
    folders.sort();

    let mut table = String::from("/// Shipped cases, by name.\nstatic SHIPPED: &[Shipped] = &[\n");
    for folder in folders {
        let file = folder.join("case.toml");
        let Some(name) = folder.file_name().and_then(|name| name.to_str()) else { continue };
        if !file.is_file() {
            continue;
        }
        let path = format!("cases/{name}/case.toml");
        let text = file.canonicalize()?;
        writeln!(
            table,
            "    Shipped {{ name: {name:?}, file: {path:?}, text: include_str!({text:?}) }},"
        )?;
    }
    table.push_str("];\n");
    fs::write(Path::new(&env::var("OUT_DIR")?).join("shipped_cases.rs"), table)?;
    Ok(())
}

/// Sets ALEWIFE_GIT, ALEWIFE_RUSTC and ALEWIFE_TARGET where they are known: not in a tarball,
/// whose builder may set ALEWIFE_GIT.
fn tell_build() {
    let root = Path::new("..");
    println!("cargo::rerun-if-env-changed=ALEWIFE_GIT");
    if root.join(".git/logs/HEAD").is_file() {
        println!("cargo::rerun-if-changed=../.git/logs/HEAD");
    }
    let output = |program: &str, arguments: &[&str]| {
        let output = Command::new(program).args(arguments).current_dir(root).output().ok()?;
        let text = String::from_utf8(output.stdout).ok()?;
        (output.status.success()).then(|| text.trim().to_owned())
    };
    let git = env::var("ALEWIFE_GIT")
        .ok()
        .or_else(|| output("git", &["describe", "--always", "--dirty", "--tags"]));
    let rustc = env::var("RUSTC").ok().and_then(|rustc| output(&rustc, &["--version"]));
    let known = [("GIT", git), ("RUSTC", rustc), ("TARGET", env::var("TARGET").ok())];
    for (name, value) in known {
        if let Some(value) = value {
            println!("cargo::rustc-env=ALEWIFE_{name}={value}");
        }
    }
}
