//! Types a case: all unknown keys at once, and what only the rest of the file tells of a mistake.

mod form;

use serde::Deserialize;

use self::form::{alternative, holder, written};
use super::reference_rows::REFERENCES;
use super::schema;
use crate::Case;
use crate::text::diagnostic::{CaseError, Diagnostic, Severity};
use crate::text::meant::meant;
use crate::text::names::SWEEP;
use crate::text::nearest::nearest;
use crate::text::source::Origin;
use crate::text::tree::{TomlNode, TomlValue};
use crate::text::type_error::{Mismatch, TypeError, suggestion};
use crate::{Geometry, ReferenceKind};

/// Most diagnostics listed at once.
const MOST_DIAGNOSTICS: usize = 20;

/// Types a tree; unknown keys are noted and taken as meant, so that all of them are found at once.
pub fn typed(root: &TomlNode) -> Result<Case, CaseError> {
    let mut root = root.clone();
    let mut diagnostics: Vec<Diagnostic> = Vec::new();
    // What a key of another name holds need not be what is wanted
    let mut renamed: Vec<String> = Vec::new();
    loop {
        let error = match Case::deserialize(&root) {
            Ok(case) if diagnostics.is_empty() => return Ok(case),
            Ok(_) => return Err(CaseError::Wrong(diagnostics)),
            Err(error) => error,
        };
        let path = error.path();
        let Mismatch::UnknownKey { key, accepted } = error.mismatch() else {
            if !renamed.iter().any(|renamed| path.starts_with(renamed.as_str())) {
                diagnostics.push(told(&root, &error));
            }
            return Err(CaseError::Wrong(diagnostics));
        };
        let diagnostic = told(&root, &error);
        diagnostics.push(diagnostic);
        let (table, to) = if is_misplaced(&root, &path, key) {
            ("", Some(key.as_str()))
        } else if holder(&path, &[key]).is_some() {
            (path.as_str(), None)
        } else {
            let word = meant(key, accepted).map(|meant| meant.word);
            renamed.extend(word.map(|word| inside(&path, word)));
            (path.as_str(), word.or_else(|| nearest(key, accepted)))
        };
        let is_moved = move_key(&mut root, &inside(&path, key), table, to);
        if !is_moved || diagnostics.len() >= MOST_DIAGNOSTICS {
            return Err(CaseError::Wrong(diagnostics));
        }
    }
}

/// The path of a key of the table at another one.
fn inside(path: &str, key: &str) -> String {
    if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") }
}

/// An error as it is told, with what the rest of the case has to say of it.
fn told(root: &TomlNode, error: &TypeError) -> Diagnostic {
    let path = error.path();
    let at = root.get(&path);
    let (key, help) = match error.mismatch() {
        Mismatch::UnknownKey { key, .. } => {
            let is_misplaced = is_misplaced(root, &path, key);
            let help =
                is_misplaced.then(|| misplaced(at, key)).or_else(|| of_table_below(&path, key));
            (inside(&path, key), help)
        }
        Mismatch::MissingKey(key) => (inside(&path, key), what_to_add(root, &path, key)),
        Mismatch::WrongType { wanted, .. } => {
            let help = at.and_then(|node| brackets(node, &path, wanted));
            let by_schema = || at.and_then(|node| written(&path, number(node).as_deref()));
            let help = help.or_else(|| by_schema().filter(|_| wanted == "a table"));
            (path, help)
        }
        Mismatch::NoContent(name) => {
            let help = alternative(&path, name);
            (path, help)
        }
        Mismatch::NoAlternative { .. } => {
            let help =
                at.and_then(|node| keys_of_one(node, &path)).or_else(|| written(&path, None));
            (path, help)
        }
        Mismatch::UnknownAlternative { found, .. } if holder(&path, &[found]).is_some() => {
            let help = of_table_below(&path, found);
            (path, help)
        }
        Mismatch::UnknownAlternative { found, accepted } if path.ends_with("shape") => {
            let geometry = root.get("geometry").and_then(TomlNode::text).unwrap_or_default();
            let fitting = shapes_of(geometry, accepted);
            let help = fitting.map(|shapes| {
                suggestion(found, &shapes).replace("accepted:", &format!("{geometry} shapes:"))
            });
            (path, help)
        }
        _ => (path, None),
    };
    Diagnostic {
        severity: Severity::Error,
        key,
        message: error.message(),
        help: help.unwrap_or_else(|| error.help()),
        location: error.origin().map(Origin::location),
    }
}

/// Where a key is to be written that a table below its own has.
fn of_table_below(path: &str, key: &str) -> Option<String> {
    let own = inside(path, holder(path, &[key])?);
    Some(format!("`{key}` is a key of `{own}`: write {own}.{key} = ..., or put it below [{own}]"))
}

/// What to write for a table whose keys are all those of one of its alternatives.
fn keys_of_one(node: &TomlNode, path: &str) -> Option<String> {
    let keys: Vec<&str> = node.table()?.keys().map(String::as_str).collect();
    let own = inside(path, holder(path, &keys).filter(|_| !keys.is_empty())?);
    let list = keys.join("`, `");
    Some(format!("`{list}` are keys of `{own}`: write [{own}] above them, or {own} = {{ ... }}"))
}

/// A number as it is written.
fn number(node: &TomlNode) -> Option<String> {
    match &node.value {
        TomlValue::Integer(number) => Some(number.to_string()),
        TomlValue::Float(number) => Some(format!("{number:?}")),
        _ => None,
    }
}

