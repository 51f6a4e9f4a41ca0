//! Tables that name a file of numbers: where they are in a case, and the points that their files hold.

use std::sync::Arc;

use crate::read::case_text::source_beside;
use crate::text::source::{Origin, Source};
use crate::text::tree::{TomlNode, TomlValue, TreeError};

/// Tables of a case with shapes and gaits in them.
const BODIES: [&str; 2] = ["body", "swimmer"];

/// Resolves an entry of a key; `None` of other keys, below which it is gone on.
pub type Resolve = fn(&str, &mut TomlNode) -> Option<Result<(), TreeError>>;

/// Resolves entries of bodies and swimmers, wherever they are below these.
///
/// # Errors
/// The first of the entries.
pub fn resolve_in_bodies(root: &mut TomlNode, resolve: Resolve) -> Result<(), TreeError> {
    for table in BODIES {
        if let Some(node) = root.table_mut().and_then(|entries| entries.get_mut(table)) {
            resolve_below(node, resolve)?;
        }
    }
    Ok(())
}

fn resolve_below(node: &mut TomlNode, resolve: Resolve) -> Result<(), TreeError> {
    match &mut node.value {
        TomlValue::Table(entries) => entries.iter_mut().try_for_each(|(key, entry)| {
            resolve(key, entry).unwrap_or_else(|| resolve_below(entry, resolve))
        }),
        TomlValue::Array(items) => {
            items.iter_mut().try_for_each(|item| resolve_below(item, resolve))
        }
        _ => Ok(()),
    }
}

/// The file that a table names; none where it has none, or a path of another type, which is refused when the case is typed.
pub fn file_of(table: &TomlNode) -> Option<TomlNode> {
    table.table()?.get("file").filter(|file| file.text().is_some()).cloned()
}

/// The text of a file beside the one that names it; `kind` of file is wanted.
///
/// # Errors
/// When it cannot be read.
pub fn text_of(file: &TomlNode, kind: &str) -> Result<Source, TreeError> {
    source_beside(file.text().unwrap_or_default(), &file.origin).map_err(|message| TreeError {
        origin: file.origin.clone(),
        message,
        help: format!(
            "give the path of a {kind} file, relative to the file in which it is written"
        ),
    })
}

/// Puts the points of a file in the place of its name; `what` has them.
///
/// # Errors
/// When there are `points` beside it, or what `read` refuses.
pub fn put_points(
    table: &mut TomlNode,
    what: &str,
    read: fn(&TomlNode) -> Result<TomlNode, TreeError>,
) -> Result<(), TreeError> {
    let file = file_of(table);
    let (Some(file), Some(entries)) = (file, table.table_mut()) else { return Ok(()) };
    if entries.contains_key("points") {
        return Err(TreeError {
            origin: file.key.clone(),
            message: format!("the {what} has both `points` and `file`"),
            help: "give one of them".to_owned(),
        });
    }
    let points = read(&file)?;
    entries.remove("file");
    entries.insert("points".to_owned(), points);
    Ok(())
}

/// A line of a file with something in it besides a comment.
pub struct Line<'a> {
    /// Where it is.
    pub origin: Origin,
    /// What is in it.
    pub text: &'a str,
}

impl Line<'_> {
    /// The numbers of the line, between them commas, semicolons or spaces; `None` where a word is none.
    pub fn numbers(&self) -> Option<Vec<f64>> {
        let words = self.text.split([',', ';', ' ', '\t']).filter(|word| !word.is_empty());
        words.map(|word| word.parse::<f64>().ok()).collect()
    }
}

/// The lines of a file that hold something.
pub fn lines(source: &Arc<Source>) -> impl Iterator<Item = Line<'_>> {
    let mut start = 0;
    source.text.split_inclusive('\n').filter_map(move |line| {
        let span = start..start + line.trim_end().len();
        start += line.len();
        let text = line.split('#').next().unwrap_or_default().trim();
        let origin = Origin { source: Arc::clone(source), span };
        (!text.is_empty()).then_some(Line { origin, text })
    })
}

/// What is missing at the end of a file.
pub fn at_end(source: &Arc<Source>, message: String, help: String) -> TreeError {
    let end = source.text.len();
    TreeError { origin: Origin { source: Arc::clone(source), span: end..end }, message, help }
}

/// Numbers as they would be written in the case, in the place of the name of their file.
pub fn list(file: &TomlNode, numbers: &[f64]) -> TomlNode {
    array(file, numbers.iter().map(|x| written(file, TomlValue::Float(*x))).collect())
}

/// Texts likewise.
pub fn texts(file: &TomlNode, texts: &[&str]) -> TomlNode {
    let text = |text: &&str| written(file, TomlValue::String((*text).to_owned()));
    array(file, texts.iter().map(text).collect())
}

/// Rows of numbers likewise.
pub fn rows<R: AsRef<[f64]>>(file: &TomlNode, rows: &[R]) -> TomlNode {
    array(file, rows.iter().map(|row| list(file, row.as_ref())).collect())
}

fn array(file: &TomlNode, items: Vec<TomlNode>) -> TomlNode {
    written(file, TomlValue::Array(items))
}

fn written(file: &TomlNode, value: TomlValue) -> TomlNode {
    TomlNode { key: file.key.clone(), origin: file.origin.clone(), value }
}
