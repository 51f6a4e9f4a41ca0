//! The files of a search, and whether they agree with its journals.

use std::fs;

use super::found::Found;
use super::run::first_line;
use super::table::found_rows;
use super::{report, searched_case};
use crate::cli::searched::{Named, SearchDirectory, round_of};

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
    check_beginnings(search, &mut found);
    if search.state() != "finished" {
        return found;
    }
    match search.last {
        Some("report.json") => report::check(search, &mut found),
        Some("rounds.csv") => check_rounds(search, &mut found),
        _ => check_calibrated(search, &mut found),
    }
    found
}

/// Journals begin with one and the same case, and with the round in their name.
fn check_beginnings(search: &SearchDirectory, found: &mut Found) {
    let first = search.journals.first().and_then(Named::checksum);
    for one in &search.journals {
        if let (Some(own), Some(first)) = (one.checksum(), first)
            && own != first
        {
            let what =
                format!("line 1: it is of a case of {own}, and the first journal of {first}");
            found.wrong(&one.file, what);
        }
        let named = round_of(&one.file);
        if let Some(own) = one.round().filter(|own| *own != named) {
            found.wrong(&one.file, format!("line 1: it is of round {own}"));
        }
    }
}

/// A loop has a row of each round, with what its two searches found.
fn check_rounds(search: &SearchDirectory, found: &mut Found) {
    searched_case::check(search, found);
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