/// Keys that may stand at the top of a case file.
fn top_keys() -> Vec<String> {
    let nothing = || TomlNode::at_no_place(TomlValue::Boolean(false));
    let table = TomlNode::at_no_place(TomlValue::Table([(String::new(), nothing())].into()));
    let mut keys = match Case::deserialize(&table).map_err(|error| error.into_mismatch()) {
        Err(Mismatch::UnknownKey { accepted, .. }) => accepted,
        _ => Vec::new(),
    };
    keys.extend(["extends", REFERENCES, SWEEP].map(str::to_owned));
    keys
}

/// Whether a key that its table does not have is one of the top of the file, written below a header.
fn is_misplaced(root: &TomlNode, path: &str, key: &str) -> bool {
    let is_below_header = root.get(path).is_some_and(|table| !table.is_inline());
    !path.is_empty() && is_below_header && top_keys().iter().any(|top| top == key)
}

/// Where a key of the top of the file is to be written.
fn misplaced(table: Option<&TomlNode>, key: &str) -> String {
    let may_be_several = match wanted("", key).map(TypeError::into_mismatch) {
        Some(Mismatch::WrongType { wanted, .. }) => wanted == "an array",
        _ => false,
    };
    let value = table.and_then(|table| table.get(key)).map(|node| &node.value);
    let header = match value {
        Some(TomlValue::Table(_) | TomlValue::Array(_)) if may_be_several => {
            format!(", or write it under a header of its own, [[{key}]]")
        }
        Some(TomlValue::Table(_)) => format!(", or write it under a header of its own, [{key}]"),
        _ => String::new(),
    };
    format!("`{key}` is a key of the top level: put it before the first [header]{header}")
}

/// What is said of a key that holds a text which stands for nothing: what it wants to hold.
fn wanted(path: &str, key: &str) -> Option<TypeError> {
    // In a case with nothing else in it, so that nothing else is said
    let own = inside(path, key);
    let mut node = TomlNode::at_no_place(TomlValue::String(String::new()));
    let mut steps = Vec::new();
    for step in own.rsplit('.') {
        let is_index = step.parse::<usize>().is_ok();
        node = TomlNode::at_no_place(if is_index {
            TomlValue::Array(vec![node])
        } else {
            TomlValue::Table([(step.to_owned(), node)].into())
        });
        steps.push(if is_index { "0" } else { step });
    }
    steps.reverse();
    Case::deserialize(&node).err().filter(|error| error.path() == steps.join("."))
}

/// What to write for a key that is missing, with what it may hold.
fn what_to_add(root: &TomlNode, path: &str, key: &str) -> Option<String> {
    // What a word may be is known from the key and its table only
    if key == "kind" && path.contains("reference") {
        let kinds = ReferenceKind::ALL.map(ReferenceKind::name).join(", ");
        return Some(format!("add `kind = \"...\"` there: {kinds}"));
    }
    let own = inside(path, key);
    match wanted(path, key)?.mismatch() {
        Mismatch::UnknownAlternative { accepted, .. } => {
            let words = match shapes_of_case(root, &own, accepted) {
                Some(shapes) => shapes.join(", "),
                None => accepted.join(", "),
            };
            Some(format!("add `{key} = ...` there, one of: {words}"))
        }
        Mismatch::WrongType { wanted, .. } if wanted == "a table" => {
            Some(format!("add `{key} = {{ ... }}` there, or a header [{own}]"))
        }
        Mismatch::WrongType { wanted, .. } => Some(format!("add `{key} = ...` there, {wanted}")),
        _ => None,
    }
}

fn shapes_of_case(root: &TomlNode, path: &str, accepted: &[String]) -> Option<Vec<String>> {
    let geometry =
        root.get("geometry").and_then(TomlNode::text).filter(|_| path.ends_with("shape"));
    shapes_of(geometry?, accepted)
}

/// Those of the shapes that can stand in a geometry, if it is one.
fn shapes_of(geometry: &str, accepted: &[String]) -> Option<Vec<String>> {
    let geometry = [Geometry::Planar, Geometry::Axisymmetric, Geometry::Spatial]
        .into_iter()
        .find(|one| one.name() == geometry)?;
    let shapes = schema::alternatives(&schema::whole()["$defs"]["ShapeSpec"]);
    let fitting = schema::fitting(shapes, geometry);
    Some(accepted.iter().filter(|shape| fitting.contains(&shape.as_str())).cloned().collect())
}

/// How many brackets the header of a table takes: two where there may be several of it.
fn brackets(node: &TomlNode, path: &str, wanted: &str) -> Option<String> {
    let header: Vec<&str> = path.split('.').filter(|step| step.parse::<usize>().is_err()).collect();
    let header = header.join(".");
    let is_header = node.is_under_header() || !path.contains('.');
    match &node.value {
        TomlValue::Table(_) if wanted == "an array" && node.is_inline() && !path.contains('.') => {
            Some(format!("there may be several: write it in brackets, {header} = [{{ ... }}]"))
        }
        TomlValue::Table(_) if wanted == "an array" && is_header => {
            Some(format!("there may be several: write [[{header}]], in double brackets"))
        }
        TomlValue::Array(items)
            if wanted == "a table" && items.iter().all(|item| item.table().is_some()) =>
        {
            Some(format!("there is one of it only: write [{header}], in single brackets"))
        }
        _ => None,
    }
}

/// Moves a key to a table and gives it another name there, or takes it out where there is none.
fn move_key(root: &mut TomlNode, from: &str, table: &str, to: Option<&str>) -> bool {
    let (path, key) = from.rsplit_once('.').unwrap_or(("", from));
    let Some(entries) = root.find_mut(path).and_then(TomlNode::table_mut) else { return false };
    let Some(node) = entries.remove(key) else { return false };
    let Some(entries) = root.find_mut(table).and_then(TomlNode::table_mut) else { return false };
    if let Some(to) = to {
        entries.entry(to.to_owned()).or_insert(node);
    }
    true
}
