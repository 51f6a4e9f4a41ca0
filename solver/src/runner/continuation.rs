//! What a run does with a run of the same case that is in its directory: it continues it.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::Value;

use super::failure::{Exit, Failure};
use super::simulate::Resumed;
use crate::case::{Case, CaseFile, TimeSettings, collect_keys};
use crate::observer::{Checkpoint, History, RunState, Status, checkpoints, latest_checkpoint};

/// Tables of a case that change nothing of what is computed.
const IRRELEVANT: [&str; 5] = ["title", "description", "output", "reference", "variant"];
/// Keys that do not either: how long a run continues, and where a mesh lies that is known by its checksum.
const IRRELEVANT_KEYS: [&str; 2] = ["time.unsteady.end", "domain.mesh.file"];
/// Restarts at one and the same step after which a run is not restarted again.
const MOST_RESTARTS: usize = 3;
/// Keys that a message lists at most.
const MOST_LISTED: usize = 12;
/// Characters of a value that a message shows.
const SHOWN: usize = 60;

/// How a run begins.
#[derive(Debug)]
pub enum Beginning<const D: usize> {
    /// At its first step.
    AtStart,
    /// From a checkpoint in its directory.
    From(Box<Resumed<D>>),
    /// Not at all: it has come to its end.
    IsDone,
}

/// How often a batch system has put this job back into its queue and started it again.
pub fn n_requeued() -> usize {
    let count = std::env::var("SLURM_RESTART_COUNT").ok();
    count.and_then(|count| count.parse().ok()).unwrap_or(0)
}

/// How a run of a case begins in a directory; `is_asked` where it is to continue a finished run, too.
///
/// # Errors
/// When the directory holds a run of another case, none of its checkpoints can be read, or it has
/// been restarted again and again without a step.
pub fn beginning<const D: usize>(
    out: &Path,
    file: &CaseFile,
    is_asked: bool,
) -> Result<Beginning<D>, Failure> {
    let Some(status) = status_of(out, file)? else { return Ok(Beginning::AtStart) };
    // Of a steady solution there is nothing to continue from
    let end = match &file.case().time {
        TimeSettings::Unsteady(settings) => Some(settings.end),
        TimeSettings::Steady(_) => None,
    };
    let is_over = match status.state {
        RunState::Running | RunState::Stopped => false,
        RunState::Failed if status.is_interrupted => false,
        RunState::Finished if is_asked => end.is_none_or(|end| status.time >= end),
        // What follows from them is for who calls: another directory, or another beginning
        RunState::Finished | RunState::Failed => return Ok(Beginning::AtStart),
    };
    if !is_over && (end.is_none() || checkpoints(out)?.is_empty()) {
        check_progress(out, n_requeued())?;
        return Ok(Beginning::AtStart);
    }
    check_same::<D>(out, file.case())?;
    if is_over {
        return Ok(Beginning::IsDone);
    }
    let damaged = |error: std::io::Error| {
        Failure::new(
            Exit::BadCase,
            format!(
                "{error}, and so is every other checkpoint there; --overwrite the run to start again, or \
                 --resume the state of another one"
            ),
        )
    };
    let Some(Checkpoint { path, state }) = latest_checkpoint::<D>(out).map_err(damaged)? else {
        return Ok(Beginning::AtStart);
    };
    state.check_case(file.case()).map_err(|error| {
        Failure::new(Exit::BadCase, format!("cannot continue from {}: {error}", path.display()))
    })?;
    if end.is_some_and(|end| state.time() >= end) {
        if Status::read(out).is_err() {
            Status::lost_end(file.case(), state.step(), state.time()).write(out)?;
        }
        return Ok(Beginning::IsDone);
    }
    let mut history = History::read(out, state.step(), state.time())?;
    history.complete(&state.series(), file.case().output.series);
    history.restarts = status.restarts.next(state.step());
    history.longest_checkpoint = status.longest_checkpoint;
    if history.restarts.count > MOST_RESTARTS {
        return Err(Failure::new(
            Exit::NoProgress,
            format!(
                "{MOST_RESTARTS} runs in a row began at step {} in {} and made no checkpoint after it; look \
                 at log.jsonl there, give more time than one checkpoint takes (output.checkpoint), or \
                 --overwrite it",
                state.step(),
                out.display()
            ),
        ));
    }
    Ok(Beginning::From(Box::new(Resumed {
        state,
        history: Some(history),
        is_in_place: true,
        from: path,
    })))
}

