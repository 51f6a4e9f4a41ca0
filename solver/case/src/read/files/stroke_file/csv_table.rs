//! `CsvTable`: the columns of a CSV file with a header, and where a row of it is wrong.

use std::sync::Arc;

use csv::{ReaderBuilder, StringRecord, Trim};

use crate::read::case_text::source_beside;
use crate::text::source::{Origin, Source};
use crate::text::tree::{TomlNode, TreeError};
use crate::text::type_error::suggestion;

/// What is asked of the times of a file.
const TIMES: &str = "times must rise from row to row, the first at 0 or before, the last at the end \
                     of the run or after";

/// The rows of a CSV file.
pub(super) struct CsvTable {
    source: Arc<Source>,
    header: StringRecord,
    rows: Vec<StringRecord>,
}

impl CsvTable {
    pub(super) fn read(file: &TomlNode, file_name: &str) -> Result<Self, TreeError> {
        let origin = file.get("path").map_or(&file.origin, |path| &path.origin);
        let refused = |message: String| TreeError {
            origin: origin.clone(),
            message,
            help: "give the path of a CSV file, relative to the file in which it is written"
                .to_owned(),
        };
        let source = Arc::new(source_beside(file_name, origin).map_err(refused)?);
        let mut reader = ReaderBuilder::new()
            .flexible(true)
            .trim(Trim::All)
            .comment(Some(b'#'))
            .from_reader(source.text.as_bytes());
        let unreadable =
            |error: csv::Error| refused(format!("{} is no CSV file: {error}", source.name));
        let header = reader.headers().map_err(unreadable)?.clone();
        if header.is_empty() {
            return Err(refused(format!("{} is empty", source.name)));
        }
        let rows = reader.records().collect::<Result<_, _>>().map_err(unreadable)?;
        Ok(Self { source, header, rows })
    }

    /// Refuses rows with more or fewer cells than the header: a decimal comma makes two cells of a number.
    pub(super) fn check_lengths(&self) -> Result<(), TreeError> {
        let wanted = self.header.len();
        let Some(row) = self.rows.iter().find(|row| row.len() != wanted) else { return Ok(()) };
        let n = row.len();
        let message = format!("this row has {n} cells, and the header has {wanted}");
        let help = if n > wanted {
            "write numbers with a decimal point, and put texts with commas in quotes"
        } else {
            "write a comma for a cell that is empty, too"
        };
        Err(self.refused(row, message, help))
    }

    /// The column of a name, which a key of `file` gives.
    pub(super) fn column(
        &self,
        name: &str,
        key: &str,
        file: &TomlNode,
    ) -> Result<usize, TreeError> {
        let found: Vec<usize> =
            (0..self.header.len()).filter(|nth| &self.header[*nth] == name).collect();
        let refused = |message: String, help: String| {
            let origin = file.get(key).map_or(&file.origin, |node| &node.origin).clone();
            Err(TreeError { origin, message, help })
        };
        let file = &self.source.name;
        match found[..] {
            [column] => Ok(column),
            [] => {
                let names: Vec<&str> = self.header.iter().collect();
                let message = format!("`{key}`: {file} has no column `{name}`");
                let is_one = |separator: char| names.len() == 1 && names[0].contains(separator);
                match [';', '\t'].into_iter().find(|separator| is_one(*separator)) {
                    Some(separator) => refused(
                        format!("`{key}`: {file} has its columns between {separator:?}"),
                        "separate columns by commas, and write numbers with a decimal point"
                            .to_owned(),
                    ),
                    None => refused(message, suggestion(name, &names)),
                }
            }
            _ => {
                let message = format!("`{key}`: {file} has {} columns `{name}`", found.len());
                refused(message, "give each column a name of its own".to_owned())
            }
        }
    }

    /// Times and values of all rows.
    pub(super) fn points(&self, times: usize, values: usize) -> Result<Vec<[f64; 2]>, TreeError> {
        let mut points: Vec<[f64; 2]> = Vec::with_capacity(self.rows.len());
        for row in &self.rows {
            let point = [self.number(row, times)?, self.number(row, values)?];
            if let Some([before, _]) = points.last()
                && point[0] <= *before
            {
                let name = &self.header[times];
                let message =
                    format!("column `{name}`: time {} does not come after {before}", point[0]);
                return Err(self.refused(row, message, TIMES));
            }
            points.push(point);
        }
        if points.len() < 2 {
            let end = self.source.text.len();
            return Err(TreeError {
                origin: Origin { source: Arc::clone(&self.source), span: end..end },
                message: format!("{} has {} rows of numbers", self.source.name, points.len()),
                help: "give two or more below the header".to_owned(),
            });
        }
        Ok(points)
    }

    fn number(&self, row: &StringRecord, column: usize) -> Result<f64, TreeError> {
        let name = &self.header[column];
        let refused = |message| self.refused(row, message, "write numbers as 12, -0.5 or 1e-3");
        let text = row.get(column).filter(|text| !text.is_empty());
        let text = text.ok_or_else(|| refused(format!("column `{name}` is empty here")))?;
        let number = text.parse().ok().filter(|number: &f64| number.is_finite());
        number.ok_or_else(|| refused(format!("column `{name}`: `{text}` is not a finite number")))
    }

    /// An error in a row.
    fn refused(&self, row: &StringRecord, message: String, help: &str) -> TreeError {
        let text = &self.source.text;
        let byte = row.position().map_or(0, csv::Position::byte);
        let mut start = usize::try_from(byte).map_or(0, |byte| byte.min(text.len()));
        // The position is where reading went on: before empty lines and comments
        loop {
            let rest = &text[start..];
            let blank = rest.len() - rest.trim_start().len();
            let comment = if rest[blank..].starts_with('#') {
                rest[blank..].find('\n').unwrap_or(rest.len() - blank)
            } else {
                0
            };
            start += blank + comment;
            if comment == 0 {
                break;
            }
        }
        let length = text[start..].find('\n').unwrap_or(text.len() - start);
        TreeError {
            origin: Origin { source: Arc::clone(&self.source), span: start..start + length },
            message,
            help: help.to_owned(),
        }
    }
}
