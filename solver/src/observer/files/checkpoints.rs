//! `checkpoints/*.state`: states of a run under way, written beside it, of which the latest are kept.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use super::state_file::{read_state, write_state};
use crate::case::{Case, Checkpoints, TimeSettings};
use crate::observer::run_directory::checkpoint_list::{
    ENDING, FOLDER, REQUEST, checkpoints, checkpoints_after,
};
use crate::observer::run_directory::{History, WriteTimes, remove_failure};
use crate::observer::system::{AtPath, remove_if_there};
use crate::run::{LastState, Observer, RunError, SavedState, Snapshot};
use crate::step::FlowError;

/// How often it is looked for.
const LOOK_EVERY: Duration = Duration::from_secs(1);

/// Writes states in a thread of its own, so that the run does not wait for the disk.
#[derive(Debug)]
pub struct CheckpointFiles {
    directory: PathBuf,
    settings: Checkpoints,
    /// Whether there are states at all: not of a steady solution.
    is_active: bool,
    written: Instant,
    looked: Instant,
    /// Multiples of the time between checkpoints that are past.
    periods: f64,
    writing: Option<JoinHandle<io::Result<()>>>,
    times: WriteTimes,
}

impl CheckpointFiles {
    /// For the run in a directory, after a `history` if there is one. Checkpoints of later steps than its last are
    /// removed: they belong to what is computed again, and newer ones would give way to them.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn create(
        directory: &Path,
        case: &Case,
        history: Option<&History>,
        times: WriteTimes,
    ) -> io::Result<Self> {
        if let Some(history) = history {
            for later in checkpoints_after(directory, history.step)? {
                remove_if_there(&later)?;
            }
        }
        let settings = case.output.checkpoint;
        let is_active = matches!(case.time, TimeSettings::Unsteady(_)) && settings.keep > 0;
        let now = Instant::now();
        Ok(Self {
            directory: directory.to_owned(),
            settings,
            is_active,
            written: now,
            looked: now,
            periods: periods(&settings, history.map_or(0.0, |history| history.time)),
            writing: None,
            times,
        })
    }

    fn is_requested(&mut self) -> io::Result<bool> {
        if self.looked.elapsed() < LOOK_EVERY {
            return Ok(false);
        }
        self.looked = Instant::now();
        let request = self.directory.join(REQUEST);
        let is_there = request.is_file();
        if is_there {
            remove_if_there(&request)?;
        }
        Ok(is_there)
    }

    /// Waits for the state that is being written.
    fn finish(&mut self) -> io::Result<()> {
        match self.writing.take().map(JoinHandle::join) {
            None | Some(Ok(Ok(()))) => Ok(()),
            Some(Ok(Err(error))) => Err(error),
            Some(Err(_)) => Err(io::Error::other("the thread that writes checkpoints ended")),
        }
    }
}

/// Whole intervals between checkpoints up to a time (s).
fn periods(settings: &Checkpoints, time: f64) -> f64 {
    // A time that is a multiple but for rounding is one
    settings.time.map_or(0.0, |interval| (time / interval * (1.0 + 1e-12)).floor())
}

/// Writes a state among the checkpoints of a run, and removes all but the latest.
fn write<const D: usize>(
    directory: &Path,
    state: &SavedState<D>,
    keep: usize,
    times: &WriteTimes,
) -> io::Result<()> {
    let started = Instant::now();
    let folder = directory.join(FOLDER);
    fs::create_dir_all(&folder).at(&folder)?;
    let path = folder.join(format!("{:06}{ENDING}", state.step()));
    let bytes = write_state(&path, state)?;
    for old in checkpoints(directory)?.into_iter().skip(keep) {
        remove_if_there(&old)?;
    }
    times.record(started.elapsed());
    let (step, time, seconds) = (state.step(), state.time(), started.elapsed().as_secs_f64());
    tracing::info!(step, time, bytes, seconds, "checkpoint");
    Ok(())
}

/// A state, and where it lies.
#[derive(Debug)]
pub struct Checkpoint<const D: usize> {
    /// The file.
    pub path: PathBuf,
    /// What it holds.
    pub state: SavedState<D>,
}

/// The latest checkpoint that can be read of the run in a directory; none if there is none.
///
/// # Errors
/// When there are some, and none can be read: the error of the latest.
pub fn latest_checkpoint<const D: usize>(directory: &Path) -> io::Result<Option<Checkpoint<D>>> {
    let mut first_error = None;
    for path in checkpoints(directory)? {
        match read_state(&path) {
            Ok(state) => return Ok(Some(Checkpoint { path, state })),
            Err(error) => {
                tracing::warn!("{error}; the checkpoint before it is taken");
                first_error.get_or_insert(error);
            }
        }
    }
    first_error.map_or(Ok(None), Err)
}

impl<const D: usize> Observer<D> for CheckpointFiles {
    fn on_step(&mut self, _snapshot: &Snapshot<'_, D>) -> io::Result<()> {
        match &self.writing {
            Some(writing) if writing.is_finished() => self.finish(),
            _ => Ok(()),
        }
    }

    fn wants_state(&mut self, snapshot: &Snapshot<'_, D>) -> bool {
        if !self.is_active {
            return false;
        }
        let periods = periods(&self.settings, snapshot.time);
        let is_due = self.written.elapsed() >= self.settings.wall.duration()
            || periods > self.periods
            || self.is_requested().unwrap_or(false);
        // A state that is still being written is newer than any that is due
        let is_idle = self.writing.as_ref().is_none_or(JoinHandle::is_finished);
        snapshot.is_last || (is_due && is_idle)
    }

    fn on_state(&mut self, state: &Arc<SavedState<D>>) -> io::Result<()> {
        self.finish()?;
        self.written = Instant::now();
        self.periods = periods(&self.settings, state.time());
        let (directory, keep, state, times) =
            (self.directory.clone(), self.settings.keep, Arc::clone(state), self.times.clone());
        let work = move || write(&directory, &state, keep, &times);
        self.writing = Some(std::thread::Builder::new().name("checkpoint".to_owned()).spawn(work)?);
        Ok(())
    }

    fn on_end(&mut self, _timing: &crate::timing::Timing) -> io::Result<()> {
        self.finish()?;
        remove_failure(&self.directory)
    }

    fn on_failure(&mut self, error: &RunError, last: Option<&LastState<'_, D>>) -> io::Result<()> {
        let finished = self.finish();
        let saved = last.and_then(|last| last.saved);
        if let Some(state) =
            saved.filter(|_| matches!(error, RunError::Flow(FlowError::Stopped { .. })))
        {
            // Asked for: also where no other checkpoints are
            write(&self.directory, state, self.settings.keep.max(1), &self.times)?;
            remove_failure(&self.directory)?;
        }
        finished
    }
}
