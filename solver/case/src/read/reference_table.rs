//! `[references]`: references as rows of a table, and texts of sources and causes by short names.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::Deserialize;

use super::case_text::source_beside;
use super::reference_rows::{REFERENCES, Row, Rows, Text, VARIANT, diagnostic};
use super::variants::variant_names;
use crate::text::diagnostic::CaseError;
use crate::text::source::{Origin, Source};
use crate::text::tree::{self, TomlNode, TomlValue};
use crate::text::type_error::{TypeError, suggestion};

/// Key of single references.
const REFERENCE: &str = "reference";

/// Most diagnostics listed at once.
const MOST_DIAGNOSTICS: usize = 20;

/// `[references]`: references as a table with a row for each, sources and causes by short names.
#[derive(Debug, Default, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ReferenceTable {
    /// Path of a CSV file, relative to the file in which it is written; this or `table`.
    pub file: Option<String>,
    /// What such a file holds, written here: a header and rows.
    pub table: Option<String>,
    /// Texts of sources by names without spaces, which may stand for them.
    #[serde(default)]
    pub sources: BTreeMap<String, String>,
    /// Texts of `cause` and `outside` by names without spaces, which may stand for them.
    #[serde(default)]
    pub causes: BTreeMap<String, String>,
}

/// Puts rows of a table beside the references of the case and its variants, and texts of sources in the
/// place of their names, so that a case stands for itself.
///
/// # Errors
/// When the table cannot be read, or with all that is wrong in it.
pub fn resolve(root: &mut TomlNode) -> Result<(), CaseError> {
    let Some(node) = root.table_mut().and_then(|entries| entries.remove(REFERENCES)) else {
        return Ok(());
    };
    let asked = ReferenceTable::deserialize(&node).map_err(|error| mistyped(&node, error))?;
    if let Some(text) = text_of(&node, &asked)? {
        let Rows { rows, mut wrong } = Rows::read(text, &variant_names(root));
        if !wrong.is_empty() {
            wrong.truncate(MOST_DIAGNOSTICS);
            return Err(CaseError::Wrong(wrong));
        }
        for Row { variant, reference } in rows {
            let owner = match &variant {
                None => Some(&mut *root),
                Some(name) => variant_of(root, name),
            };
            if let Some(entries) = owner.and_then(TomlNode::table_mut) {
                add(entries, reference);
            }
        }
    }
    put_texts(root, &node, Names { key: "source", list: "sources", texts: &asked.sources })?;
    // What makes a value differ may make it so large a difference that it is outside
    for key in ["cause", "outside"] {
        put_texts(root, &node, Names { key, list: "causes", texts: &asked.causes })?;
    }
    Ok(())
}

/// The text of a case with the table of its references in it instead of the name of a file.
pub fn with_table(source: &Arc<Source>) -> String {
    let text = &source.text;
    let file = tree::parse(source).ok().and_then(|root| root.get("references.file").cloned());
    let named = file.as_ref().and_then(|file| Some((file, file.text()?)));
    let Some((file, name)) = named else { return text.clone() };
    let Ok(Source { text: table, .. }) = source_beside(name, &file.origin) else {
        return text.clone();
    };
    let value = if table.contains("'''") {
        toml::Value::String(table).to_string()
    } else {
        format!("'''\n{table}'''")
    };
    let (before, after) = (&text[..file.key.span.start], &text[file.origin.span.end..]);
    format!("{before}table = {value}{after}")
}

fn mistyped(node: &TomlNode, error: TypeError) -> CaseError {
    let error = error.below(REFERENCES);
    let origin = error.origin().unwrap_or(&node.origin);
    let help = match (&node.value, error.help()) {
        (TomlValue::Array(_), _) => {
            "write [[reference]] above each of them, or file = \"references.csv\" below \
             [references] for a table of them"
                .to_owned()
        }
        (_, help) if help.is_empty() => {
            "write file = \"references.csv\", and below [references.sources] the texts of sources \
             by short names"
                .to_owned()
        }
        (_, help) => help,
    };
    refused(origin, error.message(), help)
}

/// An error by itself.
fn refused(origin: &Origin, message: String, help: String) -> CaseError {
    CaseError::Wrong(vec![diagnostic(origin, message, &help)])
}

