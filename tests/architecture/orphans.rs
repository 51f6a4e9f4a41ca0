//! Every source file is a module of something: one that is not is never compiled, and its tests never run.

use super::sources::{CRATES, TESTS, sources};

#[test]
fn every_file_is_a_module() {
    let all: std::collections::BTreeMap<String, String> =
        CRATES.into_iter().chain(TESTS).chain(["mesh/examples"]).flat_map(sources).collect();
    let is_root = |name: &str| ["lib.rs", "main.rs"].contains(&name);
    let mut orphans = Vec::new();
    for file in all.keys().filter(|file| !file.starts_with("mesh/examples/")) {
        let (mut folder, mut name) = file.rsplit_once('/').expect("a file lies in a folder");
        if is_root(name) {
            continue;
        }
        let file_name = name;
        if name == "mod.rs" {
            (folder, name) = folder.rsplit_once('/').expect("a room lies in a crate");
        }
        let name = name.trim_end_matches(".rs");
        let parents = ["mod.rs", "lib.rs", "main.rs"].map(|parent| format!("{folder}/{parent}"));
        let parents = parents.into_iter().chain([format!("{folder}.rs")]);
        let is_declared = |text: &String| {
            text.lines().map(str::trim).any(|line| line.ends_with(&format!("mod {name};")))
        };
        let is_module = parents.filter_map(|parent| all.get(&parent)).any(is_declared);
        let path = format!("/{file_name}\"]");
        let is_named = || all.values().any(|text| text.contains("#[path") && text.contains(&path));
        if !is_module && !is_named() {
            orphans.push(file);
        }
    }
    assert!(orphans.is_empty(), "no module: {orphans:#?}");
}
