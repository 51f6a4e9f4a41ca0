//! `[references]`: references as rows of a table, and texts of sources by short names.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use serde::Deserialize;

use super::case_text::source_beside;
use super::csv_line::{Cell, cells};
use super::diagnostic::{CaseError, Diagnostic};
use super::source::{Origin, Source};
use super::tree::{self, TomlNode, TomlValue};
use super::type_error::{TypeError, suggestion};
use super::variants::variant_names;

/// Key of the table in a case.
pub const REFERENCES: &str = "references";

/// Key of single references.
const REFERENCE: &str = "reference";

/// The column that says of which variant a row is a reference; their key in a case.
const VARIANT: &str = "variant";

/// Columns of texts: keys of `[[reference]]`.
const TEXTS: [&str; 9] =
    ["quantity", "minus", "statistic", "of", "kind", "source", "date", "outside", "note"];

/// Columns of numbers: keys of `[[reference]]`.
const NUMBERS: [&str; 7] = ["at", "level", "value", "per", "relative", "absolute", "uncertainty"];

/// Columns that no table does without.
const NEEDED: [&str; 4] = ["quantity", "value", "kind", "source"];

/// Most diagnostics listed at once.
const MOST_DIAGNOSTICS: usize = 20;

/// `[references]`: references as a table with a row for each, and sources by short names.
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
        let mut table = Table { text, wrong: Vec::new() };
        let rows = table.rows(&variant_names(root));
        if !table.wrong.is_empty() {
            table.wrong.truncate(MOST_DIAGNOSTICS);
            return Err(CaseError::Wrong(table.wrong));
        }
        for Row { variant, reference } in rows {
            let owner = match &variant {
                None => Some(&mut *root),
                Some(name) => variant_of(root, name),
            };
            owner.and_then(TomlNode::table_mut).map(|entries| add(entries, reference));
        }
    }
    name_sources(root, &node, &asked.sources)
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

fn diagnostic(origin: &Origin, message: String, help: &str) -> Diagnostic {
    Diagnostic { location: Some(origin.location()), ..Diagnostic::error(REFERENCES, message, help) }
}

/// The text of a table, and where it is written.
struct Text {
    source: Arc<Source>,
    text: String,
    /// Byte of the source at which the text begins, if it stands there as it is.
    start: Option<usize>,
    /// Where the whole of it is written.
    whole: Range<usize>,
}

