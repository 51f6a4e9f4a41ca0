//! `series.csv`: all quantities of a run, one row a step.
//!
//! Numbers have as many digits as it takes to read the same number back.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{self, Write};
use std::path::Path;
use std::time::{Duration, Instant};

use super::atomic::write_atomic;
use super::history::History;
use super::schedule::Schedule;
use crate::case::Case;
use crate::simulation::{LastState, Observer, RunError, Snapshot};

/// Longest time a row waits in memory.
const INTERVAL: Duration = Duration::from_secs(1);

/// The open file, and the rows not yet in it.
#[derive(Debug)]
pub struct SeriesFile {
    file: File,
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
        let path = directory.join("series.csv");
        let cadence = case.output.series;
        let mut made = Self {
            file: File::options().append(true).create(true).open(&path)?,
            schedule: Schedule::new(cadence),
            length: 0,
            has_header: false,
            pending: String::new(),
            flushed: Instant::now(),
        };
        if let Some(history) = history.filter(|history| !history.series.names.is_empty()) {
            made.schedule = Schedule::resumed(cadence, history.time);
            made.header(&history.series.names);
            for (&time, row) in history.series.times.iter().zip(&history.series.rows) {
                made.row(time, row);
            }
        }
        // What is there already is replaced as a whole, and never lost
        write_atomic(&path, made.pending.as_bytes())?;
        made.file = File::options().append(true).open(&path)?;
        made.length = made.pending.len() as u64;
        made.pending.clear();
        Ok(made)
    }

    fn header(&mut self, names: &[String]) {
        self.pending.push_str("time");
        for name in names {
            self.pending.push(',');
            self.pending.push_str(name);
        }
        self.pending.push('\n');
        self.has_header = true;
    }

    fn row(&mut self, time: f64, values: &[f64]) {
        // `{:?}` is the shortest text that reads back as the same number; writing to a string cannot
        // fail.
        let _ = write!(self.pending, "{time:?}");
        for value in values {
            let _ = write!(self.pending, ",{value:?}");
        }
        self.pending.push('\n');
    }

    fn flush(&mut self) -> io::Result<()> {
        let written = self.file.write_all(self.pending.as_bytes());
        if written.is_ok() {
            self.length += self.pending.len() as u64;
        } else {
            // On a full disk the last row may be half there
            self.file.set_len(self.length)?;
        }
        self.pending.clear();
        self.flushed = Instant::now();
        written
    }
}

impl<const D: usize> Observer<D> for SeriesFile {
    fn on_step(&mut self, snapshot: &Snapshot<'_, D>) -> io::Result<()> {
        if self.schedule.is_due(snapshot.step, snapshot.time, snapshot.is_last) {
            if !self.has_header {
                self.header(snapshot.names);
            }
            self.row(snapshot.time, snapshot.values);
        }
        if snapshot.is_last || self.flushed.elapsed() >= INTERVAL {
            self.flush()?;
        }
        if snapshot.is_last { self.file.sync_all() } else { Ok(()) }
    }

    fn on_failure(
        &mut self,
        _error: &RunError,
        _last: Option<&LastState<'_, D>>,
    ) -> io::Result<()> {
        self.flush()?;
        self.file.sync_all()
    }
}
