//! `Record`: a recorded motion from a table of comma-separated values.

use super::SoftError;

/// What becomes of values that are not numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Gaps {
    /// A gap is a mistake.
    Refused,
    /// A gap stays one: what is compared with it is left out.
    Kept,
}

/// Columns of numbers over time.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Names of the columns but the first, which is the time.
    pub names: Vec<String>,
    /// Times, as they were written, rising.
    pub times: Vec<f64>,
    /// The other columns, row by row.
    pub rows: Vec<Vec<f64>>,
}

impl Record {
    /// Reads a table with one row of names; the first column is the time. `file` is named in messages.
    ///
    /// # Errors
    /// [`SoftError::Record`] with the row.
    pub fn parse(file: &str, text: &str, gaps: Gaps) -> Result<Self, SoftError> {
        let wrong =
            |row: usize, what: String| SoftError::Record { file: file.to_owned(), row, what };
        let mut reader = csv::ReaderBuilder::new()
            .flexible(true)
            .trim(csv::Trim::All)
            .from_reader(text.as_bytes());
        let header = reader.headers().map_err(|error| wrong(1, error.to_string()))?.clone();
        let n_columns = n_filled(&header);
        if n_columns < 2 {
            return Err(wrong(1, "a record has a time and at least one other column".to_owned()));
        }
        let names = header.iter().skip(1).take(n_columns - 1).map(str::to_owned).collect();
        let mut record = Self { names, times: Vec::new(), rows: Vec::new() };
        for (number, line) in reader.records().enumerate() {
            let row = number + 2;
            let line = line.map_err(|error| wrong(row, error.to_string()))?;
            let n_found = n_filled(&line);
            if n_found != n_columns {
                let what = format!("{n_found} values where the header names {n_columns}");
                return Err(wrong(row, what));
            }
            let mut values = Vec::with_capacity(n_columns);
            for (column, cell) in line.iter().take(n_columns).enumerate() {
                let value: f64 = cell.parse().map_err(|_| {
                    wrong(row, format!("`{cell}` in column `{}` is no number", &header[column]))
                })?;
                let is_gap = value.is_nan() && column > 0 && gaps == Gaps::Kept;
                if !value.is_finite() && !is_gap {
                    let name = &header[column];
                    let what = format!(
                        "`{cell}` in column `{name}`: gaps are accepted where this is chosen, and never in time"
                    );
                    return Err(wrong(row, what));
                }
                values.push(value);
            }
            let time = values.remove(0);
            if record.times.last().is_some_and(|last| *last >= time) {
                return Err(wrong(row, format!("the time {time} does not rise")));
            }
            record.times.push(time);
            record.rows.push(values);
        }
        if record.times.len() < 2 {
            return Err(wrong(1, "a record has at least two rows of values".to_owned()));
        }
        Ok(record)
    }

    /// The mean time between rows, as written.
    #[must_use]
    pub fn interval(&self) -> f64 {
        let n = self.times.len();
        (self.times[n - 1] - self.times[0]) / (n - 1) as f64
    }
}

/// Number of cells up to the last that is not empty: a comma at the end of a row is no further column.
fn n_filled(row: &csv::StringRecord) -> usize {
    (0..row.len()).rev().find(|at| !row[*at].is_empty()).map_or(0, |at| at + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_is_read_as_written() {
        let text = "t, pull, x\n0.0, 1, NaN,\n0.5, 2, 3,\n";
        let record = Record::parse("r.csv", text, Gaps::Kept).expect("it is one");
        assert_eq!(record.names, ["pull", "x"]);
        assert_eq!(record.times, [0.0, 0.5]);
        assert!(record.rows[0][1].is_nan());
        assert_eq!(record.rows[1], [2.0, 3.0]);
        assert_eq!(record.interval(), 0.5);
    }

    #[test]
    fn wrong_records_are_refused_by_row() {
        for (text, says) in [
            ("t,x\n0,1\n0,2\n", "r.csv, row 3: the time 0 does not rise"),
            ("t,x\n0,1\n1\n", "r.csv, row 3: 1 values where the header names 2"),
            ("t,x\n0,NaN\n1,2\n", "r.csv, row 2: `NaN` in column `x`: gaps are accepted where"),
            ("t,x\n0,1\n1,wet\n", "r.csv, row 3: `wet` in column `x` is no number"),
            ("t\n0\n1\n", "r.csv, row 1: a record has a time and at least one other column"),
            ("t,x\n0,1\n", "r.csv, row 1: a record has at least two rows of values"),
        ] {
            let said = Record::parse("r.csv", text, Gaps::Refused).expect_err("it is wrong");
            assert!(said.to_string().starts_with(says), "{said}");
        }
        let said = Record::parse("r.csv", "t,x\nNaN,1\n1,2\n", Gaps::Kept).expect_err("no time");
        assert!(said.to_string().contains("never in time"), "{said}");
    }
}
