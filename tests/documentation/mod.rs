//! The pages agree with the program: keys, quantities, examples, names, files, and the table of cases.

mod cluster;
mod generated;
mod names;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use alewife_core::case::soft::SoftFile;
use alewife_core::case::{
    BodyQuantity, Case, CaseFile, FlowQuantity, JointQuantity, NamedComponent, ProbeQuantity,
    Quantity, Reference, ReferenceKind, ScalarProbeQuantity, ScalarQuantity, ScalarSurfaceQuantity,
    Severity, SideQuantity, SwimmerQuantity, TracerQuantity, check, library,
};

/// Beginnings of paths that exist on one machine only.
const OF_ONE_MACHINE: [&str; 4] = ["/work", "/tmp", "/root", "/home"];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the package is in the root").to_owned()
}

fn text(file: &str) -> String {
    fs::read_to_string(root().join(file)).unwrap_or_else(|error| panic!("{file}: {error}"))
}

/// What stands in backticks on a page, blocks of code left out.
fn terms(page: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut is_block = false;
    for line in page.lines() {
        if line.trim_start().starts_with("```") {
            is_block = !is_block;
        } else if !is_block {
            found.extend(line.split('`').skip(1).step_by(2).map(str::to_owned));
        }
    }
    found
}

/// The blocks of code of a page in a language, each with its first line's number.
fn blocks(page: &str, language: &str) -> Vec<(usize, String)> {
    let mut found: Vec<(usize, String)> = Vec::new();
    let (mut is_block, mut is_wanted) = (false, false);
    for (number, line) in page.lines().enumerate() {
        if let Some(kind) = line.trim_start().strip_prefix("```") {
            is_block = !is_block;
            is_wanted = is_block && kind.trim() == language;
            if is_wanted {
                found.push((number + 2, String::new()));
            }
        } else if is_wanted && let Some((_, block)) = found.last_mut() {
            *block += line;
            block.push('\n');
        }
    }
    found
}

/// One table of quantities; rows that differ in their names only are one.
fn table<T>(title: &str, rows: &[Quantity<T>]) -> String {
    let mut text = format!(
        "{title}\n\n| Quantity | Unit (planar) | Only with | Meaning |\n|---|---|---|---|\n"
    );
    let numbers: Vec<NamedComponent> = rows.iter().flat_map(Quantity::components).collect();
    let is_same = |a: &NamedComponent, b: &NamedComponent| {
        (a.unit, &a.when, a.meaning) == (b.unit, &b.when, b.meaning)
    };
    for alike in numbers.chunk_by(is_same) {
        let names: Vec<String> = alike.iter().map(|one| format!("`{}`", one.name)).collect();
        let NamedComponent { unit, when, meaning, .. } = &alike[0];
        let when: Vec<&str> = when.iter().map(|condition| condition.words()).collect();
        let row = format!("| {} | {unit} | {} | {meaning} |\n", names.join(", "), when.join(", "));
        text += &row.replace("|  |", "| |");
    }
    text
}

/// To write the tables again: `ALEWIFE_UPDATE=1 cargo test --release -p tests --test whole documentation::`.
#[test]
fn the_tables_of_quantities_are_those_of_the_program() {
    let tables = [
        table("Of each body, as `NAME.` and:", BodyQuantity::TABLE),
        table("Of each [`joint`](#joint), as `CHILD.` and:", JointQuantity::TABLE),
        table(
            "Of everything that swims, a `[[swimmer]]` or a body with a gait, as `NAME.` and:",
            SwimmerQuantity::TABLE,
        ),
        table("Of each probe, as `NAME.` and:", ProbeQuantity::TABLE),
        table("Of each [`tracer`](#tracers), as `NAME.` and:", TracerQuantity::TABLE),
        table("Of each [`scalar`](#scalars), as `scalar.NAME.` and:", ScalarQuantity::TABLE),
        table(
            "Of each scalar on bodies and sides, as `scalar.NAME.BODY.` and:",
            ScalarSurfaceQuantity::TABLE,
        ),
        table("Of each scalar at probes, as `scalar.NAME.PROBE.` and:", ScalarProbeQuantity::TABLE),
        table("Of the flow, as `flow.` and:", FlowQuantity::TABLE),
        table("Of each [side](#boundary), as `SIDE.` and:", SideQuantity::TABLE),
    ];
    let tables = format!("\n{}\n", tables.join("\n"));
    let page = text("docs/case-file.md");
    let (begin, end) = ("<!-- quantities: begin -->\n", "<!-- quantities: end -->");
    let start = page.find(begin).expect("the page marks their beginning") + begin.len();
    let stop = page.find(end).expect("the page marks their end");
    if std::env::var_os("ALEWIFE_UPDATE").is_some() {
        let updated = format!("{}{tables}{}", &page[..start], &page[stop..]);
        fs::write(root().join("docs/case-file.md"), updated).expect("the page can be written");
    } else {
        assert_eq!(&page[start..stop], tables, "see this test's comment for how to update them");
    }
}

