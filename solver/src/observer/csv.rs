//! `series.csv`: all quantities of a run, one row a step.
//!
//! Numbers have as many digits as it takes to read the same number back.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{self, Write};
use std::path::Path;
use std::time::{Duration, Instant};

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
    has_header: bool,
    /// Whole rows only, so that a killed run leaves no half row.
    pending: String,
    flushed: Instant,
}

impl SeriesFile {
    /// An empty `series.csv` in `directory`.
    ///
    /// # Errors
    /// When it cannot be made.
    pub fn create(directory: &Path, case: &Case) -> io::Result<Self> {
        Ok(Self {
            file: File::create(directory.join("series.csv"))?,
            schedule: Schedule::new(case.output.series),
            has_header: false,
            pending: String::new(),
            flushed: Instant::now(),
        })
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.write_all(self.pending.as_bytes())?;
        self.pending.clear();
        self.flushed = Instant::now();
        Ok(())
    }
}

impl<const D: usize> Observer<D> for SeriesFile {
    fn on_step(&mut self, snapshot: &Snapshot<'_, D>) -> io::Result<()> {
        if self.schedule.is_due(snapshot.step, snapshot.time, snapshot.is_last) {
            if !self.has_header {
                self.pending.push_str("time");
                for name in snapshot.names {
                    self.pending.push(',');
                    self.pending.push_str(name);
                }
                self.pending.push('\n');
                self.has_header = true;
            }
            // `{:?}` is the shortest text that reads back as the same number.
            write!(self.pending, "{:?}", snapshot.time).map_err(io::Error::other)?;
            for value in snapshot.values {
                write!(self.pending, ",{value:?}").map_err(io::Error::other)?;
            }
            self.pending.push('\n');
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