/// The text of the table: that of its file, or what stands in the case itself.
fn text_of(node: &TomlNode, asked: &ReferenceTable) -> Result<Option<Text>, CaseError> {
    let origin = |key: &str| node.get(key).map_or(&node.origin, |found| &found.origin);
    match (&asked.file, &asked.table) {
        (None, None) => Ok(None),
        (Some(_), Some(_)) => Err(refused(
            origin("table"),
            "both `file` and `table` of [references] are given".to_owned(),
            "keep one of them; further references may stand below [[reference]]".to_owned(),
        )),
        (Some(file), None) => {
            let origin = origin("file");
            let source = source_beside(file, origin).map_err(|message| {
                let help = "give the path of a CSV file, relative to the file in which it is \
                            written; `alewife show CASE --source` prints a shipped case with its \
                            references in it";
                refused(origin, message, help.to_owned())
            })?;
            let text = source.text.clone();
            let whole = 0..text.len();
            Ok(Some(Text { source: Arc::new(source), text, start: Some(0), whole }))
        }
        (None, Some(text)) => {
            let Origin { source, span } = origin("table");
            let quoted = source.text.get(span.clone()).unwrap_or_default();
            // Unless a character is escaped
            let within = quoted.find(text.as_str()).map(|before| span.start + before);
            let start = within.filter(|_| !text.is_empty());
            let (source, whole) = (Arc::clone(source), span.clone());
            Ok(Some(Text { source, text: text.clone(), start, whole }))
        }
    }
}

/// The variant of a name.
fn variant_of<'a>(root: &'a mut TomlNode, name: &str) -> Option<&'a mut TomlNode> {
    items(root.find_mut(VARIANT)?)
        .find(|one| one.get("name").and_then(TomlNode::text) == Some(name))
}

/// Adds a reference to those of a case or of a variant.
fn add(entries: &mut BTreeMap<String, TomlNode>, reference: TomlNode) {
    let list = entries.entry(REFERENCE.to_owned()).or_insert_with(|| TomlNode {
        key: reference.key.clone(),
        origin: reference.origin.clone(),
        value: TomlValue::Array(Vec::new()),
    });
    // What is no list is refused when the case is typed
    if let TomlValue::Array(references) = &mut list.value {
        references.push(reference);
    }
}

/// Texts by short names.
struct Names<'a> {
    /// Key of references that may hold a name.
    key: &'static str,
    /// Where names and texts are given.
    list: &'static str,
    texts: &'a BTreeMap<String, String>,
}

/// Puts texts in the place of their names.
fn put_texts(root: &mut TomlNode, node: &TomlNode, known: Names<'_>) -> Result<(), CaseError> {
    let Names { key, list, texts } = known;
    let is_name = |text: &str| !text.is_empty() && !text.contains(char::is_whitespace);
    if let Some(name) = texts.keys().find(|name| !is_name(name)) {
        let path = format!("{list}.{name}");
        return Err(refused(
            &node.get(&path).unwrap_or(node).key,
            format!("`{name}` is no name of a {}", list.trim_end_matches('s')),
            "write a name without spaces, such as stokes-1851".to_owned(),
        ));
    }
    if texts.is_empty() {
        return Ok(());
    }
    let names: Vec<&str> = texts.keys().map(String::as_str).collect();
    for reference in all_references(root) {
        let Some(named) = reference.find_mut(key) else { continue };
        let TomlValue::String(text) = &named.value else { continue };
        if let Some(meant) = texts.get(text) {
            named.value = TomlValue::String(meant.clone());
        } else if is_name(text) {
            let message = format!("[references.{list}] has no `{text}`");
            return Err(refused(&named.origin, message, suggestion(text, &names)));
        }
    }
    Ok(())
}

/// References of the case and of its variants.
fn all_references(root: &mut TomlNode) -> impl Iterator<Item = &mut TomlNode> {
    let mut lists = Vec::new();
    for (key, node) in root.table_mut().into_iter().flatten() {
        if key == REFERENCE {
            lists.push(node);
        } else if key == VARIANT {
            lists.extend(items(node).filter_map(|one| one.table_mut()?.get_mut(REFERENCE)));
        }
    }
    lists.into_iter().flat_map(items)
}

/// The items of an array; none of what is no array, which is refused when the case is typed.
fn items(node: &mut TomlNode) -> std::slice::IterMut<'_, TomlNode> {
    match &mut node.value {
        TomlValue::Array(items) => items.iter_mut(),
        _ => [].iter_mut(),
    }
}
