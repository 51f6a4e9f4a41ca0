//! Tables that a search has written.

use std::fs;

use super::found::Found;
use crate::cli::searched::SearchDirectory;

/// The rows of a table below its header, each with a cell a column; nothing where there is none, which is reported of a
/// table that has to be there.
pub fn found_rows(
    search: &SearchDirectory,
    file: &str,
    is_wanted: bool,
    found: &mut Found,
) -> Option<Vec<Vec<String>>> {
    let path = search.path.join(file);
    if !path.exists() && !is_wanted {
        return None;
    }
    let text = found.read(file, fs::read_to_string(path))?;
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
    let n_columns = lines.next().map_or(0, |header| header.len());
    let rows: Vec<Vec<String>> = lines.collect();
    if let Some(nth) = rows.iter().position(|row| row.len() != n_columns) {
        found.wrong(file, format!("line {} has not {n_columns} cells", nth + 2));
        return None;
    }
    Some(rows)
}
