//! Strokes from files: `file = { path, time, column }` becomes knots joined by a natural cubic spline.

use std::sync::Arc;

use csv::{ReaderBuilder, StringRecord, Trim};
use serde::Deserialize;

use super::case_text::source_beside;
use crate::text::source::{Origin, Source};
use crate::text::tree::{TomlNode, TomlValue, TreeError};
use crate::text::type_error::{KNOTS_OF_A_FILE, TypeError, suggestion};

/// Tables of a case with strokes in them.
const TABLES: [&str; 6] = ["body", "joint", "swimmer", "field", "flow", "reduced.thruster"];

/// What is asked of the times of a file.
const TIMES: &str = "times must rise from row to row, the first at 0 or before, the last at the end \
                     of the run or after";

/// `file`: columns of a CSV file with a header.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct FileStroke {
    /// Path of the CSV file, relative to the file in which it is written.
    pub path: String,
    /// Name of the column with the times (s), ascending.
    pub time: String,
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

impl FileStroke {
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

/// Puts the values of files in the place of their names, so that a case stands for itself.
///
/// # Errors
/// When a file cannot be read, or has no such columns with numbers.
pub fn resolve(root: &mut TomlNode) -> Result<(), TreeError> {
    for table in TABLES {
        if let Some(node) = root.find_mut(table) {
            resolve_below(node, table)?;
        }
    }
    Ok(())
}

fn resolve_below(node: &mut TomlNode, path: &str) -> Result<(), TreeError> {
    match &mut node.value {
        TomlValue::Table(entries) => {
            if let Some(file) = entries.remove("file") {
                entries.insert(KNOTS_OF_A_FILE.to_owned(), knots(&file, &format!("{path}.file"))?);
            }
            for (key, entry) in entries {
                resolve_below(entry, &format!("{path}.{key}"))?;
            }
        }
        TomlValue::Array(items) => {
            for (index, item) in items.iter_mut().enumerate() {
                resolve_below(item, &format!("{path}.{index}"))?;
            }
        }
        _ => {}
    }
    Ok(())
}

/// The knots of a stroke `cubic` that a file stands for.
fn knots(file: &TomlNode, path: &str) -> Result<TomlNode, TreeError> {
    let asked = FileStroke::deserialize(file).map_err(|error| mistyped(file, error, path))?;
    if let Some(sign) = asked.sign.filter(|sign| sign.abs() != 1) {
        let origin = file.get("sign").map_or(&file.origin, |node| &node.origin).clone();
        let message = format!("`sign` is {sign}, and a sign is 1 or -1");
        return Err(TreeError {
            origin,
            message,
            help: "write other factors as scale = ...".into(),
        });
    }
    let table = CsvTable::read(file, &asked)?;
    let times = table.column(&asked.time, "time", file)?;
    let values = table.column(&asked.column, "column", file)?;
    table.check_lengths()?;
    let mut points = table.points(times, values)?;
    points.iter_mut().for_each(|point| point[1] = asked.value(point[1]));
    let node = |value| TomlNode { key: file.key.clone(), origin: file.origin.clone(), value };
    let slopes = natural_slopes(&points);
    let knot = |([time, value], slope): (&[f64; 2], f64)| {
        node(TomlValue::Array([*time, *value, slope].map(|x| node(TomlValue::Float(x))).to_vec()))
    };
    Ok(node(TomlValue::Array(points.iter().zip(slopes).map(knot).collect())))
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

/// The rows of a CSV file.
struct CsvTable {
    source: Arc<Source>,
    header: StringRecord,
    rows: Vec<StringRecord>,
}

impl CsvTable {
    fn read(file: &TomlNode, asked: &FileStroke) -> Result<Self, TreeError> {
        let origin = file.get("path").map_or(&file.origin, |path| &path.origin);
        let refused = |message: String| TreeError {
            origin: origin.clone(),
            message,
            help: "give the path of a CSV file, relative to the file in which it is written"
                .to_owned(),
        };
        let source = Arc::new(source_beside(&asked.path, origin).map_err(refused)?);
        let mut reader = ReaderBuilder::new()
            .flexible(true)
            .trim(Trim::All)
            .comment(Some(b'#'))
            .from_reader(source.text.as_bytes());
        let unreadable =
            |error: csv::Error| refused(format!("{} is no CSV file: {error}", source.name));
        let header = reader.headers().map_err(unreadable)?.clone();
        let rows = reader.records().collect::<Result<_, _>>().map_err(unreadable)?;
        Ok(Self { source, header, rows })
    }

    /// Refuses rows with more or fewer cells than the header: a decimal comma makes two cells of a number.
    fn check_lengths(&self) -> Result<(), TreeError> {
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
    fn column(&self, name: &str, key: &str, file: &TomlNode) -> Result<usize, TreeError> {
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
    fn points(&self, times: usize, values: usize) -> Result<Vec<[f64; 2]>, TreeError> {
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

/// Slopes of the natural cubic spline through two points or more, their abscissae ascending:
/// continuous second derivatives, zero at both ends.
fn natural_slopes(points: &[[f64; 2]]) -> Vec<f64> {
    let n = points.len();
    let inverse = |i: usize| 1.0 / (points[i + 1][0] - points[i][0]);
    let chord = |i: usize| (points[i + 1][1] - points[i][1]) * inverse(i);
    // Thomas algorithm for a_(i-1) s_(i-1) + 2 (a_(i-1) + a_i) s_i + a_i s_(i+1)
    // = 3 (a_(i-1) c_(i-1) + a_i c_i), with a the inverse distances and c the slopes of the chords
    let mut slopes = vec![0.0; n];
    let mut factors = vec![0.0; n];
    for i in 0..n {
        let before = if i > 0 { inverse(i - 1) } else { 0.0 };
        let after = if i + 1 < n { inverse(i) } else { 0.0 };
        let behind = if i > 0 { before * chord(i - 1) } else { 0.0 };
        let ahead = if i + 1 < n { after * chord(i) } else { 0.0 };
        let (factor, slope) = if i > 0 { (factors[i - 1], slopes[i - 1]) } else { (0.0, 0.0) };
        let pivot = 2.0 * (before + after) - before * factor;
        factors[i] = after / pivot;
        slopes[i] = (3.0 * (behind + ahead) - before * slope) / pivot;
    }
    for i in (0..n - 1).rev() {
        slopes[i] -= factors[i] * slopes[i + 1];
    }
    slopes
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::Stroke;

    #[test]
    fn a_sampled_sine_is_a_sine_with_its_rate() {
        let error = |n: u32| {
            let time = |i: u32| 2.0 * f64::from(i) / f64::from(n);
            let points: Vec<[f64; 2]> = (0..=n).map(|i| [time(i), (TAU * time(i)).sin()]).collect();
            let slopes = natural_slopes(&points);
            let knots = points.iter().zip(slopes).map(|([t, x], slope)| [*t, *x, slope]);
            let stroke = Stroke::Cubic(knots.collect());
            (1..400).map(|i| f64::from(i) / 200.0).fold([0.0f64; 2], |most, time| {
                let [value, rate] = stroke.at(time);
                let (sin, cos) = (TAU * time).sin_cos();
                [most[0].max((value - sin).abs()), most[1].max((rate / TAU - cos).abs())]
            })
        };
        let [coarse, fine] = [error(40), error(80)];
        // Fourth order in values, third in rates; the sine has no curvature at the ends either
        assert!(fine[0] < 2e-6 && coarse[0] / fine[0] > 12.0, "{coarse:?} {fine:?}");
        assert!(fine[1] < 1e-4 && coarse[1] / fine[1] > 6.0, "{coarse:?} {fine:?}");
    }

    #[test]
    fn two_points_are_joined_by_a_line() {
        assert_eq!(natural_slopes(&[[0.0, 1.0], [2.0, 5.0]]), vec![2.0, 2.0]);
    }
}
