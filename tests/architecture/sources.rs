//! The source files of all crates.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the package is in the root").to_owned()
}

/// All source files below a folder, by path relative to the root.
pub fn sources(folder: &str) -> BTreeMap<String, String> {
    fn collect(folder: &Path, found: &mut BTreeMap<String, String>) {
        for entry in fs::read_dir(folder).expect("the folder exists") {
            let path = entry.expect("the entry is readable").path();
            if path.is_dir() {
                collect(&path, found);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let name = path.strip_prefix(root()).expect("below the root").display().to_string();
                found.insert(name, fs::read_to_string(&path).expect("the file is text"));
            }
        }
    }
    let mut found = BTreeMap::new();
    collect(&root().join(folder), &mut found);
    found
}

/// Source folders of all crates, but for the extension module of Python, whose signatures are those of Python.
pub const CRATES: [&str; 9] = [
    "interrupt/src",
    "mesh/src",
    "solver/case/src",
    "solver/core/src",
    "solver/flow/src",
    "solver/linear/src",
    "solver/reduced/src",
    "solver/solid/src",
    "solver/src",
];

/// Folders of tests beside the sources of crates.
pub const TESTS: [&str; 7] = [
    "mesh/tests",
    "solver/case/tests",
    "solver/core/tests",
    "solver/reduced/tests",
    "solver/solid/tests",
    "solver/tests",
    "tests",
];

/// The source files of all crates, by path relative to the root.
pub fn all_sources() -> impl Iterator<Item = (String, String)> {
    CRATES.into_iter().flat_map(sources)
}
