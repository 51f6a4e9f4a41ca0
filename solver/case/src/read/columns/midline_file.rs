//! Midlines from files: a `gait.midline` with a `file` becomes one with its `positions` and `table`.

use csv::{ReaderBuilder, Trim};

use super::point_file::{file_of, list, resolve_in_bodies, rows, text_of};
use crate::text::tree::{TomlNode, TreeError};

/// What a file of a midline holds.
const WANTED: &str = "write a header t, 0.0, ..., 1.0 of positions s/L, and in each row a time (s) and the values there, \
                      with commas between them and decimal points";

/// Puts tables in the place of the names of their files, so that a case stands for itself.
///
/// # Errors
/// When a file cannot be read, or holds no table.
pub fn resolve(root: &mut TomlNode) -> Result<(), TreeError> {
    resolve_in_bodies(root, |key, entry| (key == "midline").then(|| resolve_midline(entry)))
}

fn resolve_midline(midline: &mut TomlNode) -> Result<(), TreeError> {
    let file = file_of(midline);
    let (Some(file), Some(entries)) = (file, midline.table_mut()) else { return Ok(()) };
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
    let source = text_of(file, "CSV")?;
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
    let mut table: Vec<Vec<f64>> = Vec::new();
    for record in reader.records() {
        let record = record.map_err(unreadable)?;
        let line = record.position().map_or(0, csv::Position::line);
        let place = format!("line {line}");
        table.push(record.iter().map(|text| number(text, &place)).collect::<Result<_, _>>()?);
    }
    Ok([list(file, &positions), rows(file, &table)])
}
