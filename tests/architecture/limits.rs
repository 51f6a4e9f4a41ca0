//! Functions, files, folders and signatures stay small enough to be read.

use std::collections::BTreeMap;

use super::sources::{all_sources, sources};
use super::syntax::parsed;

/// Lines of a file.
const FILE: usize = 400;

/// Source files of a folder, its door `mod.rs` or `lib.rs` included.
const FOLDER: usize = 15;

#[test]
fn functions_are_short_and_their_signatures_plain() {
    let files = all_sources().map(|(file, _)| file).filter(|file| !file.ends_with("tests.rs"));
    let wrong: Vec<&str> =
        files.flat_map(|file| &parsed(&file).wrong).map(String::as_str).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn files_are_short() {
    let mut wrong = Vec::new();
    for folder in ["interrupt", "mesh", "solver", "tests"] {
        for (file, text) in sources(folder) {
            let lines = text.lines().count();
            if lines > FILE {
                wrong.push(format!("{file} has {lines} lines"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn folders_have_few_files() {
    let all: Vec<String> = ["interrupt", "mesh", "solver", "tests"]
        .into_iter()
        .flat_map(sources)
        .map(|(file, _)| file)
        .collect();
    let mut n_files = BTreeMap::<&str, usize>::new();
    for file in &all {
        let (folder, _) = file.rsplit_once('/').expect("a file lies in a folder");
        *n_files.entry(folder).or_default() += 1;
    }
    let crowded: Vec<_> = n_files.iter().filter(|&(_, &n_files)| n_files > FOLDER).collect();
    assert!(crowded.is_empty(), "more than {FOLDER} files: {crowded:?}");
}
