//! `LegFile`: writes into `provenance.json` how far a process came, and why it ended.

use std::io;
use std::path::{Path, PathBuf};

use super::provenance::{Point, Provenance};
use super::read_back::History;
use super::run_directory::RunDirectory;
use crate::run::{LastState, Observer, RunError, Snapshot};
use crate::timing::Timing;

/// How a leg ends that comes to the end of the run.
const FINISHED: &str = "finished";

/// The present leg.
#[derive(Debug)]
pub struct LegFile {
    directory: PathBuf,
    provenance: Provenance,
    reached: Point,
}

impl LegFile {
    /// For the run in a directory.
    #[must_use]
    pub fn new(directory: &RunDirectory, history: Option<&History>) -> Self {
        let reached = history
            .map_or(Point::default(), |history| Point { step: history.step, time: history.time });
        let path: &Path = directory.path();
        Self { directory: path.to_owned(), provenance: directory.provenance().clone(), reached }
    }

    fn end(&mut self, reason: &str) -> io::Result<()> {
        self.provenance.end_leg(self.reached, reason);
        self.provenance.write(&self.directory)
    }
}

impl<const D: usize> Observer<D> for LegFile {
    fn on_step(&mut self, snapshot: &Snapshot<'_, D>) -> io::Result<()> {
        self.reached = Point { step: snapshot.step, time: snapshot.time };
        Ok(())
    }

    fn on_end(&mut self, _timing: &Timing) -> io::Result<()> {
        self.end(FINISHED)
    }

    fn on_failure(&mut self, error: &RunError, _last: Option<&LastState<'_, D>>) -> io::Result<()> {
        self.end(&error.to_string())
    }
}
