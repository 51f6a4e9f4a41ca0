//! The map in docs/architecture.md agrees with the code, and rooms use only the rooms below them.

mod circles;
mod limits;
mod long;
mod orphans;
mod sources;
mod syntax;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;

use sources::{CRATES, all_sources, root, sources};

/// The rooms of the solver, lowest first, and the rooms each may use.
const ROOMS: [(&str, &[&str]); 38] = [
    ("case", &[]),
    ("timing", &[]),
    ("space", &[]),
    ("sparse", &[]),
    ("multifrontal", &["sparse"]),
    ("multigrid", &["sparse"]),
    ("algebra", &["multifrontal", "multigrid", "sparse"]),
    ("structure", &[]),
    ("dry", &["structure"]),
    ("rod", &["dry", "structure"]),
    ("material", &[]),
    ("solid", &["material"]),
    ("search", &[]),
    ("soft", &["material", "solid"]),
    ("tier", &["search", "soft"]),
    ("tree", &[]),
    ("time", &["case"]),
    ("body", &["time"]),
    ("contact", &["body"]),
    ("gait", &["body", "case", "structure"]),
    ("flow", &["algebra", "space"]),
    ("coupling", &["algebra", "body", "flow", "gait", "space", "structure", "time", "timing"]),
    ("scalar", &["algebra", "space", "time"]),
    ("tracer", &[]),
    ("state", &["body", "contact", "coupling", "scalar", "space", "time", "tracer"]),
    ("motion", &["algebra", "body", "contact", "coupling", "scalar", "space", "state", "time"]),
    (
        "step",
        &[
            "algebra",
            "body",
            "case",
            "contact",
            "coupling",
            "flow",
            "motion",
            "state",
            "structure",
            "time",
            "timing",
        ],
    ),
    (
        "run",
        &[
            "algebra",
            "body",
            "case",
            "contact",
            "coupling",
            "flow",
            "gait",
            "motion",
            "rod",
            "scalar",
            "space",
            "state",
            "step",
            "structure",
            "time",
            "timing",
            "tracer",
        ],
    ),
    ("gradient", &["algebra", "body", "case", "coupling", "motion", "run", "state", "step"]),
    ("reduced", &["case", "gradient", "run"]),
    ("optimise", &["case", "gradient", "reduced"]),
    ("observer", &["body", "case", "flow", "run", "scalar", "step", "timing", "tracer"]),
    ("validation", &["case", "run"]),
    ("sweep", &["case", "observer", "run", "validation"]),
    ("runner", &["case", "observer", "run", "step", "validation"]),
    ("environment", &["case", "reduced", "run", "runner", "step"]),
    (
        "cli",
        &[
            "case",
            "gradient",
            "observer",
            "optimise",
            "reduced",
            "run",
            "runner",
            "step",
            "sweep",
            "timing",
            "validation",
        ],
    ),
    ("main", &["cli"]),
];

/// Foreign crates that may be named in some rooms or files only.
const FOREIGN: [(&str, &[&str]); 10] = [
    (
        "num_dual",
        &[
            "solver/case/src/spec/body/given/midline.rs",
            "solver/case/src/spec/formula/",
            "solver/core/src/coupling/turning_base.rs",
            "solver/core/src/gait/",
            "solver/reduced/src/tree/",
            "solver/solid/src/material/",
            "solver/solid/src/rod/",
        ],
    ),
    (
        "faer",
        &[
            "solver/linear/src/algebra/",
            "solver/linear/src/multifrontal/",
            "solver/solid/src/solid/cholesky.rs",
        ],
    ),
    ("basin", &["solver/reduced/src/search/minimise.rs", "solver/reduced/src/search/methods.rs"]),
    ("pulp", &["solver/flow/src/flow/", "solver/linear/src/multifrontal/"]),
    ("metis_sys", &["solver/linear/src/multifrontal/ordering/metis.rs"]),
    ("spade", &["mesh/src/planar/generate/"]),
    ("mcap", &["solver/src/observer/"]),
    ("clap", &["solver/src/cli/"]),
    ("indicatif", &["solver/src/observer/"]),
    ("roxmltree", &["solver/src/reduced/exchange/read/"]),
];

