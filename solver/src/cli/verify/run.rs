//! The files of a run, one after the other, and whether they agree.

use std::path::Path;

use serde_json::Value;

use super::found::Found;
use super::known::Known;
use super::{fields, records, states};
use crate::case::{Cadence, Case, TimeSettings};
use crate::observer::{COMPARISON_FILE, Provenance, RunLock, Status, checksum, read_series};
use crate::run::Series;

/// Part of the end of a run by which its last time may differ for rounding.
const ROUNDING: f64 = 1e-9;

/// Looks at the run in a directory.
pub fn verify(directory: &Path) -> Found {
    let mut found = Found::new(directory, "run");
    let is_under_way = RunLock::is_held(directory, &["status.json"]);
    let known = Known {
        case: case(directory, &mut found),
        status: found.read("status.json", Status::read(directory)),
        provenance: found.read("provenance.json", Provenance::read(directory)),
        series: series(directory, &mut found),
        is_under_way,
    };
    found.state = state(&known).to_owned();
    check_provenance(directory, &known, &mut found);
    check_series(&known, &mut found);
    check_end(&known, &mut found);
    states::check(directory, &known, &mut found);
    fields::check(directory, &known, &mut found);
    records::check_messages(directory, &known, &mut found);
    records::check_log(directory, &known, &mut found);
    check_comparison(directory, &known, &mut found);
    found
}

pub(super) fn state(known: &Known) -> &'static str {
    let in_a_word = |status: &Status| status.state.in_a_word(known.is_under_way);
    known.status.as_ref().map_or("unknown", in_a_word)
}

/// The case as it was run.
fn case(directory: &Path, found: &mut Found) -> Option<Case> {
    let path = directory.join("case.toml").display().to_string();
    let read = Case::read(&path, &[]).map(|file| file.model.case);
    found.read("case.toml", read.map_err(|error| first_line(&error.to_string())))
}

pub(super) fn first_line(text: &str) -> String {
    text.lines().next().unwrap_or_default().to_owned()
}

/// All whole rows; nothing where there is no such file.
pub(super) fn series(directory: &Path, found: &mut Found) -> Option<Series> {
    let is_there = directory.join("series.csv").exists();
    is_there.then(|| found.read("series.csv", read_series(directory)))?
}

/// Legs follow each other, and the last one is of the case that is there.
pub(super) fn check_provenance(directory: &Path, known: &Known, found: &mut Found) {
    let file = "provenance.json";
    let Some(Provenance { origin, legs }) = &known.provenance else { return };
    let [first, .., last] = &legs.iter().collect::<Vec<_>>()[..] else {
        if let [only] = &legs[..] {
            check_leg(directory, &only.origin.case_hash, found);
        } else {
            found.wrong(file, "it has no legs");
        }
        return;
    };
    check_leg(directory, &last.origin.case_hash, found);
    if first.origin != *origin {
        found.wrong(file, "its origin is not that of its first leg");
    }
    for (index, pair) in legs.windows(2).enumerate() {
        let reached = pair[0].to.map(|to| to.step);
        if reached.is_some_and(|reached| pair[1].from.step > reached) {
            let (from, leg) = (pair[1].from.step, index + 2);
            let before = reached.unwrap_or_default();
            found.wrong(
                file,
                format!("leg {leg} begins at step {from}, and the one before got to {before}"),
            );
        }
    }
}

fn check_leg(directory: &Path, wanted: &str, found: &mut Found) {
    let Ok(text) = std::fs::read(directory.join("case.toml")) else { return };
    let hash = checksum(&text);
    if hash != wanted {
        let what = format!("its checksum is {hash}, and the latest leg ran a case of {wanted}");
        found.wrong("case.toml", what);
    }
}

/// Times rise, and none is later than the run.
pub(super) fn check_series(known: &Known, found: &mut Found) {
    let Some(series) = &known.series else {
        let is_wanted =
            known.case.as_ref().is_some_and(|case| case.output.series != Cadence::Never);
        if is_wanted && known.is_finished() {
            found.wrong("series.csv", "it is missing");
        }
        return;
    };
    let file = "series.csv";
    found.count("rows", series.times.len());
    if let Some(at) =
        series.times.windows(2).position(|pair| pair[1] <= pair[0] || pair[1].is_nan())
    {
        let [before, after] = [series.times[at], series.times[at + 1]];
        found.wrong(file, format!("line {}: time {after} does not come after {before}", at + 3));
    }
    let Some(status) = &known.status else { return };
    let last = series.times.last().copied();
    if !known.is_under_way && last.is_some_and(|last| last > status.time && known.is_finished()) {
        found.wrong(
            file,
            format!("its last row is of a later time than {} in status.json", status.time),
        );
    }
    let every_step =
        known.case.as_ref().is_some_and(|case| case.output.series == Cadence::Steps(1));
    if known.is_finished() && every_step && series.times.len() != status.step + 1 {
        let (n, steps) = (series.times.len(), status.step);
        found.wrong(file, format!("it has {n} rows, and {steps} steps were made"));
    }
    if known.is_finished() && last.is_some_and(|last| last < status.time) {
        found.wrong(file, format!("its last row is of an earlier time than {}", status.time));
    }
}

/// A run that is finished has reached the end of its case.
fn check_end(known: &Known, found: &mut Found) {
    let (Some(case), Some(status)) = (&known.case, &known.status) else { return };
    let TimeSettings::Unsteady(settings) = &case.time else { return };
    let is_early = status.time < settings.end * (1.0 - ROUNDING);
    if known.is_finished() && settings.until.is_none() && is_early {
        let (time, end) = (status.time, settings.end);
        found.wrong(
            "status.json",
            format!("it is finished at time {time}, and the case ends at {end}"),
        );
    }
    check_last_leg(known, found);
}

/// The last leg of a run that is finished has ended so.
pub(super) fn check_last_leg(known: &Known, found: &mut Found) {
    let last = known.provenance.as_ref().and_then(|provenance| provenance.legs.last());
    if known.is_finished() && last.is_some_and(|leg| leg.end.as_deref() != Some("finished")) {
        found
            .wrong("provenance.json", "its last leg has not ended as finished, as status.json has");
    }
}

/// A comparison is that of a case which was run here.
fn check_comparison(directory: &Path, known: &Known, found: &mut Found) {
    let path = directory.join(COMPARISON_FILE);
    if !path.exists() {
        return;
    }
    let read = std::fs::read(&path).map_err(|error| error.to_string());
    let read = read
        .and_then(|text| serde_json::from_slice::<Value>(&text).map_err(|error| error.to_string()));
    let Some(comparison) = found.read(COMPARISON_FILE, read) else { return };
    let hash = comparison["provenance"]["case_hash"].as_str().unwrap_or_default();
    if !known.is_of_a_leg(hash) {
        found.wrong(
            COMPARISON_FILE,
            format!("it is of a case of checksum {hash}, which was not run here"),
        );
    }
}
