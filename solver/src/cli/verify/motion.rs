//! The files of a run without a flow, of a soft case or by a reduced model, and whether they agree.

use std::path::Path;

use serde_json::Value;

use super::found::Found;
use super::known::Known;
use super::{fields, run};
use crate::case::Case;
use crate::case::soft::SoftFile;
use crate::observer::{COMPARISON_FILE, Provenance, RunLock, Status};

/// The model of soft cases, by its name on the command line.
const SOFT: &str = "soft";

/// Looks at the run in a directory, of a model by its name.
pub fn verify(directory: &Path, model: &str) -> Found {
    let mut found = Found::new(directory, "run");
    let is_under_way = RunLock::is_held(directory, &["status.json"]);
    let rows = rows(directory, model, &mut found);
    let known = Known {
        case: None,
        status: found.read("status.json", Status::read(directory)),
        provenance: found.read("provenance.json", Provenance::read(directory)),
        series: run::series(directory, &mut found),
        is_under_way,
    };
    found.state = run::state(&known).to_owned();
    run::check_provenance(directory, &known, &mut found);
    run::check_series(&known, &mut found);
    run::check_last_leg(&known, &mut found);
    check_rows(&known, rows, &mut found);
    if model == SOFT && known.is_finished() {
        fields::check(directory, &known, &mut found);
        check_comparison(directory, &known, &mut found);
    }
    found
}

/// The rows that the series of the case has in the end, where the case says.
fn rows(directory: &Path, model: &str, found: &mut Found) -> Option<usize> {
    let path = directory.join("case.toml").display().to_string();
    let read = if model == SOFT {
        SoftFile::read(&path, &[]).map(|file| Some(file.case.soft.frames + 1))
    } else {
        Case::read(&path, &[]).map(|_| None)
    };
    found.read("case.toml", read.map_err(|error| run::first_line(&error.to_string())))?
}

/// A run that is finished has a row of each frame, or of each step, and one of its start.
fn check_rows(known: &Known, rows: Option<usize>, found: &mut Found) {
    let Some(status) = known.status.as_ref().filter(|_| known.is_finished()) else { return };
    let Some(series) = &known.series else {
        found.wrong("series.csv", "it is missing");
        return;
    };
    let (wanted, of) = rows.map_or((status.step + 1, "steps"), |rows| (rows, "frames"));
    if series.times.len() != wanted {
        let n = series.times.len();
        let what = format!("it has {n} rows, and {} {of} were made", wanted.saturating_sub(1));
        found.wrong("series.csv", what);
    }
}

/// What was compared is what the series ends with.
fn check_comparison(directory: &Path, known: &Known, found: &mut Found) {
    let read = std::fs::read(directory.join(COMPARISON_FILE)).map_err(|error| error.to_string());
    let read = read
        .and_then(|text| serde_json::from_slice::<Value>(&text).map_err(|error| error.to_string()));
    let Some(all) = found.read(COMPARISON_FILE, read) else { return };
    let Some(series) = &known.series else { return };
    for one in all.as_array().into_iter().flatten() {
        let quantity = one["quantity"].as_str().unwrap_or_default();
        let column = series.names.iter().position(|name| name == quantity);
        let last = column.and_then(|column| series.rows.last()?.get(column).copied());
        let computed = one["computed"].as_f64();
        if last.is_some() && computed.is_some() && last != computed {
            let what = format!("`{quantity}` is not what the last row of series.csv has");
            found.wrong(COMPARISON_FILE, what);
        }
    }
}
