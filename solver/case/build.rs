//! Embeds `cases/*/case.toml` in the program.

use std::error::Error;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() -> Result<(), Box<dyn Error>> {
    let cases = Path::new(&env::var("CARGO_MANIFEST_DIR")?).join("../../cases");
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
