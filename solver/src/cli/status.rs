//! `status`: how far runs, sweeps and searches are, from the files in their directories.

use std::path::{Path, PathBuf};

use clap::{Args, ValueHint};
use serde_json::json;

use super::exit::{Exit, Failure};
use super::searched::SearchDirectory;
use super::style::say;
use crate::case::significant;
use crate::observer::{Leg, Provenance, RunDirectory, RunLock, RunState, Status, checkpoints};
use crate::sweep::{PLAN_FILE, PointState, SweepDirectory, stand};

/// What `status` is asked for.
#[derive(Debug, Args)]
pub struct Options {
    /// Directories of runs, sweeps or searches
    #[arg(required = true, value_name = "DIR", value_hint = ValueHint::DirPath)]
    directories: Vec<PathBuf>,
    /// As JSON
    #[arg(long)]
    json: bool,
}

/// What is known of a run.
struct Progress {
    status: Status,
    /// Part of the way to the end.
    part: Option<f64>,
    /// Wall-clock seconds that are left, if it continues as before.
    left: Option<f64>,
    /// Whether no process writes to it any more, though it has not ended.
    is_killed: bool,
    /// The latest checkpoint.
    checkpoint: Option<PathBuf>,
    /// What ran it, one after another; none if that cannot be read.
    legs: Vec<Leg>,
}

/// Reports how far runs, sweeps and searches are.
pub fn status(options: &Options) -> Result<Exit, Failure> {
    let mut all = Vec::new();
    for directory in &options.directories {
        if let Some(Other { line, value }) = other(directory)? {
            if options.json {
                all.push(value);
            } else {
                say(&line);
            }
            continue;
        }
        let progress = progress(directory)?;
        if options.json {
            all.push(progress.to_json(directory)?);
        } else {
            progress.print(directory);
        }
    }
    if options.json {
        say(&format!("{:#}", serde_json::Value::from(all)));
    }
    Ok(Exit::Done)
}

/// How far something is that is no run.
struct Other {
    line: String,
    value: serde_json::Value,
}

/// How far a sweep or a search is; none of a run.
fn other(directory: &Path) -> Result<Option<Other>, Failure> {
    if directory.join(PLAN_FILE).exists() {
        return of_sweep(directory).map(Some);
    }
    if RunDirectory::is_one(directory) || directory.join("status.json").exists() {
        return Ok(None);
    }
    // What cannot be read is told of as a run
    let search = SearchDirectory::read(directory).ok().flatten();
    Ok(search.map(|search| of_search(&search)))
}

fn of_sweep(directory: &Path) -> Result<Other, Failure> {
    let sweep = SweepDirectory::open(directory)?;
    let n = sweep.n_points();
    let states: Vec<PointState> = (0..n).map(|index| stand(&sweep, index).state).collect();
    let count = |state: &PointState| states.iter().filter(|own| *own == state).count();
    let counts = PointState::ALL.iter().map(|state| (state.name(), count(state)));
    let counts: Vec<(&str, usize)> = counts.filter(|(_, n)| *n > 0).collect();
    let told: Vec<String> = counts.iter().map(|(state, n)| format!("{n} {state}")).collect();
    let points: serde_json::Map<String, serde_json::Value> =
        counts.iter().map(|(state, n)| ((*state).to_owned(), (*n).into())).collect();
    Ok(Other {
        line: format!(
            "{}: sweep of {n} points: {}; `alewife sweep status` has each",
            directory.display(),
            told.join(", ")
        ),
        value: json!({ "directory": directory, "kind": "sweep", "points": points }),
    })
}

fn of_search(search: &SearchDirectory) -> Other {
    let (directory, kind, state) = (&search.path, search.kind.name(), search.state());
    let (n, best) = (search.n_evaluations(), search.best());
    let journals: Vec<&str> = search.journals.iter().map(|one| one.file.as_str()).collect();
    let round = journals.last().filter(|file| file.starts_with("round-"));
    let round = round.map(|file| format!(", the last in {}", file.trim_end_matches(".journal")));
    let told = best.map_or_else(String::new, |best| format!(", the best there {best:.6e}"));
    let more = if state == "stopped" { "\n  call it again to go on" } else { "" };
    Other {
        line: format!(
            "{}: {state}, {kind}, {n} evaluations{}{told}{more}",
            directory.display(),
            round.unwrap_or_default()
        ),
        value: json!({
            "directory": directory,
            "kind": kind,
            "state": state,
            "evaluations": n,
            "journals": journals,
            "best": best.filter(|best| best.is_finite()),
        }),
    }
}

