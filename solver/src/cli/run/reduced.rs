//! `run --fidelity reduced`: a case by laws of loads, its series and how it ended.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

use super::print_comparisons;
use crate::case::{Case, CaseFile, Severity, TimeSettings, check, check_reduced, significant};
use crate::cli::exit::{Exit, Failure};
use crate::cli::read::{print_warnings, refuse_soft};
use crate::cli::soft::{hold, not_written};
use crate::cli::style::say;
use crate::observer::{Motion, MotionRecord, RunLock, Status, remove_if_there, write_atomic};
use crate::reduced::{ReducedError, simulate};
use crate::run::Series;
use crate::runner::recording;
use crate::validation::compare_series;

/// The model, by its name on the command line.
const MODEL: &str = "reduced";

/// The file that is written last.
const SERIES: &str = "series.csv";

/// What a run by the reduced model is asked for.
pub struct Request<'a> {
    pub case: &'a str,
    pub settings: &'a [String],
    pub out: Option<&'a Path>,
    pub overwrite: bool,
    /// What is asked for in it, as a session has written it down.
    pub replay: Option<&'a Path>,
    /// Options that only the full solver has, and that were given.
    pub foreign: Vec<&'static str>,
}

/// Runs a case by its reduced model.
pub fn run(request: &Request<'_>) -> Result<Exit, Failure> {
    if let Some(option) = request.foreign.first() {
        let message = format!("--{option} is for the full solver; leave it out, or --fidelity ale");
        return Err(Failure::new(Exit::Usage, message));
    }
    refuse_soft(request.case, request.settings)?;
    let file = Case::read(request.case, request.settings)?;
    let found = check(&file);
    if found.iter().any(|one| one.severity == Severity::Error) {
        return Err(Failure::wrong(&found));
    }
    let unknown = check_reduced(&file);
    if unknown.iter().any(|one| one.severity == Severity::Error) {
        return Err(Failure::wrong(&unknown));
    }
    print_warnings(&found);
    if let Some(recording) = recording(&file, request.replay)? {
        for asked in &recording.asked {
            file.model
                .commands
                .ask(asked)
                .map_err(|error| Failure::new(Exit::BadCase, format!("--replay: {error}")))?;
        }
    }
    let out = directory(request, &file)?;
    let _held = begin(&out, &file)?;
    let begun = Instant::now();
    let series = moved(&out, &file)?;
    let seconds = begun.elapsed().as_secs_f64();
    report(&file, &series);
    // References of a case with a mesh are those of its flow
    let is_compared = file.case().is_reduced_only() && !file.case().reference.is_empty();
    let mut exit = Exit::Done;
    if is_compared {
        let rows = compare_series(&file.full_name(), file.case(), &series, 0, 0.0);
        print_comparisons(&rows);
        if rows.iter().any(|row| row.verdict.is_failure()) {
            exit = Exit::OutsideTolerance;
        }
    }
    let compared = if is_compared { "" } else { ", not compared with references" };
    say(&format!(
        "reduced model: no wakes, no walls{compared}; {} steps, {seconds:.3} s on the clock; \
         written to {}",
        series.times.len().saturating_sub(1),
        out.display()
    ));
    Ok(exit)
}

/// Moves the model, and writes what comes out.
fn moved(out: &Path, file: &CaseFile) -> Result<Series, Failure> {
    let failed = |error: std::io::Error| not_written(out, &error);
    let end = match &file.case().time {
        TimeSettings::Unsteady(settings) => settings.end,
        TimeSettings::Steady(_) => 0.0,
    };
    let run = Motion { fidelity: MODEL, steps: 0, end, dofs: 0 };
    let record = MotionRecord::begin(out, &run).map_err(failed)?;
    let series = match simulate(&file.model) {
        Ok(series) => series,
        Err(error) => {
            let exit = match error {
                ReducedError::Unknown(_) => Exit::BadCase,
                ReducedError::Tree(_) => Exit::Diverged,
            };
            record.fail(&error.to_string()).map_err(failed)?;
            return Err(Failure::new(exit, error.to_string()));
        }
    };
    write(out, &series).map_err(failed)?;
    let steps = series.times.len().saturating_sub(1);
    let end = series.times.last().copied().unwrap_or(end);
    record.finish(&Motion { steps, end, ..run }).map_err(failed)?;
    Ok(series)
}

/// Where the run goes: not over one of the full solver, nor over another unless that is asked for.
fn directory(request: &Request<'_>, file: &CaseFile) -> Result<PathBuf, Failure> {
    let default = || Path::new("runs").join(file.directory_name() + "-reduced");
    let out = request.out.map_or_else(default, Path::to_path_buf);
    let refuse = |what: &str| Err(Failure::new(Exit::Usage, format!("{} {what}", out.display())));
    let is_ours = Status::read(&out).is_ok_and(|status| status.fidelity.as_deref() == Some(MODEL));
    if (out.join("status.json").exists() && !is_ours) || out.join("checkpoints").exists() {
        return refuse("holds a run of another model; choose another directory with --out");
    }
    if out.join(SERIES).exists() && !request.overwrite {
        return refuse("holds a run; --overwrite it, or choose another directory with --out");
    }
    Ok(out)
}

/// Holds the directory, with the case in it and without the series of an earlier run.
fn begin(out: &Path, file: &CaseFile) -> Result<RunLock, Failure> {
    let held = hold(out)?;
    let ready = || {
        let text = file.case().to_toml().map_err(std::io::Error::other)?;
        remove_if_there(&out.join(SERIES))?;
        write_atomic(&out.join("case.toml"), text.as_bytes())
    };
    ready().map_err(|error| not_written(out, &error))?;
    Ok(held)
}

fn write(out: &Path, series: &Series) -> std::io::Result<()> {
    let mut text = String::from("time");
    for name in &series.names {
        text.push(',');
        text.push_str(name);
    }
    text.push('\n');
    for (time, row) in series.times.iter().zip(&series.rows) {
        // The shortest text that reads back as the same number; writing to a text cannot fail
        let _ = write!(text, "{time:?}");
        for value in row {
            let _ = write!(text, ",{value:?}");
        }
        text.push('\n');
    }
    write_atomic(&out.join(SERIES), text.as_bytes())
}

/// What the swimmers did in the end, or the bodies where there is none.
fn report(file: &CaseFile, series: &Series) {
    let Some(last) = series.rows.last() else { return };
    let model = &file.model;
    let swimmers: Vec<&str> = model.swimmers.iter().map(|one| one.name.as_str()).collect();
    let bodies = model.bodies.iter().map(|body| body.name.as_str());
    let shown: Vec<&str> = if swimmers.is_empty() { bodies.collect() } else { swimmers };
    for (name, value) in series.names.iter().zip(last) {
        let is_shown = shown.iter().any(|owner| name.starts_with(&format!("{owner}.")));
        if is_shown && !value.is_nan() {
            say(&format!("{name:32}  {}", significant(*value)));
        }
    }
}
