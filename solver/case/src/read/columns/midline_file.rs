//! Midlines from files: a `gait.midline` with a `file` becomes one with its `positions` and `table`.

use csv::{ReaderBuilder, Trim};

use crate::read::case_text::source_beside;
use crate::text::tree::{TomlNode, TomlValue, TreeError};

/// Tables of a case with gaits in them.
const TABLES: [&str; 2] = ["body", "swimmer"];

/// What a file of a midline holds.
const WANTED: &str = "write a header t, 0.0, ..., 1.0 of positions s/L, and in each row a time (s) and the values there, \
                      with commas between them and decimal points";

/// Puts tables in the place of the names of their files, so that a case stands for itself.
///
/// # Errors
/// When a file cannot be read, or holds no table.
pub fn resolve(root: &mut TomlNode) -> Result<(), TreeError> {
    for table in TABLES {
        if let Some(node) = root.table_mut().and_then(|entries| entries.get_mut(table)) {
            resolve_below(node)?;
        }
    }
    Ok(())
}

fn resolve_below(node: &mut TomlNode) -> Result<(), TreeError> {
    match &mut node.value {
        TomlValue::Table(entries) => {
            for (key, entry) in entries {
                if key == "midline" {
                    resolve_midline(entry)?;
                } else {
                    resolve_below(entry)?;
                }
            }
        }
        TomlValue::Array(items) => {
            for item in items {
                resolve_below(item)?;
            }
        }
        _ => {}
    }
    Ok(())
}

fn resolve_midline(midline: &mut TomlNode) -> Result<(), TreeError> {
    let Some(entries) = midline.table_mut() else { return Ok(()) };
    // A path of another type is refused when the case is typed
    let Some(file) = entries.get("file").filter(|file| file.text().is_some()).cloned() else {
        return Ok(());
    };
    let [positions, table] = read(&file)?;
    entries.remove("file");
    entries.insert("positions".to_owned(), positions);
    entries.insert("table".to_owned(), table);
    Ok(())
}

/// Positions and rows of a file.
fn read(file: &TomlNode) -> Result<[TomlNode; 2], TreeError> {
    let name = file.text().unwrap_or_default();
    let refused = |message: String| TreeError {
        origin: file.origin.clone(),
        message,
        help: WANTED.to_owned(),
    };
    let source = source_beside(name, &file.origin).map_err(|message| TreeError {
        origin: file.origin.clone(),
        message,
        help: "give the path of a CSV file, relative to the file in which it is written".to_owned(),
    })?;
    let mut reader = ReaderBuilder::new()
        .trim(Trim::All)
        .comment(Some(b'#'))
        .from_reader(source.text.as_bytes());
    let unreadable = |error: csv::Error| refused(format!("{name} is no table: {error}"));
    let header = reader.headers().map_err(unreadable)?.clone();
    let number = |text: &str, place: &str| {
        let number = text.parse::<f64>().ok().filter(|number| number.is_finite());
        number.ok_or_else(|| refused(format!("{name}: {place} has \"{text}\", which is no number")))
    };
    let positions: Vec<f64> =
        header.iter().skip(1).map(|text| number(text, "the header")).collect::<Result<_, _>>()?;
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for record in reader.records() {
        let record = record.map_err(unreadable)?;
        let line = record.position().map_or(0, csv::Position::line);
        let place = format!("line {line}");
        rows.push(record.iter().map(|text| number(text, &place)).collect::<Result<_, _>>()?);
    }
    let node = |value| TomlNode { key: file.key.clone(), origin: file.origin.clone(), value };
    let list = |values: &[f64]| {
        node(TomlValue::Array(values.iter().map(|x| node(TomlValue::Float(*x))).collect()))
    };
    let rows = rows.iter().map(|row| list(row)).collect();
    Ok([list(&positions), node(TomlValue::Array(rows))])
}
