//! Strokes from files: `file = { path, time, column }` becomes knots joined by a cubic spline.

mod csv_table;
mod spline;

use serde::Deserialize;

use self::csv_table::CsvTable;
use self::spline::{natural_slopes, periodic_slopes};
#[cfg(test)]
use crate::spec::number::Positive;
use crate::text::tree::{TomlNode, TomlValue, TreeError};
use crate::text::type_error::{CYCLE_OF_A_FILE, KNOTS_OF_A_FILE, TypeError};

/// Part of a number that is taken for rounding.
const ROUNDING: f64 = 1e-9;

/// Tables of a case with strokes in them.
const TABLES: [&str; 7] =
    ["body", "joint", "swimmer", "field", "flow", "boundary", "reduced.thruster"];

/// `file`: columns of a CSV file with a header.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct FileStroke {
    /// Path of the CSV file, relative to the file in which it is written.
    pub path: String,
    /// Name of the column with the times (s), ascending.
    pub time: String,
    /// What the times are multiplied by: 1e-3 of a column in milliseconds, where the case is in seconds.
    #[serde(default)]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub time_scale: Option<f64>,
    /// What is added to the times then (s): -100 where the run begins at 100 of the file.
    #[serde(default)]
    pub time_offset: Option<f64>,
    /// The time after which the values come again (s); the file has one period then, not the whole run.
    #[serde(default)]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub period: Option<f64>,
    /// Name of the column with the values.
    pub column: String,
    /// What they are multiplied by.
    #[serde(default)]
    pub scale: Option<f64>,
    /// 1, or -1 where the column counts the other way round.
    #[serde(default)]
    pub sign: Option<i64>,
    /// What is added to them then, in the unit of the column.
    #[serde(default)]
    pub offset: Option<f64>,
    /// Unit of angles in the column.
    #[serde(default)]
    pub unit: Option<AngleUnit>,
}

/// Unit of a column of angles.
#[derive(Debug, Clone, Copy, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(inline))]
#[serde(rename_all = "lowercase")]
pub enum AngleUnit {
    /// Radians.
    Rad,
    /// Degrees.
    Deg,
    /// Whole turns.
    Turn,
}

/// What is known of a stroke from a file once its values have taken its place.
#[derive(Debug, Clone)]
pub struct RecordedStroke {
    /// Key of the stroke.
    pub key: String,
    /// Names of the columns with times and values.
    pub columns: [String; 2],
    /// Whether it is said what the times are multiplied by.
    pub has_time_scale: bool,
    /// Whether the unit of its angles is said.
    pub has_unit: bool,
    /// First and last time (s).
    pub span: [f64; 2],
    /// Number of rows.
    pub n_rows: usize,
}

impl FileStroke {
    /// A time of the column as it is meant (s).
    fn time(&self, written: f64) -> f64 {
        let scaled = self.time_scale.map_or(written, |scale| written * scale);
        self.time_offset.map_or(scaled, |offset| scaled + offset)
    }

    /// A value of the column as it is meant.
    fn value(&self, written: f64) -> f64 {
        let mut value = written;
        // What is not written changes no bit
        if let Some(scale) = self.scale {
            value *= scale;
        }
        if self.sign == Some(-1) {
            value = -value;
        }
        if let Some(offset) = self.offset {
            value += offset;
        }
        match self.unit {
            None | Some(AngleUnit::Rad) => value,
            Some(AngleUnit::Deg) => value.to_radians(),
            Some(AngleUnit::Turn) => value * std::f64::consts::TAU,
        }
    }
}

/// Puts the values of files in the place of their names, so that a case stands for itself; what the files were.
///
/// # Errors
/// When a file cannot be read, or has no such columns with numbers.
pub fn resolve(root: &mut TomlNode) -> Result<Vec<RecordedStroke>, TreeError> {
    let mut recorded = Vec::new();
    for table in TABLES {
        if let Some(node) = root.find_mut(table) {
            resolve_below(node, table, &mut recorded)?;
        }
    }
    Ok(recorded)
}

fn resolve_below(
    node: &mut TomlNode,
    path: &str,
    recorded: &mut Vec<RecordedStroke>,
) -> Result<(), TreeError> {
    match &mut node.value {
        TomlValue::Table(entries) => {
            if let Some(file) = entries.remove("file") {
                let asked = asked(&file, path)?;
                let points = points(&file, &asked)?;
                recorded.push(asked.recorded(path, &points));
                entries.insert(asked.becomes().to_owned(), knots(&file, &asked, &points));
            }
            for (key, entry) in entries {
                resolve_below(entry, &format!("{path}.{key}"), recorded)?;
            }
        }
        TomlValue::Array(items) => {
            for (index, item) in items.iter_mut().enumerate() {
                resolve_below(item, &format!("{path}.{index}"), recorded)?;
            }
        }
        _ => {}
    }
    Ok(())
}