/// Reads a case, and complains about whatever `check` calls an error.
fn read_and_check(argument: &str, what: &str) -> CaseFile {
    let file = Case::read(argument, &[]).unwrap_or_else(|error| panic!("{what}\n{error}"));
    assert_right(&file, what);
    file
}

/// Complains about whatever `check` calls an error.
fn assert_right(file: &CaseFile, what: &str) {
    let errors: Vec<String> = check(file)
        .iter()
        .filter(|problem| problem.severity == Severity::Error)
        .map(ToString::to_string)
        .collect();
    assert!(errors.is_empty(), "{what}\n{}", errors.join("\n"));
}

/// Source folders of all crates.
const CRATES: [&str; 8] = [
    "mesh/src",
    "solver/case/src",
    "solver/core/src",
    "solver/flow/src",
    "solver/linear/src",
    "solver/reduced/src",
    "solver/solid/src",
    "solver/src",
];

/// All source files below a folder.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("the folder exists") {
        let path = entry.expect("the entry is readable").path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
    found
}

fn all_sources() -> impl Iterator<Item = PathBuf> {
    CRATES.into_iter().flat_map(|folder| sources(&root().join(folder)))
}

#[test]
fn every_source_file_a_page_names_exists() {
    // A page may leave out the folder of the crate
    let short = |path: &str| path.replace("/src/", "/");
    let folders = ["mesh", "solver", "tests"].map(|folder| root().join(folder));
    let files: Vec<String> = folders
        .iter()
        .flat_map(|folder| sources(folder))
        .map(|path| short(&path.display().to_string()))
        .collect();
    let (mut named, mut missing) = (0, Vec::new());
    for page in ["CONTRIBUTING.md", "architecture", "method", "notation", "output", "performance"] {
        let file = if page.ends_with(".md") { page.to_owned() } else { format!("docs/{page}.md") };
        let page = text(&file);
        for term in terms(page.split("<!-- map: begin -->").next().unwrap_or_default()) {
            if term.ends_with(".rs") || term.contains("/src/") {
                named += 1;
                if !files.iter().any(|file| file.contains(&format!("/{}", short(&term)))) {
                    missing.push(format!("{file}: {term}"));
                }
            }
        }
    }
    assert!(named > 50, "{named} files are named");
    assert!(missing.is_empty(), "these files do not exist: {missing:?}");
}

#[test]
fn every_name_of_the_notation_is_in_the_code() {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let read = |path| fs::read_to_string(path).expect("the file is text");
    let code: String = all_sources().map(read).collect();
    let known: BTreeSet<&str> = code.split(|c| !is_part(c)).collect();
    let page = text("docs/notation.md");
    // What follows are words of case files and of other programs.
    let page = page.split("## Words of other programs").next().unwrap_or_default();
    let terms = terms(page);
    let names = terms.iter().flat_map(|term| term.split(|c| !is_part(c)));
    let missing: Vec<&str> =
        names.filter(|name| !name.is_empty() && !known.contains(name)).collect();
    assert!(terms.len() > 100, "{} terms", terms.len());
    assert!(missing.is_empty(), "docs/notation.md names {missing:?}, which the code does not have");
}

#[test]
fn every_complete_example_is_right() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("documentation");
    fs::create_dir_all(&folder).expect("the folder can be made");
    let mut n_examples = 0;
    for page in ["README.md", "docs/case-file.md"] {
        for (line, block) in blocks(&text(page), "toml") {
            if !block.lines().any(|line| line.starts_with("title")) {
                continue;
            }
            let file = folder.join(format!("{}-{line}.toml", page.replace(['/', '.'], "-")));
            fs::write(&file, block).expect("the file can be written");
            let (name, what) = (file.display().to_string(), format!("{page}, line {line}"));
            for variant in read_and_check(&name, &what).variants {
                read_and_check(&format!("{name}/{variant}"), &what);
            }
            n_examples += 1;
        }
    }
    assert!(n_examples >= 5, "{n_examples} examples");
}

/// Folders of `cases/` that hold a case.
fn case_names() -> BTreeSet<String> {
    fs::read_dir(root().join("cases"))
        .expect("the folder exists")
        .map(|entry| entry.expect("the entry is readable").path())
        .filter(|path| path.join("case.toml").is_file())
        .map(|path| path.file_name().expect("it has a name").to_string_lossy().into_owned())
        .collect()
}

