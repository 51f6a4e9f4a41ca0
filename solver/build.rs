//! What is known of the build, for provenance.

use std::env;
use std::path::Path;
use std::process::Command;

/// Sets ALEWIFE_GIT, ALEWIFE_RUSTC and ALEWIFE_TARGET where they are known: not in a tarball,
/// whose builder may set ALEWIFE_GIT.
fn main() {
    let root = Path::new("..");
    println!("cargo::rerun-if-env-changed=ALEWIFE_GIT");
    let output = |program: &str, arguments: &[&str]| {
        let output = Command::new(program).args(arguments).current_dir(root).output().ok()?;
        let text = String::from_utf8(output.stdout).ok()?;
        (output.status.success()).then(|| text.trim().to_owned())
    };
    // In a second working tree `.git` is a file that says where the log is
    let log = output("git", &["rev-parse", "--git-path", "logs/HEAD"]).map(|log| root.join(log));
    if let Some(log) = log.filter(|log| log.is_file()) {
        println!("cargo::rerun-if-changed={}", log.display());
    }
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
