//! References in a table are those that would stand below `[[reference]]`.
#![expect(clippy::unwrap_used, reason = "a test that cannot write its files has failed")]

use std::fs;
use std::path::{Path, PathBuf};

use alewife_case::{Case, CaseError, CaseFile, Diagnostic, Reference};

const CASE: &str = r#"
title = "a disc"
geometry = "planar"
fluid = { model = "stokes", viscosity = 1.0 }
domain.disc.radius = 5.0
boundary.wall = "no-slip"
mesh = { size = 0.5 }
time.unsteady = { step = 0.1, end = 1.0 }
[[body]]
name = "disc"
shape.disc.radius = 1.0
center = [0.0, 0.0]
motion = "held"
"#;

const VARIANTS: &str = "[[variant]]\nname = \"slow\"\n[[variant]]\nname = \"fast\"\n";

const NAMED: &str = r#"
[references]
file = "references.csv"
[references.sources]
stokes = "Stokes 1851, with \"quotes\", closed form"
"#;

const TABLE: &str = "\
variant, quantity,     minus,  statistic, at,  value, per, absolute, relative, kind, source, note
# the case itself
,        disc.force.x, ,       max,       ,    1.5,   2,   ,         1e-2,     exact,       stokes,

fast,    disc.force.y, disc.x, at,        0.5, -3,    ,    0.1,      ,         independent, by hand,\"a, \"\"b\"\"\"
";

const SINGLE: &str = r#"
[[reference]]
quantity = "disc.force.x"
statistic = "max"
value = 1.5
per = 2
relative = 1e-2
kind = "exact"
source = "Stokes 1851, with \"quotes\", closed form"
[[variant]]
name = "slow"
[[variant]]
name = "fast"
[[variant.reference]]
quantity = "disc.force.y"
minus = "disc.x"
statistic = "at"
at = 0.5
value = -3
absolute = 0.1
kind = "independent"
source = "by hand"
note = 'a, "b"'
"#;

struct Place(tempfile::TempDir);