impl FileStroke {
    /// What such a stroke is called.
    fn becomes(&self) -> &'static str {
        if self.period.is_some() { CYCLE_OF_A_FILE } else { KNOTS_OF_A_FILE }
    }

    /// What is kept of it.
    fn recorded(&self, key: &str, points: &[[f64; 2]]) -> RecordedStroke {
        let time = |point: Option<&[f64; 2]>| point.map_or(0.0, |point| point[0]);
        RecordedStroke {
            key: key.to_owned(),
            columns: [self.time.clone(), self.column.clone()],
            has_time_scale: self.time_scale.is_some(),
            has_unit: self.unit.is_some(),
            span: [time(points.first()), time(points.last())],
            n_rows: points.len(),
        }
    }
}

/// What is asked of a file.
fn asked(file: &TomlNode, path: &str) -> Result<FileStroke, TreeError> {
    let path = format!("{path}.file");
    let asked = FileStroke::deserialize(file).map_err(|error| mistyped(file, error, &path))?;
    if let Some(sign) = asked.sign.filter(|sign| sign.abs() != 1) {
        let message = format!("`sign` is {sign}, and a sign is 1 or -1");
        return Err(refused(file, "sign", message, "write other factors as scale = ..."));
    }
    for (key, number) in [("time_scale", asked.time_scale), ("period", asked.period)] {
        if let Some(number) = number.filter(|number| !(*number > 0.0 && number.is_finite())) {
            let message = format!("`{path}.{key}` is {number}, but must be positive");
            return Err(refused(file, key, message, "write a number such as 1.0 or 1e-3"));
        }
    }
    Ok(asked)
}

/// What is wrong with a key of a file, or with the file.
fn refused(file: &TomlNode, key: &str, message: String, help: &str) -> TreeError {
    let origin = file.get(key).map_or(&file.origin, |node| &node.origin).clone();
    TreeError { origin, message, help: help.to_owned() }
}

/// Times and values of a file as they are meant.
fn points(file: &TomlNode, asked: &FileStroke) -> Result<Vec<[f64; 2]>, TreeError> {
    let table = CsvTable::read(file, &asked.path)?;
    let times = table.column(&asked.time, "time", file)?;
    let values = table.column(&asked.column, "column", file)?;
    table.check_lengths()?;
    let mut points = table.points(times, values)?;
    for point in &mut points {
        *point = [asked.time(point[0]), asked.value(point[1])];
    }
    let rises = points.windows(2).all(|pair| pair[1][0] > pair[0][0]);
    if !rises || points.iter().flatten().any(|number| !number.is_finite()) {
        let message =
            format!("scaled and shifted, columns of `{}` are no numbers in order", asked.path);
        let help = "write other time_scale, time_offset, scale or offset";
        return Err(refused(file, "path", message, help));
    }
    if let Some(period) = asked.period
        && let Err(message) = close(&mut points, period)
    {
        let help = "give rows over one period, the last one before its end or the first one again; times in \
                    other units need time_scale, too";
        return Err(refused(file, "period", message, help));
    }
    Ok(points)
}

/// Takes away the row at the end of a period, which is the first one again.
///
/// # Errors
/// In words, when the rows are no period.
fn close(points: &mut Vec<[f64; 2]>, period: f64) -> Result<(), String> {
    let (Some(&[first, value]), Some(&[last, end])) = (points.first(), points.last()) else {
        return Ok(());
    };
    let length = last - first;
    if length > period * (1.0 + ROUNDING) {
        return Err(format!("`period` is {period}, and the times go from {first} to {last}"));
    }
    if length > period * (1.0 - ROUNDING) {
        // What is recorded does not close to the last digit, but not by more than it changes elsewhere
        let changes = points.windows(2).map(|pair| (pair[1][1] - pair[0][1]).abs());
        if (end - value).abs() > changes.fold(0.0, f64::max) {
            return Err(format!(
                "after a `period` of {period} the value is {end}, and it was {value} at its beginning"
            ));
        }
        points.pop();
    }
    if points.len() < 2 {
        return Err(format!("a `period` of {period} has one row only"));
    }
    Ok(())
}

/// The knots of a stroke that a file stands for.
fn knots(file: &TomlNode, asked: &FileStroke, points: &[[f64; 2]]) -> TomlNode {
    let node = |value| TomlNode { key: file.key.clone(), origin: file.origin.clone(), value };
    let number = |value: f64| node(TomlValue::Float(value));
    let list = |slopes: Vec<f64>| {
        let rows = points.iter().zip(slopes);
        let rows = rows.map(|([time, value], slope)| [*time, *value, slope].map(number).to_vec());
        node(TomlValue::Array(rows.map(|row| node(TomlValue::Array(row))).collect()))
    };
    match asked.period {
        None => list(natural_slopes(points)),
        Some(period) => {
            let knots = list(periodic_slopes(points, period));
            let entries = [("knots", knots), ("period", number(period))];
            let entries = entries.map(|(key, value)| (key.to_owned(), value));
            node(TomlValue::Table(entries.into()))
        }
    }
}

fn mistyped(file: &TomlNode, error: TypeError, path: &str) -> TreeError {
    let error = error.below(path);
    let help = match error.help() {
        help if help.is_empty() => {
            "write file = { path = \"angles.csv\", time = \"COLUMN\", column = \"COLUMN\" }"
                .to_owned()
        }
        help => help,
    };
    let origin = error.origin().unwrap_or(&file.origin).clone();
    TreeError { origin, message: error.message(), help }
}