impl Text {
    /// Where bytes of a line are written.
    fn origin(&self, line: Line<'_>, span: Range<usize>) -> Origin {
        let span = match self.start {
            Some(start) => start + line.start + span.start..start + line.start + span.end,
            None => self.whole.clone(),
        };
        Origin { source: Arc::clone(&self.source), span }
    }
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

/// Puts the texts of sources in the place of their names.
fn name_sources(
    root: &mut TomlNode,
    node: &TomlNode,
    sources: &BTreeMap<String, String>,
) -> Result<(), CaseError> {
    let is_name = |text: &str| !text.is_empty() && !text.contains(char::is_whitespace);
    if let Some(name) = sources.keys().find(|name| !is_name(name)) {
        let path = format!("sources.{name}");
        return Err(refused(
            &node.get(&path).unwrap_or(node).key,
            format!("`{name}` is no name of a source"),
            "write a name without spaces, such as stokes-1851".to_owned(),
        ));
    }
    if sources.is_empty() {
        return Ok(());
    }
    let names: Vec<&str> = sources.keys().map(String::as_str).collect();
    for reference in all_references(root) {
        let Some(source) = reference.find_mut("source") else { continue };
        let TomlValue::String(text) = &source.value else { continue };
        if let Some(meant) = sources.get(text) {
            source.value = TomlValue::String(meant.clone());
        } else if is_name(text) {
            let message = format!("[references.sources] has no `{text}`");
            return Err(refused(&source.origin, message, suggestion(text, &names)));
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

/// A row as it is put into the tree.
struct Row {
    /// The variant it is a reference of; the case itself if absent.
    variant: Option<String>,
    reference: TomlNode,
}

/// A line of the table.
#[derive(Clone, Copy)]
struct Line<'a> {
    /// Its first byte in the table.
    start: usize,
    text: &'a str,
}

/// A table that is read.
struct Table {
    text: Text,
    /// What is wrong in it.
    wrong: Vec<Diagnostic>,
}

impl Table {
    /// Its rows, with the variants there are; what is wrong is kept.
    fn rows(&mut self, variants: &[String]) -> Vec<Row> {
        let text = self.text.text.clone();
        let mut start = 0;
        let mut lines = text.split_inclusive('\n').filter_map(|line| {
            let text = line.trim_end_matches(['\n', '\r']);
            let found = Line { start, text };
            start += line.len();
            let is_row = !text.trim().is_empty() && !text.trim_start().starts_with('#');
            is_row.then_some(found)
        });
        let Some(header) = lines.next() else {
            let whole = Line { start: 0, text: text.lines().next().unwrap_or_default() };
            self.refuse(whole, 0..0, "the table is empty".to_owned(), &needed());
            return Vec::new();
        };
        let columns = self.header(header);
        if !self.wrong.is_empty() {
            return Vec::new();
        }
        lines.filter_map(|line| self.row(line, &columns, variants)).collect()
    }

    /// Names of the columns.
    fn header(&mut self, line: Line<'_>) -> Vec<String> {
        let cells = self.cells(line).unwrap_or_default();
        let mut names: Vec<String> = Vec::new();
        if let [one] = &cells[..]
            && let Some(separator) = [';', '\t'].into_iter().find(|c| one.text.contains(*c))
        {
            let message = format!("the table has its columns between {separator:?}");
            let help = "separate columns by commas, and write numbers with a decimal point";
            self.refuse(line, one.span.clone(), message, help);
            return names;
        }
        let known: Vec<&str> = [VARIANT].into_iter().chain(TEXTS).chain(NUMBERS).collect();
        for Cell { text, span } in cells {
            if !known.contains(&text.as_str()) {
                let message = format!("there is no column `{text}` of references");
                self.refuse(line, span, message, &suggestion(&text, &known));
            } else if names.contains(&text) {
                let message = format!("there are two columns `{text}`");
                self.refuse(line, span, message, "give each column once");
            }
            names.push(text);
        }
        if self.wrong.is_empty() {
            for name in NEEDED.into_iter().filter(|name| !names.iter().any(|one| one == name)) {
                let message = format!("the table has no column `{name}`");
                self.refuse(line, 0..line.text.len(), message, &needed());
            }
        }
        names
    }

    /// The reference of a row; nothing if something is wrong in it.
    fn row(&mut self, line: Line<'_>, columns: &[String], variants: &[String]) -> Option<Row> {
        let n_wrong = self.wrong.len();
        let cells = self.cells(line)?;
        if cells.len() != columns.len() {
            let (n, wanted) = (cells.len(), columns.len());
            let help = "write a comma for a cell that is empty, too, and a text with commas in \
                        quotes: \"one, two\"";
            let message = format!("this row has {n} cells, and the header has {wanted}");
            self.refuse(line, 0..line.text.len(), message, help);
            return None;
        }
        let mut variant = None;
        let mut entries = BTreeMap::new();
        for (name, Cell { text, span }) in columns.iter().zip(cells) {
            if text.is_empty() {
                if NEEDED.contains(&name.as_str()) {
                    let message = format!("column `{name}` is empty here");
                    self.refuse(line, span, message, what_it_holds(name));
                }
            } else if name == VARIANT {
                if !variants.contains(&text) {
                    let message = format!("column `{name}`: there is no variant `{text}`");
                    let help = match variants {
                        [] => "this case has no [[variant]]: leave the cell empty".to_owned(),
                        _ => suggestion(&text, variants),
                    };
                    self.refuse(line, span, message, &help);
                }
                variant = Some(text);
            } else if NUMBERS.contains(&name.as_str()) {
                match text.parse() {
                    Ok(number) => {
                        entries
                            .insert(name.clone(), self.node(line, span, TomlValue::Float(number)));
                    }
                    Err(_) => {
                        let message = format!("column `{name}`: `{text}` is no number");
                        self.refuse(line, span, message, "write numbers as 12, -0.5 or 1e-3");
                    }
                }
            } else {
                entries.insert(name.clone(), self.node(line, span, TomlValue::String(text)));
            }
        }
        let whole = 0..line.text.trim_end().len();
        let reference = self.node(line, whole, TomlValue::Table(entries));
        (self.wrong.len() == n_wrong).then_some(Row { variant, reference })
    }

    /// The cells of a line.
    fn cells(&mut self, line: Line<'_>) -> Option<Vec<Cell>> {
        cells(line.text)
            .map_err(|quote| {
                let message = "the text in quotes has no end in this line".to_owned();
                let help = "close it with a quote; a quote within it is written twice";
                self.refuse(line, quote..line.text.len(), message, help);
            })
            .ok()
    }

    fn node(&self, line: Line<'_>, span: Range<usize>, value: TomlValue) -> TomlNode {
        let origin = self.text.origin(line, span);
        TomlNode { key: origin.clone(), origin, value }
    }

    fn refuse(&mut self, line: Line<'_>, span: Range<usize>, message: String, help: &str) {
        self.wrong.push(diagnostic(&self.text.origin(line, span), message, help));
    }
}

/// What a table begins with.
fn needed() -> String {
    format!("name the columns in its first line; needed are {}", NEEDED.join(", "))
}

/// What is written in a column that no row leaves empty.
fn what_it_holds(name: &str) -> &'static str {
    match name {
        "quantity" => "name what is compared, a column of series.csv",
        "value" => "write the value it is compared with",
        "kind" => {
            "say of which kind it is: measured, literature, exact, independent, property, \
                   regression"
        }
        _ => "say who published the value and where, or how it follows",
    }
}