impl Place {
    fn new(files: &[(&str, &str)]) -> Self {
        let place = Self(tempfile::tempdir().unwrap());
        for (name, text) in files {
            fs::write(place.path(name), text).unwrap();
        }
        place
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn read(&self, argument: &str, settings: &[&str]) -> Result<CaseFile, CaseError> {
        read(&self.path(argument), settings)
    }
}

fn read(path: &Path, settings: &[&str]) -> Result<CaseFile, CaseError> {
    let settings: Vec<String> = settings.iter().map(|one| (*one).to_owned()).collect();
    Case::read(path.to_str().unwrap(), &settings)
}

fn references(file: &CaseFile) -> Vec<Reference> {
    file.case().reference.clone()
}

#[test]
fn a_table_is_the_same_as_single_references() {
    let with_file = format!("{CASE}{NAMED}{VARIANTS}");
    let place = Place::new(&[
        ("table.toml", &with_file),
        ("single.toml", &format!("{CASE}{SINGLE}")),
        ("references.csv", &format!("\u{feff}{TABLE}")),
        // Windows ends lines with two characters
        ("other.csv", &TABLE.replace('\n', "\r\n")),
        ("other.toml", &with_file.replace("references.csv", "other.csv")),
    ]);
    let single = place.read("single.toml", &[]).unwrap();
    assert_eq!((single.case().reference.len(), single.case().variant[1].reference.len()), (1, 1));
    for name in ["table.toml", "other.toml"] {
        assert_eq!(place.read(name, &[]).unwrap().case(), single.case(), "{name}");
    }
    let of = |name: &str| references(&place.read(name, &[]).unwrap());
    assert_eq!(of("table.toml/fast"), of("single.toml/fast"));
    assert_eq!(of("table.toml/fast").len(), 2);
    assert_eq!(of("table.toml/slow").len(), 1);
    // The case as it is run stands for itself
    let text = single.case().to_toml().unwrap();
    assert_eq!(references(&Case::parse("c", &text, &[]).unwrap()), references(&single));
}

#[test]
fn a_table_has_uncertainties_as_numbers_and_in_per_cent() {
    let table = "quantity, value, absolute, relative, uncertainty, kind, source\n\
                 disc.force.x, 4, 1, , 0.5, literature, stokes\n\
                 disc.force.x, 4, , 0.1, 5 %, literature, stokes\n";
    let text = format!("{CASE}{NAMED}");
    let place = Place::new(&[
        ("c.toml", &text),
        ("references.csv", table),
        ("d.toml", &text.replace("references.csv", "wrong.csv")),
        ("wrong.csv", &table.replace("5 %", "5 p")),
    ]);
    let found = references(&place.read("c.toml", &[]).unwrap());
    let uncertainties = found.iter().map(|one| one.expected.uncertainty.unwrap().of(4.0));
    assert_eq!(uncertainties.collect::<Vec<_>>(), [0.5, 0.2]);
    let told = place.read("d.toml", &[]).unwrap_err().to_string();
    assert!(told.contains("wrong.csv:3") && told.contains("\"0.5 %\""), "{told}");
}

#[test]
fn a_cause_has_one_name_wherever_it_is_told() {
    let table = "quantity, value, relative, kind, source, outside, cause\n\
                 disc.force.x, 4, 0.1, literature, by hand, wall, \n\
                 disc.force.x, 4, 0.1, literature, by hand, , wall\n";
    let text = format!("{CASE}[references]\nfile = \"references.csv\"\ncauses.wall = \"a wall\"\n");
    let files = [("c.toml", text.as_str()), ("references.csv", table)];
    let found = references(&Place::new(&files).read("c.toml", &[]).unwrap());
    let told: Vec<[Option<&str>; 2]> = found
        .iter()
        .map(|one| [one.expected.outside.as_deref(), one.expected.cause.as_deref()])
        .collect();
    assert_eq!(told, [[Some("a wall"), None], [None, Some("a wall")]]);
    let typo = table.replace(", wall, ", ", wal, ");
    let files = [("c.toml", text.as_str()), ("references.csv", &typo)];
    let said = Place::new(&files).read("c.toml", &[]).unwrap_err().to_string();
    assert!(said.contains("[references.causes] has no `wal`"), "{said}");
}

#[test]
fn single_references_come_before_those_of_the_table_and_can_be_set() {
    let single = SINGLE.split("[[variant]]").next().unwrap().replace("1.5", "7.0");
    let text = format!("{CASE}{single}{NAMED}{VARIANTS}");
    let place = Place::new(&[("c.toml", &text), ("references.csv", TABLE)]);
    let values = |settings: &[&str]| -> Vec<f64> {
        let found = references(&place.read("c.toml", settings).unwrap());
        found.iter().map(|one| one.expected.value).collect()
    };
    assert_eq!(values(&[]), [7.0, 1.5]);
    assert_eq!(values(&["reference.1.value=2.5"]), [7.0, 2.5]);
    assert_eq!(values(&["reference=[]"]), [0.0; 0]);
    let refused = place.read("c.toml", &["references.file=other.csv"]).unwrap_err().to_string();
    assert!(
        refused.contains("before anything is set") && refused.contains("--set:1:1"),
        "{refused}"
    );
}

#[test]
fn who_extends_a_case_has_references_of_its_own() {
    let child = "extends = \"c.toml\"\n";
    let place = Place::new(&[
        ("c.toml", &format!("{CASE}{NAMED}{VARIANTS}")),
        ("references.csv", TABLE),
        ("none.toml", child),
        ("own.toml", &format!("{child}[references]\nfile = 'own.csv'\n")),
        ("own.csv", "quantity, value, absolute, kind, source\ndisc.force.x, 9, 1, exact, here\n"),
    ]);
    assert_eq!(references(&place.read("none.toml", &[]).unwrap()), []);
    let own = references(&place.read("own.toml", &[]).unwrap());
    assert_eq!((own.len(), own[0].expected.value), (1, 9.0));
}

#[test]
fn the_text_of_a_case_holds_its_table() {
    for (named, table) in [
        (NAMED.to_owned(), TABLE.to_owned()),
        (NAMED.to_owned(), TABLE.replace("by hand", "by '''hand'''")),
        (
            r#"references = { file = "references.csv", sources = { stokes = "S" } }
"#
            .to_owned(),
            TABLE.to_owned(),
        ),
    ] {
        let text = if named.starts_with('\n') {
            format!("{CASE}{named}{VARIANTS}")
        } else {
            format!("{named}{CASE}{VARIANTS}")
        };
        let place = Place::new(&[("c.toml", &text), ("references.csv", &table)]);
        let alone = Case::text(place.path("c.toml").to_str().unwrap()).unwrap();
        let copy = Place::new(&[("c.toml", &alone)]);
        let [file, copied] = [&place, &copy].map(|one| one.read("c.toml", &[]).unwrap());
        assert_eq!(copied.case(), file.case(), "{alone}");
        // Comments of the table are kept, too
        assert!(alone.contains("# the case itself"), "{alone}");
    }
}

#[test]
fn all_shipped_cases_are_their_own_texts() {
    for shipped in alewife_case::library::list() {
        let alone = Case::text(shipped.name).unwrap();
        let named = Case::read(shipped.name, &[]).unwrap();
        // Files of meshes are beside the case
        let copied = match Case::parse(shipped.file, &alone, &[]) {
            Ok(copied) => copied,
            Err(error) => panic!("{}: {error}", shipped.name),
        };
        assert_eq!(copied.case(), named.case(), "{}", shipped.name);
        // A reduced run is not compared with references yet
        let is_compared = !named.case().reference.is_empty() || !named.case().variant.is_empty();
        assert!(is_compared || named.case().reduced.is_some(), "{}", shipped.name);
    }
}

/// Messages of a table that is wrong, in a file and within the case: where, what and what helps.
fn wrong(table: &str) -> Vec<Diagnostic> {
    let place = Place::new(&[
        ("c.toml", &format!("{CASE}{NAMED}{VARIANTS}")),
        ("references.csv", table),
        ("d.toml", &format!("{CASE}[references]\ntable = '''\n{table}'''\n{VARIANTS}")),
    ]);
    let told = |name: &str| match place.read(name, &[]) {
        Err(CaseError::Wrong(diagnostics)) => diagnostics,
        other => panic!("{name} is not wrong: {:?}", other.map(|file| file.name)),
    };
    let (beside, within) = (told("c.toml"), told("d.toml"));
    for (one, other) in beside.iter().zip(&within) {
        assert_eq!((&one.message, &one.help), (&other.message, &other.help));
        if table.is_empty() {
            continue;
        }
        let [one, other] = [one, other].map(|it| it.location.clone().unwrap());
        assert_eq!((&one.text, one.column), (&other.text, other.column));
        assert!(one.file.ends_with("references.csv") && other.file.ends_with("d.toml"));
        assert_eq!(one.line + CASE.lines().count() + 2, other.line);
    }
    beside
}

#[test]
fn what_is_wrong_in_a_table_is_told_by_line_and_column() {
    const HEADER: &str = "quantity,     value, absolute, kind,  source\n";
    let row = "disc.force.x, 1.0,   0.1,      exact, somebody's book\n";
    for (table, place, message, help) in [
        ("", (1, 1), "the table is empty", "quantity, value, kind, source"),
        ("quantity; value\n", (1, 1), "columns between ';'", "by commas"),
        ("quantity, valu, kind, source\n", (1, 11), "no column `valu`", "did you mean `value`?"),
        ("quantity, value, value\n", (1, 18), "two columns `value`", "once"),
        ("quantity, kind, source\n", (1, 1), "has no column `value`", "needed are"),
        (&format!("{HEADER}{}", row.replace("1.0", "1,0")), (2, 1), "has 6 cells", "in quotes"),
        (&format!("{HEADER}{}", row.replace("1.0", "one")), (2, 15), "`one` is no number", "1e-3"),
        (
            &format!("{HEADER}{}", row.replace("exact", "")),
            (2, 32),
            "`kind` is empty",
            "literature",
        ),
        (
            &format!("{HEADER}{row}{}", row.replace("exact", "exakt")),
            (3, 32),
            "`exakt`",
            "`exact`?",
        ),
        (&format!("{HEADER}{}", row.replace("somebody", "\"some")), (2, 39), "no end", "twice"),
        (
            "variant, quantity, value, kind, source\nslo, a, 1, exact, its book\n",
            (2, 1),
            "no variant `slo`",
            "did you mean `slow`?",
        ),
    ] {
        let told = &wrong(table)[0];
        let location = told.location.clone().unwrap();
        assert_eq!((location.line, location.column), place, "{told}");
        assert!(told.message.contains(message) && told.help.contains(help), "{told}");
    }
    let both = wrong(&format!("{HEADER}{}{}", row.replace("1.0", "x"), row.replace("0.1", "y")));
    assert_eq!(both.len(), 2, "{both:?}");
}

#[test]
fn what_is_wrong_beside_a_table_is_told() {
    let told = |references: &str, csv: &str| {
        let text = format!("{CASE}{references}{VARIANTS}");
        let place = Place::new(&[("c.toml", &text), ("references.csv", csv)]);
        place.read("c.toml", &[]).unwrap_err().to_string()
    };
    let typo = TABLE.replace("stokes,", "stoks,");
    for (references, csv, wanted) in [
        (NAMED, typo.as_str(), ["has no `stoks`", "did you mean `stokes`?", "references.csv:3:"]),
        (
            "[references]\nfile = 'other.csv'\n",
            "",
            ["there is no file", "other.csv", "c.toml:15:8"],
        ),
        ("[references]\nfile = 'a'\ntable = 'b'\n", "", ["both `file` and", "keep one", ":16:9"]),
        ("[references]\nfil = 'a'\n", "", ["unknown key `fil`", "did you mean `file`?", ":15:1"]),
        ("[[references]]\nvalue = 1\n", "", ["an array where", "[[reference]]", "c.toml:14:"]),
        (
            "[references.sources]\n'a b' = 'c'\n",
            "",
            ["no name of a source", "stokes-1851", ":15:1"],
        ),
    ] {
        let said = told(references, csv);
        assert!(wanted.iter().all(|part| said.contains(part)), "{wanted:?}: {said}");
    }
    // Nothing is beside a text
    let text = format!("{CASE}{NAMED}{VARIANTS}");
    let alone = Case::parse("c", &text, &[]).unwrap_err().to_string();
    assert!(alone.contains("cannot be reached") && alone.contains("show CASE --source"), "{alone}");
}
