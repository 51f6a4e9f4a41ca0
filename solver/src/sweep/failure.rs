//! `PointFailure`: why a point failed, kept beside the points.

use std::fs;
use std::io;

use serde::{Deserialize, Serialize};

use super::directory::SweepDirectory;
use crate::observer::{remove_if_there, write_atomic};

/// Why a point failed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PointFailure {
    /// Code its run ended with; nothing if a signal ended it.
    pub exit: Option<u8>,
    /// The reason.
    pub reason: String,
    /// Whether it is that its directory holds the run of another case, which only who put it there can mend.
    #[serde(default, skip_serializing)]
    pub is_of_another_case: bool,
}

/// Codes with which a point ends whenever it is run again: the solver diverged, the mesh could not
/// be made, the case is wrong, there is no progress.
const FOR_GOOD: [u8; 4] = [10, 11, 65, 76];

impl PointFailure {
    /// The failure of a run that ended with a code, if it did, and a reason.
    #[must_use]
    pub fn new(exit: Option<u8>, reason: impl Into<String>) -> Self {
        Self { exit, reason: reason.into(), is_of_another_case: false }
    }

    /// Whether the same would happen again.
    #[must_use]
    pub fn is_for_good(&self) -> bool {
        self.exit.is_some_and(|exit| FOR_GOOD.contains(&exit))
    }

    /// The line of the reason that says most.
    #[must_use]
    pub fn line(&self) -> &str {
        let mut lines = self.reason.lines();
        let first = lines.clone().next().unwrap_or("no reason was given");
        let line = lines.find(|line| line.starts_with("error: ")).unwrap_or(first);
        line.trim_start_matches("error: ").trim()
    }

    /// Keeps it.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write(&self, directory: &SweepDirectory, index: usize) -> io::Result<()> {
        let path = directory.failure(index);
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        let mut text = serde_json::to_vec(self)?;
        text.push(b'\n');
        write_atomic(&path, &text)
    }

    /// That of a point, if there is one.
    #[must_use]
    pub fn read(directory: &SweepDirectory, index: usize) -> Option<Self> {
        serde_json::from_slice(&fs::read(directory.failure(index)).ok()?).ok()
    }

    /// Forgets that of a point, which is run again.
    ///
    /// # Errors
    /// When it cannot be removed.
    pub fn forget(directory: &SweepDirectory, index: usize) -> io::Result<()> {
        remove_if_there(&directory.failure(index))
    }
}