/// The status of the run in a directory, if there is one; where it is lost and checkpoints are there, that of a run
/// that was killed.
fn status_of(out: &Path, file: &CaseFile) -> Result<Option<Status>, Failure> {
    match Status::read(out) {
        Ok(status) => Ok(Some(status)),
        Err(_) if checkpoints(out)?.is_empty() => Ok(None),
        Err(_) => Ok(Some(Status::lost(file.case()))),
    }
}

/// Refuses to begin again at the start in a job that was put back into its queue too often.
fn check_progress(out: &Path, n_requeued: usize) -> Result<(), Failure> {
    if n_requeued <= MOST_RESTARTS {
        return Ok(());
    }
    let reason = format!(
        "the batch system has started this job {n_requeued} times again, and {} holds no checkpoint to continue \
         from; give it more time, or --overwrite it",
        out.display()
    );
    Err(Failure::new(Exit::NoProgress, reason))
}

/// Whether a directory holds a run of this very case.
fn check_same<const D: usize>(out: &Path, case: &Case) -> Result<(), Failure> {
    let path = out.join("case.toml");
    let earlier = std::fs::read_to_string(&path)
        .map_err(|error| error.to_string())
        .and_then(|text| toml::from_str::<Value>(&text).map_err(|error| error.to_string()))
        .map_err(|reason| Failure::new(Exit::BadCase, format!("{}: {reason}", path.display())))?;
    let text = case.to_toml().map_err(|error| Failure::new(Exit::Bug, error.to_string()))?;
    let now: Value =
        toml::from_str(&text).map_err(|error| Failure::new(Exit::Bug, error.to_string()))?;
    let [earlier, now] = [&earlier, &now].map(keys_of);
    let differ = earlier.keys().chain(now.keys()).filter(|key| earlier.get(*key) != now.get(*key));
    let differ: std::collections::BTreeSet<&String> = differ.collect();
    if differ.is_empty() {
        return Ok(());
    }
    let shown = |keys: &BTreeMap<String, String>, key: &str| {
        keys.get(key).map_or_else(|| "absent".to_owned(), |value| shortened(value))
    };
    let line = |key: &&String| {
        format!("\n  {key}: {} there, {} here", shown(&earlier, key), shown(&now, key))
    };
    let lines: String = differ.iter().take(MOST_LISTED).map(line).collect();
    let more = differ.len().saturating_sub(MOST_LISTED);
    let more = if more > 0 { format!("\n  and {more} more keys") } else { String::new() };
    // A change of the problem itself would be refused there
    let goes_on = latest_checkpoint::<D>(out)
        .is_ok_and(|found| found.is_some_and(|found| found.state.check_case(case).is_ok()));
    let out = out.display();
    let resume = if goes_on {
        format!(
            ", --overwrite it, or --resume {out} to continue from its state with these settings"
        )
    } else {
        ", or --overwrite it".to_owned()
    };
    Err(Failure::new(
        Exit::Usage,
        format!(
            "{out} holds a run of another case; what differs:{lines}{more}\ngive another directory \
             with --out{resume}"
        ),
    ))
}

fn shortened(value: &str) -> String {
    match value.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}...", &value[..end]),
        None => value.to_owned(),
    }
}

/// The values of all keys of a case that matter, by their paths.
fn keys_of(case: &Value) -> BTreeMap<String, String> {
    let mut keys = BTreeMap::new();
    if let Value::Object(tables) = case {
        for (name, value) in tables.iter().filter(|(name, _)| !IRRELEVANT.contains(&name.as_str()))
        {
            collect_keys(name.clone(), value, &mut keys);
        }
    }
    IRRELEVANT_KEYS.iter().for_each(|key| drop(keys.remove(*key)));
    keys
}
