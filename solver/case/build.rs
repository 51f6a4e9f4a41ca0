//! Embeds `cases/*/case.toml`, references, meshes and surfaces beside them in the program.

use std::error::Error;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() -> Result<(), Box<dyn Error>> {
    let package = PathBuf::from(env::var("CARGO_MANIFEST_DIR")?);
    // A link to the cases, by which they are part of a published package. Where links are not checked out,
    // the cases themselves.
    let link = package.join("cases");
    let cases = if link.is_dir() { link } else { package.join("../../cases") };
    if !cases.is_dir() {
        // Else the program would have no shipped case
        return Err(format!("{} is missing: a part of the sources", cases.display()).into());
    }
    let cases = cases.canonicalize()?;
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed={}", cases.display());
    let mut folders: Vec<PathBuf> = Vec::new();
    for entry in fs::read_dir(&cases)? {
        folders.push(entry?.path());
    }
    folders.sort();

    let mut files =
        String::from("/// Files of shipped cases.\nstatic FILES: &[ShippedFile] = &[\n");
    let mut tables = [
        String::from(
            "/// Shipped cases of the full solver, by name.\nstatic SHIPPED: &[Shipped] = &[\n",
        ),
        String::from("/// Shipped soft cases, by name.\nstatic SOFT: &[Shipped] = &[\n"),
    ];
    for folder in folders {
        let file = folder.join("case.toml");
        let Some(name) = folder.file_name().and_then(|name| name.to_str()) else { continue };
        if !file.is_file() {
            continue;
        }
        for beside in named_files(&folder)? {
            let Some(file) = beside.file_name().and_then(|file| file.to_str()) else { continue };
            let path = format!("cases/{name}/{file}");
            let bytes = beside.canonicalize()?;
            writeln!(
                files,
                "    ShippedFile {{ path: {path:?}, bytes: include_bytes!({bytes:?}) }},"
            )?;
        }
        let path = format!("cases/{name}/case.toml");
        let text = file.canonicalize()?;
        // A case of an elastic body without a flow says so by its table
        let is_soft = fs::read_to_string(&text)?.lines().any(|line| line.trim_end() == "[soft]");
        writeln!(
            tables[usize::from(is_soft)],
            "    Shipped {{ name: {name:?}, file: {path:?}, text: include_str!({text:?}) }},"
        )?;
    }
    let [flow, soft] = tables;
    let text = format!("{flow}];\n{soft}];\n{files}];\n");
    fs::write(Path::new(&env::var("OUT_DIR")?).join("shipped_cases.rs"), text)?;
    Ok(())
}

/// Endings of meshes of Gmsh and of surfaces of triangles.
const NAMED: [&str; 4] = ["msh", "obj", "ply", "stl"];

/// Whether a case may name a table of this name: a recorded motion or the references.
fn is_table(name: &str) -> bool {
    name == "references.csv" || (name.starts_with("record") && name.ends_with(".csv"))
}

/// Files of a folder that its case may name: meshes, surfaces and tables.
fn named_files(folder: &Path) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let ending = path.extension().and_then(|ending| ending.to_str());
        let name = path.file_name().and_then(|name| name.to_str());
        if ending.is_some_and(|ending| NAMED.contains(&ending)) || name.is_some_and(is_table) {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}