/// The room of a file of the solver: the crate of case files is one, all others are folders of their
/// crates, or files at the top.
fn room(file: &str) -> Option<&str> {
    if file.starts_with("solver/case/src/") {
        return Some("case");
    }
    let inside = CRATES.into_iter().find_map(|folder| file.strip_prefix(folder))?;
    let room = inside.split('/').nth(1)?;
    Some(room.trim_end_matches(".rs"))
}

#[test]
fn rooms_use_only_the_rooms_below_them() {
    let rules: BTreeMap<_, _> = ROOMS.into_iter().collect();
    let mut wrong = Vec::new();
    for (file, text) in all_sources().filter(|(file, _)| file.starts_with("solver/")) {
        // The crate of cases has rooms of its own, and can use no other crate of the solver
        let Some(room) = room(&file).filter(|room| !["lib", "case"].contains(room)) else {
            continue;
        };
        let allowed = rules.get(room);
        for (number, line) in text.lines().enumerate() {
            for used in line.split("crate::").skip(1) {
                let used = used.split(|c: char| !c.is_ascii_lowercase() && c != '_').next();
                let Some(used) = used.filter(|used| rules.contains_key(used)) else { continue };
                if used != room && !allowed.is_some_and(|allowed| allowed.contains(&used)) {
                    wrong.push(format!("{file}:{}: `{room}` may not use `{used}`", number + 1));
                }
            }
        }
        if allowed.is_none() {
            wrong.push(format!("{file}: `{room}` is no known room"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn foreign_crates_are_named_where_they_live_only() {
    let mut wrong = Vec::new();
    for (file, text) in all_sources() {
        for (name, homes) in FOREIGN {
            let uses = text.lines().any(|line| {
                line.trim_start().starts_with(&format!("use {name}::"))
                    || (!line.trim_start().starts_with("//")
                        && line.contains(&format!(" {name}::")))
            });
            if uses && !homes.iter().any(|home| file.starts_with(home)) {
                wrong
                    .push(format!("{file} names `{name}`, which lives in {}", homes.join(" and ")));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Each file's first line is its row in the map. To write the map again:
/// `ALEWIFE_UPDATE=1 cargo test --release -p tests --test whole architecture::`.
#[test]
fn the_map_agrees_with_the_first_line_of_each_file() {
    let page = root().join("docs/architecture.md");
    let text = fs::read_to_string(&page).expect("docs/architecture.md exists");
    let (begin, end) = ("<!-- map: begin -->\n", "<!-- map: end -->");
    let mut table = String::from("| File | What lives there |\n|---|---|\n");
    for (file, text) in all_sources() {
        let first = text.lines().next().unwrap_or_default();
        let sentence = first.strip_prefix("//! ").unwrap_or_else(|| {
            panic!("{file}: a file opens with `//! ` and a sentence, not `{first}`")
        });
        writeln!(table, "| `{file}` | {sentence} |").expect("a string takes all");
    }
    let start = text.find(begin).expect("the page marks the map's beginning") + begin.len();
    let stop = text.find(end).expect("the page marks the map's end");
    if std::env::var_os("ALEWIFE_UPDATE").is_some() {
        let updated = format!("{}{table}{}", &text[..start], &text[stop..]);
        fs::write(&page, updated).expect("the page can be written");
    } else {
        assert_eq!(&text[start..stop], table, "see this test's comment for how to update the map");
    }
}

/// A source is cited as `@key`, with the key in docs/references.bib.
#[test]
fn every_citation_has_its_entry() {
    let bibliography =
        fs::read_to_string(root().join("docs/references.bib")).expect("the bibliography exists");
    let mut texts: BTreeMap<String, String> = all_sources().chain(sources("tests")).collect();
    for page in fs::read_dir(root().join("docs")).expect("docs exists") {
        let path = page.expect("the entry is readable").path();
        if path.extension().is_some_and(|extension| extension == "md") {
            let text = fs::read_to_string(&path).expect("the page is text");
            texts.insert(path.display().to_string(), text);
        }
    }
    let mut wrong = Vec::new();
    for (file, text) in texts {
        for cited in text.split('@').skip(1) {
            let key: String = cited.chars().take_while(char::is_ascii_alphanumeric).collect();
            let is_key = key.len() > 5 && key.chars().rev().take(4).all(|c| c.is_ascii_digit());
            if is_key && !bibliography.contains(&format!("{{{key},")) {
                wrong.push(format!("{file} cites @{key}, which docs/references.bib does not have"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
