//! `read_series`: the rows of `series.csv`, of a run that ended or is under way.

use std::fs;
use std::io;
use std::path::Path;

use crate::observer::system::AtPath;
use crate::run::Series;

/// The file of a run directory.
pub(in crate::observer) const SERIES_FILE: &str = "series.csv";

/// All whole rows that the run in `directory` has written so far; none if there is no header yet.
///
/// # Errors
/// When there is no such file, or a row is damaged: the file, the number of the line, and what is wrong.
pub fn read_series(directory: &Path) -> io::Result<Series> {
    let path = directory.join(SERIES_FILE);
    let text = String::from_utf8_lossy(&fs::read(&path).at(&path)?).into_owned();
    // A row without its end is one that is being written
    match text.rfind('\n').map_or("", |end| &text[..=end]) {
        "" => Ok(Series::default()),
        whole => series_of(&path, whole),
    }
}

/// The series in the text of a file.
///
/// # Errors
/// When a line is damaged, with the file and its number.
pub(super) fn series_of(path: &Path, text: &str) -> io::Result<Series> {
    let mut lines = text.lines();
    let header = lines.next().unwrap_or_default();
    let names: Vec<String> = header.split(',').skip(1).map(str::to_owned).collect();
    let mut series = Series { names, ..Series::default() };
    for (index, line) in lines.enumerate() {
        let Row { time, values } = row(line, series.names.len())
            .map_err(|why| io::Error::other(format!("line {} is damaged: {why}", index + 2)))
            .at(path)?;
        series.times.push(time);
        series.rows.push(values);
    }
    Ok(series)
}

/// One line of numbers.
struct Row {
    time: f64,
    values: Vec<f64>,
}

/// Reads a time and so many values, or reports what is wrong.
fn row(line: &str, n_values: usize) -> Result<Row, String> {
    let number = |text: &str| text.parse().map_err(|_| format!("`{text}` is no number"));
    let numbers: Vec<f64> = line.split(',').map(number).collect::<Result<_, _>>()?;
    match numbers.as_slice() {
        [time, values @ ..] if values.len() == n_values => {
            Ok(Row { time: *time, values: values.to_vec() })
        }
        found => Err(format!("{} values, where the header names {}", found.len(), n_values + 1)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> io::Result<Series> {
        series_of(Path::new("series.csv"), text)
    }

    #[test]
    fn a_series_is_read_as_it_was_written() {
        let series = read("time,a.x,b.y\n0.0,1.5,NaN\n0.1,-2e-5,inf\n").unwrap();
        assert_eq!(series.names, ["a.x", "b.y"]);
        assert_eq!(series.times, [0.0, 0.1]);
        assert_eq!(series.column("a.x"), Some(vec![1.5, -2e-5]));
        assert!(series.rows[0][1].is_nan() && series.rows[1][1] == f64::INFINITY);
    }

    #[test]
    fn a_damaged_row_is_told_with_its_line() {
        for (text, wanted) in [
            ("time,a.x\n0.0,1.0\n0.1\n", "line 3 is damaged: 1 values, where the header names 2"),
            ("time,a.x\n0.0,one\n", "line 2 is damaged: `one` is no number"),
            ("time,a.x\n0.0,1.0,2.0\n", "line 2 is damaged: 3 values, where the header names 2"),
        ] {
            assert_eq!(read(text).unwrap_err().to_string(), format!("series.csv: {wanted}"));
        }
    }

    #[test]
    fn a_row_that_is_being_written_is_left_out() {
        let place = tempfile::tempdir().unwrap();
        let of = |text: &str| {
            fs::write(place.path().join(SERIES_FILE), text).unwrap();
            read_series(place.path()).unwrap()
        };
        assert_eq!(of("time,a\n0.0,1.0\n0.1,2.").times, [0.0]);
        assert_eq!(of("time,a"), Series::default());
        assert!(read_series(&place.path().join("nowhere")).is_err());
    }
}
