//! Columns of CSV files with a header.

use crate::run::Series;

/// A CSV file: its header and its rows.
pub struct Table {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    pub fn n_rows(&self) -> usize {
        self.rows.len()
    }

    /// The numbers of a column.
    ///
    /// # Errors
    /// When there is none of that name, or something in it is no number.
    pub fn column(&self, name: &str) -> Result<Vec<f64>, String> {
        let Some(number) = self.header.iter().position(|known| known == name) else {
            return Err(format!(
                "there is no column `{name}`; columns: {}",
                self.header.join(", ")
            ));
        };
        let value = |(row, fields): (usize, &Vec<String>)| {
            let text = fields.get(number).map(String::as_str).unwrap_or_default();
            let value = text.parse().ok().filter(|value: &f64| value.is_finite());
            value.ok_or_else(|| format!("line {}: `{name}` is `{text}`, not a number", row + 2))
        };
        self.rows.iter().enumerate().map(value).collect()
    }
}

/// Reads a CSV file.
///
/// # Errors
/// When it is none.
pub fn table(bytes: &[u8]) -> Result<Table, String> {
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(bytes);
    let header = reader.headers().map_err(|error| error.to_string())?;
    let header = header.iter().map(str::to_owned).collect();
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| error.to_string())?;
        rows.push(record.iter().map(str::to_owned).collect());
    }
    Ok(Table { header, rows })
}

/// Reads a `series.csv`; what is no number there was none.
///
/// # Errors
/// When it is no such file.
pub fn series(bytes: &[u8]) -> Result<Series, String> {
    let table = table(bytes)?;
    if table.header.first().is_none_or(|first| first != "time") {
        return Err("series.csv does not begin with a column `time`".to_owned());
    }
    let times = table.column("time")?;
    let row = |fields: &Vec<String>| {
        fields.iter().skip(1).map(|text| text.parse().unwrap_or(f64::NAN)).collect()
    };
    let rows = table.rows.iter().map(row).collect();
    Ok(Series { names: table.header[1..].to_vec(), times, rows })
}

/// A checksum of what a file holds.
pub fn hash(bytes: &[u8]) -> String {
    format!("crc32:{:08x}", crc32fast::hash(bytes))
}
