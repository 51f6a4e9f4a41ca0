//! `RunLock`: one process for a run directory; the system gives it free however the process ends.

use std::fs::{File, TryLockError};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::observer::system::{AtPath, process};

/// The file that is locked.
const FILE: &str = "lock";
/// Longest name of a holder that is told (bytes).
const LONGEST: u64 = 300;

/// Why a run directory cannot be held.
#[derive(Debug, Error)]
pub enum LockError {
    /// Another process has it.
    #[error(
        "another run{} is writing to {path}; wait for it, or give another directory with --out",
        holder.as_ref().map(|holder| format!(" ({holder})")).unwrap_or_default()
    )]
    InUse {
        /// The directory.
        path: PathBuf,
        /// The other process, as far as it is known.
        holder: Option<String>,
    },
    /// The file system refused.
    #[error(transparent)]
    Io(#[from] io::Error),
}

/// A run directory, held by this process as long as the value lives.
#[derive(Debug)]
pub struct RunLock {
    /// Open and locked.
    _file: File,
}

impl RunLock {
    /// Holds a directory.
    ///
    /// # Errors
    /// When another process has it, or the file system refuses.
    pub fn take(directory: &Path) -> Result<Self, LockError> {
        let path = directory.join(FILE);
        let file = File::options().create(true).truncate(false).read(true).write(true).open(&path);
        let mut file = file.at(&path)?;
        match file.try_lock() {
            Ok(()) => {
                // Tells others who it is; a full disk is found soon enough by files that matter
                let _ = file.set_len(0).and_then(|()| file.write_all(holder().as_bytes()));
                Ok(Self { _file: file })
            }
            Err(TryLockError::WouldBlock) => {
                let mut holder = String::new();
                let _ = file.take(LONGEST).read_to_string(&mut holder);
                let holder = Some(holder.trim().to_owned()).filter(|holder| !holder.is_empty());
                Err(LockError::InUse { path: directory.to_owned(), holder })
            }
            // Some network file systems have no locks; a run there is better than none.
            Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => {
                Ok(Self { _file: file })
            }
            Err(TryLockError::Error(error)) => Err(error).at(&path)?,
        }
    }

    /// Whether the process of this computer that held a directory last has ended; never so for a process of
    /// another computer, whose locks need not be seen here.
    #[must_use]
    pub fn is_left(directory: &Path) -> bool {
        let Ok(mut file) = File::open(directory.join(FILE)) else { return false };
        let mut holder = String::new();
        let is_read = Read::by_ref(&mut file).take(LONGEST).read_to_string(&mut holder).is_ok();
        let host = process::host_name().map(|host| format!(" on {host}"));
        let was_here = host.is_some_and(|host| is_read && holder.trim().ends_with(&host));
        was_here && file.try_lock_shared().is_ok()
    }

    /// Whether a process has a directory just now; it is not told where the system has no locks.
    #[must_use]
    pub fn is_held(directory: &Path) -> bool {
        let file = File::open(directory.join(FILE));
        file.is_ok_and(|file| matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock)))
    }
}

/// How this process is known to others.
fn holder() -> String {
    let host = process::host_name().map_or(String::new(), |host| format!(" on {host}"));
    format!("process {}{host}\n", std::process::id())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_second_is_told_who_is_first_and_a_file_that_was_left_does_not_matter() {
        let place = tempfile::tempdir().unwrap();
        std::fs::write(place.path().join(FILE), "process 1 on a computer that was switched off\n")
            .unwrap();
        assert!(!RunLock::is_left(place.path()), "it may run on that computer");
        let first = RunLock::take(place.path()).unwrap();
        let told = RunLock::take(place.path()).unwrap_err().to_string();
        assert!(RunLock::is_held(place.path()) && !RunLock::is_left(place.path()));
        let first_is = format!("process {}", std::process::id());
        assert!(told.contains(&first_is) && !told.contains("switched off"), "{told}");
        drop(first);
        assert!(!RunLock::is_held(place.path()));
        assert_eq!(RunLock::is_left(place.path()), process::host_name().is_some());
        RunLock::take(place.path()).unwrap();
    }
}
