//! `series.csv`: all quantities of a run, one row a step.
//!
//! Numbers have as many digits as it takes to read the same number back.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::case::Case;
use crate::observer::run_directory::{History, SERIES_FILE};
use crate::observer::schedule::Schedule;
use crate::observer::system::{AtPath, write_whole};
use crate::run::{LastState, Observer, RunError, SavedState, Snapshot};

/// Longest time a row waits in memory.
const INTERVAL: Duration = Duration::from_secs(1);

/// The open file, and the rows not yet in it.
#[derive(Debug)]
pub struct SeriesFile {
    file: File,
    path: PathBuf,
    schedule: Schedule,
    /// Bytes of whole rows in the file.
    length: u64,
    has_header: bool,
    /// Whole rows only, so that a killed run leaves no half row.
    pending: String,
    flushed: Instant,
}

impl SeriesFile {
    /// `series.csv` in `directory`: empty, or with the rows of a run that resumes.
    ///
    /// # Errors
    /// When it cannot be made.
    pub fn create(directory: &Path, case: &Case, history: Option<&History>) -> io::Result<Self> {
        let path = directory.join(SERIES_FILE);
        let mut text = String::new();
        if let Some(History { series, .. }) = history
            && !series.names.is_empty()
        {
            header(&mut text, &series.names);
            for (&time, values) in series.times.iter().zip(&series.rows) {
                row(&mut text, time, values);
            }
        }
        // What is there already is replaced as a whole, and never lost
        write_whole(&path, text.as_bytes())?;
        Ok(Self {
            file: File::options().append(true).open(&path).at(&path)?,
            path,
            schedule: Schedule::new(case.output.series, history.map(|history| history.time)),
            length: text.len() as u64,
            has_header: !text.is_empty(),
            pending: String::new(),
            flushed: Instant::now(),
        })
    }

    fn flush(&mut self) -> io::Result<()> {
        self.flushed = Instant::now();
        if let Err(error) = self.file.write_all(self.pending.as_bytes()) {
            // On a full disk the last row may be half there
            self.file.set_len(self.length).at(&self.path)?;
            return Err(error).at(&self.path);
        }
        self.length += self.pending.len() as u64;
        self.pending.clear();
        Ok(())
    }
}

fn header(text: &mut String, names: &[String]) {
    text.push_str("time");
    for name in names {
        text.push(',');
        text.push_str(name);
    }
    text.push('\n');
}

fn row(text: &mut String, time: f64, values: &[f64]) {
    // `{:?}` is the shortest text that reads back as the same number; writing to a string cannot
    // fail.
    let _ = write!(text, "{time:?}");
    for value in values {
        let _ = write!(text, ",{value:?}");
    }
    text.push('\n');
}

impl<const D: usize> Observer<D> for SeriesFile {
    fn on_step(&mut self, snapshot: &Snapshot<'_, D>) -> io::Result<()> {
        if self.schedule.is_due(snapshot.step, snapshot.time, snapshot.is_last) {
            if !self.has_header {
                header(&mut self.pending, snapshot.names);
                self.has_header = true;
            }
            row(&mut self.pending, snapshot.time, snapshot.values);
        }
        if snapshot.is_last || self.flushed.elapsed() >= INTERVAL {
            self.flush()?;
        }
        if snapshot.is_last { self.file.sync_all().at(&self.path) } else { Ok(()) }
    }

    /// The rows up to a state are on the disk before it is.
    fn on_state(&mut self, _state: &Arc<SavedState<D>>) -> io::Result<()> {
        self.flush()?;
        self.file.sync_data().at(&self.path)
    }

    fn on_failure(
        &mut self,
        _error: &RunError,
        _last: Option<&LastState<'_, D>>,
    ) -> io::Result<()> {
        self.flush()?;
        self.file.sync_all().at(&self.path)
    }
}
