//! `Rows`: references as rows of a table, with where each cell is written.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use crate::text::csv_line::{Cell, cells};
use crate::text::diagnostic::Diagnostic;
use crate::text::source::{Origin, Source};
use crate::text::tree::{TomlNode, TomlValue};
use crate::text::type_error::suggestion;

/// Key of the table in a case.
pub const REFERENCES: &str = "references";

/// The column that says of which variant a row is a reference; their key in a case.
pub const VARIANT: &str = "variant";

/// Columns of texts: keys of `[[reference]]`.
const TEXTS: [&str; 10] =
    ["quantity", "minus", "statistic", "of", "kind", "source", "date", "outside", "cause", "note"];

/// Columns of numbers: keys of `[[reference]]`.
const NUMBERS: [&str; 6] = ["at", "level", "value", "per", "relative", "absolute"];

/// The column of numbers, or of texts with the unit they have: per cent.
const UNCERTAINTY: &str = "uncertainty";

/// Columns that no table does without.
const NEEDED: [&str; 4] = ["quantity", "value", "kind", "source"];

/// An error of the table.
pub fn diagnostic(origin: &Origin, message: String, help: &str) -> Diagnostic {
    Diagnostic { location: Some(origin.location()), ..Diagnostic::error(REFERENCES, message, help) }
}

/// The text of a table, and where it is written.
pub struct Text {
    /// The source.
    pub source: Arc<Source>,
    /// The table.
    pub text: String,
    /// Byte of the source at which the text begins, if it stands there as it is.
    pub start: Option<usize>,
    /// Where the whole of it is written.
    pub whole: Range<usize>,
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

/// A row as it is put into the tree.
pub struct Row {
    /// The variant it is a reference of; the case itself if absent.
    pub variant: Option<String>,
    /// The reference.
    pub reference: TomlNode,
}

/// A line of the table.
#[derive(Clone, Copy)]
struct Line<'a> {
    /// Its first byte in the table.
    start: usize,
    text: &'a str,
}

/// The rows of a table.
pub struct Rows {
    /// Those in which nothing is wrong.
    pub rows: Vec<Row>,
    /// What is wrong in the others.
    pub wrong: Vec<Diagnostic>,
}

impl Rows {
    /// Reads a table, with the variants there are.
    pub fn read(text: Text, variants: &[String]) -> Self {
        let mut table = Table { text, wrong: Vec::new() };
        let rows = table.rows(variants);
        Self { rows, wrong: table.wrong }
    }
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
        let known: Vec<&str> =
            [VARIANT, UNCERTAINTY].into_iter().chain(TEXTS).chain(NUMBERS).collect();
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
                let number = text.parse().ok().filter(|_| name == UNCERTAINTY);
                let value = number.map_or(TomlValue::String(text), TomlValue::Float);
                entries.insert(name.clone(), self.node(line, span, value));
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
            "say of which kind it is: measured, literature, exact, independent, approximate, \
                   internal, property, regression"
        }
        _ => "say who published the value and where, or how it follows",
    }
}
