//! Names on pages exist: of the code in docs/architecture.md, of keys and words in docs/case-file.md.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use alewife_core::case::{LoadLaw, schema};

use super::{all_sources, case_names, root, terms, text};

/// Sides of domains, commands and files of a run, which the page of case files names, too.
const BESIDE_KEYS: [&str; 11] =
    ["back", "bottom", "front", "left", "right", "top", "check", "run", "csv", "msh", "toml"];

fn is_part(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

/// The identifiers of a source file, comments and texts aside.
fn identifiers(source: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for line in source.lines() {
        let code = line.split("//").next().unwrap_or_default();
        for piece in code.split('"').step_by(2) {
            found.extend(piece.split(|c| !is_part(c)).map(str::to_owned));
        }
    }
    found
}

/// All files and folders below a folder, as paths from the root that leave `src` out.
fn add_paths(folder: &Path, found: &mut Vec<String>) {
    for entry in fs::read_dir(folder).expect("the folder exists") {
        let path = entry.expect("the entry is readable").path();
        if path.is_dir() {
            add_paths(&path, found);
        }
        let short = path.strip_prefix(root()).expect("it is below the root").display().to_string();
        found.push(format!("/{}/", short).replace("/src/", "/"));
    }
}

/// What of a page in backticks looks like a name of the code or a path, and is none.
fn unknown(page: &str, names: &BTreeSet<String>, paths: &[String]) -> Vec<String> {
    let is_path = |term: &&String| {
        let is_plain = term.chars().all(|c| is_part(c) || "./-".contains(c));
        is_plain && (term.contains('/') || term.ends_with(".rs"))
    };
    let is_name = |term: &&String| {
        let mut parts = term.split("::");
        parts.all(|part| part.chars().all(is_part) && part.starts_with(|c: char| !c.is_numeric()))
    };
    let is_missing = |term: &&String| {
        if is_path(term) && !term.contains("NAME") {
            let short = format!("/{}/", term.trim_end_matches('/')).replace("/src/", "/");
            return !paths.iter().any(|path| path.ends_with(&short));
        }
        is_name(term) && !term.split("::").all(|part| names.contains(part))
    };
    terms(page).iter().filter(is_missing).cloned().collect()
}

/// The map is made of the files themselves, so that the prose before it is what can be wrong.
#[test]
fn names_and_paths_of_the_architecture_exist() {
    // Packages and crates are in no source file.
    let mut names: BTreeSet<String> = ["core", "benches"].map(str::to_owned).into();
    let mut paths = Vec::new();
    for folder in ["cases", "docs", "interrupt", "mesh", "postprocess", "solver", "tests"] {
        paths.push(format!("/{folder}/"));
        add_paths(&root().join(folder), &mut paths);
    }
    for path in all_sources() {
        names.extend(identifiers(&fs::read_to_string(path).expect("the file is text")));
    }
    let page = text("docs/architecture.md");
    let prose = page.split("<!-- map: begin -->").next().unwrap_or_default();
    assert!(terms(prose).len() > 100, "{} terms", terms(prose).len());
    let missing = unknown(prose, &names, &paths);
    assert!(missing.is_empty(), "docs/architecture.md names {missing:?}: they do not exist");

    let wrong = "`State::acept`, `lost()`, `mesh/src/no.rs`, `no_such_function`, `State`";
    let wrong = unknown(wrong, &names, &paths);
    assert_eq!(wrong, ["State::acept", "mesh/src/no.rs", "no_such_function"]);
}

/// The keys of all tables of the schema, and the words some of them take.
fn keys_and_words() -> BTreeSet<String> {
    let schema: serde_json::Value = serde_json::from_str(schema()).unwrap();
    let mut found = BTreeSet::new();
    let mut left = vec![&schema];
    while let Some(value) = left.pop() {
        if let Some(items) = value.as_array() {
            left.extend(items);
        }
        let Some(object) = value.as_object() else { continue };
        let properties = object.get("properties").and_then(|value| value.as_object());
        found.extend(properties.into_iter().flat_map(|keys| keys.keys().cloned()));
        found.extend(object.get("const").and_then(|word| word.as_str()).map(str::to_owned));
        let list = object.get("enum").and_then(|list| list.as_array());
        found.extend(list.into_iter().flatten().filter_map(|w| w.as_str()).map(str::to_owned));
        left.extend(object.values());
    }
    found
}

/// docs/keys.md is made of the schema and has them all; here it is the explanations that may go stale.
#[test]
fn every_key_that_the_page_of_case_files_names_exists() {
    let page = text("docs/case-file.md");
    let mut known = keys_and_words();
    assert!(known.len() > 150, "{known:?}");
    known.extend(BESIDE_KEYS.map(str::to_owned));
    known.extend(case_names());
    for law in [LoadLaw::Links, LoadLaw::Resistive, LoadLaw::Ellipsoid] {
        known.extend(law.coefficients().iter().map(|one| one.name.to_owned()));
    }
    let (before, rest) = page.split_once("<!-- quantities: begin -->").expect("it has quantities");
    let (quantities, after) = rest.split_once("<!-- quantities: end -->").expect("they end");
    for term in terms(quantities) {
        known.extend(term.split('.').map(str::to_owned));
    }
    let is_key = |term: &&String| {
        let is_plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || "_-.".contains(c);
        term.len() > 1
            && term.chars().all(is_plain)
            && term.starts_with(|c: char| c.is_alphabetic())
    };
    let is_missing = |term: &&String| {
        let last = term.rsplit('.').next().unwrap_or_default();
        // `body.1` is the second body.
        last.parse::<usize>().is_err() && !known.contains(last)
    };
    let named = terms(&format!("{before}{after}"));
    let missing: Vec<_> = named.iter().filter(is_key).filter(is_missing).collect();
    assert!(named.len() > 150, "{} terms", named.len());
    assert!(missing.is_empty(), "docs/case-file.md names {missing:?}: no key, word or quantity");
}
