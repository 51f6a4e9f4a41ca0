//! The files of a search, and whether they agree with its journals.

use std::fs;

use serde_json::Value;

use super::found::Found;
use super::run::first_line;
use crate::case::Case;
use crate::case::soft::SoftFile;
use crate::cli::searched::{Kind, Named, SearchDirectory};

/// Relative difference of a number that was read from JSON.
const ROUNDING: f64 = 1e-14;

/// Looks at what a search has left.
pub fn verify(search: &SearchDirectory) -> Found {
    let mut found = Found::new(&search.path, search.kind.name());
    found.state = search.state().to_owned();
    found.count("journals", search.journals.len());
    found.count("evaluations", search.n_evaluations());
    for Named { file, journal } in &search.journals {
        let is_nan = |values: &[f64]| values.iter().any(|value| value.is_nan());
        let wrong = |one: &alewife_reduced::search::Evaluated| {
            one.objective.is_nan() || is_nan(&one.values) || is_nan(&one.slopes)
        };
        if let Some(nth) = journal.known.iter().position(wrong) {
            found.wrong(file, format!("line {}: a number has no value", nth + 2));
        }
        // What a search was writing when it was killed is taken out when it goes on
        if search.state() == "finished" && !journal.is_whole {
            let line = journal.known.len() + 2;
            found.wrong(file, format!("line {line} is damaged, and the search is finished"));
        }
    }
    if search.state() != "finished" {
        return found;
    }
    match search.last {
        Some("report.json") => check_report(search, &mut found),
        Some("rounds.csv") => check_rounds(search, &mut found),
        _ => check_calibrated(search, &mut found),
    }
    found
}

/// The case with what was found can be read.
fn check_case(search: &SearchDirectory, found: &mut Found) {
    let path = search.path.join("case.toml").display().to_string();
    let read = match SoftFile::read_if_soft(&path, &[]) {
        Ok(Some(_)) => Ok(()),
        Ok(None) => Case::read(&path, &[]).map(|_| ()),
        Err(error) => Err(error),
    };
    found.read("case.toml", read.map_err(|error| first_line(&error.to_string())));
}

/// A report has all evaluations, and the best of the last journal.
fn check_report(search: &SearchDirectory, found: &mut Found) {
    check_case(search, found);
    let file = "report.json";
    let read = fs::read(search.path.join(file)).map_err(|error| error.to_string());
    let read = read
        .and_then(|text| serde_json::from_slice::<Value>(&text).map_err(|error| error.to_string()));
    let Some(report) = found.read(file, read) else { return };
    let n = search.n_evaluations();
    if report["evaluations"].as_u64() != Some(n as u64) {
        let told = &report["evaluations"];
        found.wrong(file, format!("it has {told} evaluations, and the journals have {n}"));
    }
    let best = search.journals.last().and_then(|last| last.journal.best());
    let parameters = report["parameters"].as_array().map(Vec::as_slice).unwrap_or_default();
    for (nth, value) in best.into_iter().flat_map(|best| &best.values).enumerate() {
        let told = parameters.get(nth).and_then(|one| one["value"].as_f64());
        if !told.is_some_and(|told| (told - value).abs() <= ROUNDING * value.abs()) {
            let name = parameters.get(nth).and_then(|one| one["name"].as_str()).unwrap_or("?");
            found.wrong(file, format!("`{name}` is not that of the best evaluation, {value}"));
        }
    }
    let table = "evaluations.csv";
    let has_table = search.kind == Kind::Optimisation && search.journals.iter().any(is_round);
    if let Some(rows) = found_rows(search, table, has_table, found)
        && rows.len() != n
    {
        found.wrong(table, format!("it has {} rows, and the journals {n} evaluations", rows.len()));
    }
}

/// A loop has a row of each round, with what its two searches found.
fn check_rounds(search: &SearchDirectory, found: &mut Found) {
    check_case(search, found);
    let file = "rounds.csv";
    let Some(rows) = found_rows(search, file, true, found) else { return };
    found.count("rounds", rows.len());
    for (nth, row) in rows.iter().enumerate() {
        let round = nth + 1;
        for (what, column, sign) in [("optimisation", 2, -1.0), ("calibration", 4, 1.0)] {
            let name = format!("round-{round}-{what}.journal");
            let journal = search.journals.iter().find(|one| one.file == name);
            let best = journal.and_then(|one| one.journal.best()).map(|best| sign * best.objective);
            let Some(best) = best else {
                found.wrong(&name, "it is missing, or has no evaluations");
                continue;
            };
            let told = row.get(column).and_then(|cell| cell.parse::<f64>().ok());
            if told != Some(best) {
                let what = format!("line {}: the best of {name} is {best}", round + 1);
                found.wrong(file, what);
            }
        }
    }
}

/// What was calibrated of a reduced model can be read.
fn check_calibrated(search: &SearchDirectory, found: &mut Found) {
    let file = "calibrated.toml";
    let read = fs::read_to_string(search.path.join(file)).map_err(|error| error.to_string());
    let read = read.and_then(|text| {
        text.parse::<toml::Table>().map_err(|error| first_line(&error.to_string()))
    });
    found.read(file, read);
    found_rows(search, "tracks.csv", false, found);
}

fn is_round(one: &Named) -> bool {
    one.file.starts_with("round-")
}

/// The rows of a table below its header, each with a cell a column; nothing where there is none, which is reported of a
/// table that has to be there.
fn found_rows(
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
