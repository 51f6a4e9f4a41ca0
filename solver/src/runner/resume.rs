//! What a run resumes from where a state is named: that state, and what its run wrote up to there.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::failure::{Exit, Failure};
use super::simulate::Resumed;
use crate::case::{Case, TimeSettings};
use crate::observer::{FAILURE_STATE, History, checkpoints, read_state, run_of_state};
use crate::run::SavedState;

/// Reads a state, and what the run it lies in has written up to there.
pub fn read_resumed<const D: usize>(
    path: &Path,
    case: &Case,
    out: &Path,
) -> Result<Resumed<D>, Failure> {
    let path = &state_in(path);
    let state = read_unfinished(path, case)?;
    let run = run_of_state(path);
    let is_in_place = run.is_some_and(|run| is_inside(run, out) && is_inside(out, run));
    let mut history = run.map(|run| History::read(run, state.step(), state.time())).transpose()?;
    if let Some(history) = history.as_mut().filter(|_| !is_in_place) {
        // The field files stay where they are
        history.frames.clear();
        history.tracer_frames.clear();
    }
    Ok(Resumed { state, history, is_in_place, from: path.clone() })
}

/// The state a path names: the latest checkpoint, where it is the directory of a run, or its last state.
fn state_in(path: &Path) -> PathBuf {
    if !path.is_dir() {
        return path.to_owned();
    }
    let last = path.join(FAILURE_STATE);
    let latest = checkpoints(path).ok().and_then(|found| found.into_iter().next());
    latest.or_else(|| last.is_file().then_some(last)).unwrap_or_else(|| path.to_owned())
}

/// Reads the state a run left before the end of a case.
fn read_unfinished<const D: usize>(path: &Path, case: &Case) -> Result<SavedState<D>, Failure> {
    let refuse = |exit, reason: String| {
        let leaves = "runs in time leave checkpoints/*.state, one that failed failure/last.state";
        Failure::new(exit, format!("--resume: {reason}; {leaves}"))
    };
    let TimeSettings::Unsteady(settings) = &case.time else {
        return Err(refuse(Exit::Usage, "a steady solution cannot be resumed".to_owned()));
    };
    let saved = read_state(path).map_err(|error| match error.kind() {
        ErrorKind::InvalidData => refuse(Exit::BadCase, error.to_string()),
        _ => refuse(Exit::NoInput, error.to_string()),
    })?;
    // Before anything of a run directory is touched
    saved.check_case(case).map_err(|error| {
        let path = path.display();
        Failure::new(Exit::BadCase, format!("cannot resume from {path}: {error}"))
    })?;
    if saved.time() >= settings.end {
        let (path, time, end) = (path.display(), saved.time(), settings.end);
        let reason = format!(
            "cannot resume from {path}: it is at time {time}, and the case ends at {end}; raise \
             time.unsteady.end"
        );
        return Err(Failure::new(Exit::BadCase, reason));
    }
    Ok(saved)
}

/// Whether a file lies in a directory.
pub fn is_inside(file: &Path, directory: &Path) -> bool {
    match (file.canonicalize(), directory.canonicalize()) {
        (Ok(file), Ok(directory)) => file.starts_with(directory),
        _ => false,
    }
}
