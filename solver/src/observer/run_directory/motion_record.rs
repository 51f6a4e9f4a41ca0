//! `MotionRecord`: marker, provenance and status of a run without a flow, which is made in one go.

use std::io;
use std::path::{Path, PathBuf};
use std::time::Instant;

use alewife_interrupt::check;

use super::marker::mark;
use super::provenance::{Origin, Point, Provenance};
use super::status::{Motion, RunState, Status};
use crate::observer::system::process;
use crate::timing::cpu_seconds;

/// Writes where a run without a flow stands: `status.json` and `provenance.json`.
#[derive(Debug)]
pub struct MotionRecord {
    directory: PathBuf,
    provenance: Provenance,
    status: Status,
    started: Instant,
    cpu_before: f64,
}

impl MotionRecord {
    /// Marks a directory as that of a run under way, of the case in its `case.toml`.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn begin(directory: &Path, motion: &Motion) -> io::Result<Self> {
        let text = std::fs::read_to_string(directory.join("case.toml"))?;
        mark(directory)?;
        let provenance = Provenance::beginning(Origin::of_this_process(&text, 1), Point::default());
        provenance.write(directory)?;
        let mut record = Self {
            directory: directory.to_owned(),
            provenance,
            status: Status::of_motion(motion),
            started: Instant::now(),
            cpu_before: cpu_seconds(),
        };
        record.write()?;
        Ok(record)
    }

    /// It came to its end.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn finish(mut self, motion: &Motion) -> io::Result<()> {
        self.status.state = RunState::Finished;
        self.status.step = motion.steps;
        self.status.time = motion.end;
        self.provenance.end_leg(Point { step: motion.steps, time: motion.end }, "finished");
        self.provenance.write(&self.directory)?;
        self.write()
    }

    /// It failed, or was asked to end.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn fail(mut self, reason: &str) -> io::Result<()> {
        let (state, reason) = match check() {
            Ok(()) => (RunState::Failed, reason),
            Err(_) => (RunState::Stopped, "stopped by a signal"),
        };
        self.status.state = state;
        self.status.reason = Some(reason.to_owned());
        self.provenance.end_leg(Point::default(), reason);
        self.provenance.write(&self.directory)?;
        self.write()
    }

    fn write(&mut self) -> io::Result<()> {
        let total = "total".to_owned();
        self.status.wall_seconds.insert(total.clone(), self.started.elapsed().as_secs_f64());
        self.status.cpu_seconds.insert(total, cpu_seconds() - self.cpu_before);
        self.status.peak_memory = process::peak_memory();
        self.status.updated_at = process::now();
        self.status.write(&self.directory)
    }
}