fn progress(directory: &Path) -> Result<Progress, Failure> {
    let path = directory.join("status.json");
    // Asked for first: a run that ends meanwhile says so in its status before it gives its lock free
    let is_held = RunLock::is_held(directory, &["status.json"]);
    let status = Status::read(directory).map_err(|error| {
        let reason = format!(
            "{}: {error}; give the directory of a run, a sweep or a search",
            path.display()
        );
        Failure::new(Exit::NoInput, reason)
    })?;
    let part = status.end.filter(|end| *end > 0.0).map(|end| (status.time / end).clamp(0.0, 1.0));
    let is_running = status.state == RunState::Running;
    Ok(Progress {
        part,
        left: status.seconds_left().filter(|_| is_running),
        is_killed: is_running && !is_held,
        checkpoint: checkpoints(directory)?.into_iter().next(),
        legs: Provenance::read(directory).map(|provenance| provenance.legs).unwrap_or_default(),
        status,
    })
}

impl Progress {
    fn state(&self) -> &'static str {
        self.status.state.in_a_word(!self.is_killed)
    }

    fn to_json(&self, directory: &Path) -> Result<serde_json::Value, Failure> {
        let status = serde_json::to_value(&self.status).map_err(std::io::Error::from)?;
        Ok(json!({
            "directory": directory,
            "state": self.state(),
            "part": self.part,
            "seconds_left": self.left,
            "checkpoint": self.checkpoint,
            "status": status,
            "legs": self.legs,
        }))
    }

    fn print(&self, directory: &Path) {
        let Status { step, steps, time, end, reason, .. } = &self.status;
        let of = |end: Option<String>| end.map_or(String::new(), |end| format!(" of {end}"));
        let part = self.part.map_or(String::new(), |part| format!(", {:.0} %", 100.0 * part));
        let place = match end {
            None => "a steady solution".to_owned(),
            Some(end) => format!(
                "step {step}{}, t {} of {}{part}",
                of(steps.map(|steps| steps.to_string())),
                significant(*time),
                significant(*end),
            ),
        };
        let model = self.status.fidelity.as_ref();
        let model = model.map_or_else(String::new, |name| format!(", {name} model"));
        say(&format!("{}: {}, {place}{model}", directory.display(), self.state()));
        if self.is_killed {
            say(match &self.checkpoint {
                Some(_) => "  its process was killed: run it again to continue",
                None => "  its process was killed: run it again, from its start",
            });
        }
        if let Some(left) = self.left.filter(|_| !self.is_killed) {
            say(&format!("  about {} left", clock(left)));
        }
        if let Some(reason) = reason {
            say(&format!("  {reason}"));
        }
        for warning in &self.status.warnings {
            say(&format!("  warning: {}", warning.line()));
        }
        match &self.checkpoint {
            Some(path) => say(&format!("  latest checkpoint: {}", path.display())),
            // One without a flow is made in one go
            None if self.status.fidelity.is_some() => {}
            None => say("  no checkpoint"),
        }
        for (index, leg) in self.legs.iter().enumerate() {
            say(&format!("  leg {}: {}", index + 1, in_a_line(leg)));
        }
    }
}

/// What a process did of a run, in a line.
fn in_a_line(leg: &Leg) -> String {
    let Leg { from, to, ended_at, end, origin } = leg;
    let until = |text: Option<String>| text.map_or(String::new(), |text| format!(" to {text}"));
    let threads = if origin.threads == 1 { "thread" } else { "threads" };
    format!(
        "steps {}{}, {}{}, alewife {} on {} {threads}{}",
        from.step,
        until(to.map(|to| to.step.to_string())),
        origin.started_at,
        until(ended_at.clone()),
        origin.alewife,
        origin.threads,
        end.as_ref().map_or(String::new(), |end| format!(": {end}"))
    )
}

/// A time in hours, minutes and seconds.
fn clock(seconds: f64) -> String {
    let (minutes, rest) = ((seconds / 60.0).floor(), seconds % 60.0);
    let hours = (minutes / 60.0).floor();
    match (hours > 0.0, minutes > 0.0) {
        (true, _) => format!("{hours:.0} h {:.0} min", minutes % 60.0),
        (_, true) => format!("{minutes:.0} min {rest:.0} s"),
        _ => format!("{rest:.0} s"),
    }
}

#[cfg(test)]
mod tests {
    use super::clock;

    #[test]
    fn times_are_told_in_two_units() {
        assert_eq!([5.2, 65.0, 7380.0].map(clock), ["5 s", "1 min 5 s", "2 h 3 min"]);
    }
}