/// The files of the cases of `cases/` that are no soft ones, read once.
static CASES: LazyLock<BTreeMap<String, CaseFile>> = LazyLock::new(|| {
    let is_soft = |name: &String| library::soft().iter().any(|case| case.name == name);
    let read = |name: String| {
        let path = root().join("cases").join(&name).display().to_string();
        let file = Case::read(&path, &[]).unwrap_or_else(|error| panic!("{name}\n{error}"));
        (name, file)
    };
    case_names().into_iter().filter(|name| !is_soft(name)).map(read).collect()
});

/// Kinds of the references of a soft case, which is right.
fn soft_kinds(path: &str) -> String {
    let file = SoftFile::declared(path).unwrap_or_else(|error| panic!("{path}\n{error}"));
    let file = file.expect("it is a soft case");
    let wrong = alewife_core::case::soft::check(&file);
    assert!(wrong.is_empty(), "{path}: {wrong:?}");
    let known: BTreeSet<ReferenceKind> = file.case.reference.iter().map(|one| one.kind).collect();
    known.into_iter().map(ReferenceKind::name).collect::<Vec<_>>().join(", ")
}

/// Rows of the table in `cases/README.md`: name of the case, then its cells.
fn case_rows() -> BTreeMap<String, Vec<String>> {
    let mut rows = BTreeMap::new();
    for line in text("cases/README.md").lines().filter(|line| line.starts_with("| [")) {
        let cells: Vec<String> =
            line.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect();
        let name = cells[0].trim_start_matches('[').split(']').next().unwrap_or("").to_owned();
        assert_eq!(cells[0], format!("[{name}]({name}/)"), "the link of a row");
        assert!(rows.insert(name.clone(), cells).is_none(), "{name} has two rows");
    }
    rows
}

#[test]
fn the_table_of_cases_is_that_of_the_folders() {
    let rows = case_rows();
    let names: BTreeSet<String> = rows.keys().cloned().collect();
    assert_eq!(names, case_names(), "rows of cases/README.md, folders of cases/");
    for (name, cells) in rows {
        let [_, physics, kinds, source, cost] = cells.as_slice() else {
            panic!("{name}: {} cells, not 5", cells.len())
        };
        assert!([physics, source, cost].iter().all(|cell| !cell.is_empty()), "{name}");
        let Some(file) = CASES.get(&name) else {
            let path = root().join("cases").join(&name);
            assert_eq!(*kinds, soft_kinds(&path.display().to_string()), "{name}: kinds");
            continue;
        };
        assert_right(file, &name);
        let case = file.case();
        let mut references: Vec<&Reference> = case.reference.iter().collect();
        references.extend(case.variant.iter().flat_map(|variant| &variant.reference));

        let known: BTreeSet<ReferenceKind> = references.iter().map(|r| r.expected.kind).collect();
        let known: Vec<&str> = known.into_iter().map(ReferenceKind::name).collect();
        assert_eq!(*kinds, known.join(", "), "{name}: kinds of references");
    }
}

#[test]
fn every_case_has_a_page() {
    let is_bare = |name: &String| !root().join("cases").join(name).join("README.md").is_file();
    let without: Vec<String> = case_names().into_iter().filter(is_bare).collect();
    assert!(without.is_empty(), "write cases/NAME/README.md for {without:?}");
}

#[test]
fn no_page_names_a_path_of_one_machine() {
    let mut pages: Vec<String> =
        ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "postprocess/README.md"]
            .map(str::to_owned)
            .into();
    for folder in std::iter::once("docs".to_owned())
        .chain(std::iter::once("cases".to_owned()))
        .chain(case_names().iter().map(|name| format!("cases/{name}")))
    {
        for entry in fs::read_dir(root().join(&folder)).expect("the folder exists") {
            let name = entry.expect("the entry is readable").file_name();
            let name = name.to_string_lossy();
            if name.ends_with(".md") {
                pages.push(format!("{folder}/{name}"));
            }
        }
    }
    let ends_a_word = |c: char| c.is_whitespace() || "`'\"()[]{}<>=,;".contains(c);
    for page in pages {
        for (number, line) in text(&page).lines().enumerate() {
            let found = line.split(ends_a_word).find(|word| {
                OF_ONE_MACHINE.iter().any(|start| {
                    word.strip_prefix(start)
                        .is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
                })
            });
            assert!(found.is_none(), "{page}, line {}: {found:?}", number + 1);
        }
    }
}
