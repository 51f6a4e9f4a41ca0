//! `StopFile`: a file in the directory of a run that stops it, where no signal can be sent.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use crate::observer::{STOP, remove_if_there};
use crate::run::{LastState, Observer, RunError, Snapshot};
use crate::step::StopRequest;

/// How often it is looked for (ms).
const LOOK_EVERY: u64 = 1000;

/// Asks for the end of a run once the file is there.
#[derive(Debug)]
pub struct StopFile {
    path: PathBuf,
}

impl StopFile {
    /// In the directory of a run.
    #[must_use]
    pub fn new(directory: &Path) -> Self {
        Self { path: directory.join(STOP) }
    }
}

impl<const D: usize> Observer<D> for StopFile {
    fn on_step(&mut self, _snapshot: &Snapshot<'_, D>) -> std::io::Result<()> {
        Ok(())
    }

    fn stop_request(&self) -> Option<StopRequest> {
        let (path, started, looked) = (self.path.clone(), Instant::now(), AtomicU64::new(0));
        Some(Arc::new(move || {
            let now = u64::try_from(started.elapsed().as_millis()).unwrap_or(u64::MAX);
            if now < looked.load(Ordering::Relaxed).saturating_add(LOOK_EVERY) {
                return false;
            }
            looked.store(now, Ordering::Relaxed);
            path.is_file()
        }))
    }

    fn on_failure(
        &mut self,
        _error: &RunError,
        _last: Option<&LastState<'_, D>>,
    ) -> std::io::Result<()> {
        remove_if_there(&self.path)
    }
}
