//! The saved states of a run: whether they can be read, continue its case, and have the rows of its series.

use std::path::Path;

use super::found::Found;
use super::known::Known;
use crate::case::Case;
use crate::observer::{FAILURE_STATE, checkpoints, read_state};
use crate::run::{SavedState, Series};

/// Looks at all states of a run.
pub fn check(directory: &Path, known: &Known, found: &mut Found) {
    let Some(case) = &known.case else { return };
    let Some(mut paths) = found.read("checkpoints", checkpoints(directory)) else { return };
    let n = paths.len();
    paths.extend(Some(directory.join(FAILURE_STATE)).filter(|path| path.is_file()));
    found.count("states", paths.len());
    for (index, path) in paths.iter().enumerate() {
        let is_checkpoint = index < n;
        match case.geometry.dimensions() {
            2 => check_one::<2>(path, is_checkpoint, case, known, found),
            _ => check_one::<3>(path, is_checkpoint, case, known, found),
        }
    }
}

fn check_one<const D: usize>(
    path: &Path,
    is_checkpoint: bool,
    case: &Case,
    known: &Known,
    found: &mut Found,
) {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let folder = path.parent().and_then(Path::file_name).unwrap_or_default().to_string_lossy();
    let file = format!("{folder}/{name}");
    // A process may have replaced it by a newer one
    if known.is_under_way && !path.exists() {
        return;
    }
    let read = read_state::<D>(path).map_err(|error| {
        let reported = error.to_string();
        reported.rsplit_once(".state: ").map_or(reported.clone(), |(_, what)| what.to_owned())
    });
    let Some(state) = found.read(&file, read) else { return };
    if let Err(error) = state.check_case(case) {
        found.wrong(&file, error);
    }
    let number = path.file_stem().and_then(|stem| stem.to_str()?.parse::<usize>().ok());
    if is_checkpoint && number != Some(state.step()) {
        found.wrong(&file, format!("it is of step {}", state.step()));
    }
    let reached = known.status.as_ref().map(|status| status.step);
    if known.is_finished() && reached.is_some_and(|reached| state.step() > reached) {
        found.wrong(&file, "it is of a later step than status.json");
    }
    if let Some(what) = known.series.as_ref().and_then(|series| difference(series, &state)) {
        found.wrong("series.csv", format!("{what} in {file}"));
    }
}

/// What of a series differs from that of a state, up to its time.
fn difference<const D: usize>(written: &Series, state: &SavedState<D>) -> Option<String> {
    let all = state.series();
    if written.names.is_empty() || all.times.is_empty() {
        return None;
    }
    if written.names != all.names {
        return Some("its columns are others than".to_owned());
    }
    let first = all.times[0];
    let both = written.times.iter().zip(&written.rows);
    for (index, (time, row)) in both.enumerate() {
        if !(first..=state.time()).contains(time) {
            continue;
        }
        let line = index + 2;
        let at = all.times.partition_point(|known| known < time);
        if all.times.get(at) != Some(time) {
            return Some(format!("line {line} is of a time that is not"));
        }
        let is_same = |(one, other): (&f64, &f64)| one == other || (one.is_nan() && other.is_nan());
        if !row.iter().zip(&all.rows[at]).all(is_same) {
            return Some(format!("line {line} has other values than"));
        }
    }
    None
}
