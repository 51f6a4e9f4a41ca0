//! `RunDirectory`: the directory of one run, held by one process; files that are whole or absent.

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use super::atomic::write_atomic;
use super::provenance::Provenance;
use super::status::{RunState, Status};
use crate::case::Case;

/// Files and directories a run makes; nothing else is ever removed.
const MADE_BY_A_RUN: [&str; 12] = [
    "case.toml",
    "provenance.json",
    "status.json",
    "log.jsonl",
    "series.csv",
    "run.mcap",
    "fields",
    "fields.pvd",
    "comparison.json",
    "checkpoint.a",
    "checkpoint.b",
    "failure",
];

/// Why a run may not use a directory.
#[derive(Debug, Error)]
pub enum RunDirectoryError {
    /// It holds a run that came to its end.
    #[error("{path} holds a finished run; give another directory with --out, or --overwrite it")]
    Finished {
        /// The directory.
        path: PathBuf,
    },
    /// Another process runs in it.
    #[error("another run is writing to {path}; wait for it, or give another directory with --out")]
    InUse {
        /// The directory.
        path: PathBuf,
    },
    /// It holds files that are not those of a run.
    #[error("{path} is not empty and holds no run; give another directory with --out")]
    NotARun {
        /// The directory.
        path: PathBuf,
    },
    /// The case cannot be written as TOML.
    #[error("the case cannot be written to case.toml: {0}")]
    Case(#[from] toml::ser::Error),
    /// The file system refused.
    #[error("{path}: {source}")]
    Io {
        /// The directory.
        path: PathBuf,
        /// What it said.
        source: io::Error,
    },
}

/// The directory of one run, locked for this process as long as the value lives.
#[derive(Debug)]
pub struct RunDirectory {
    path: PathBuf,
    case_text: String,
    provenance: Provenance,
    /// Open and locked; closing it gives the directory free, however the process ends.
    _lock: File,
}

impl RunDirectory {
    /// Makes the directory, with `case.toml` and `provenance.json` in it.
    ///
    /// An unfinished run that is there already is replaced, a finished one only if `overwrite`.
    ///
    /// # Errors
    /// [`RunDirectoryError`]: another run has it, it holds other files, or it cannot be written.
    pub fn create(
        path: &Path,
        case: &Case,
        threads: usize,
        overwrite: bool,
    ) -> Result<Self, RunDirectoryError> {
        let failed = |source| RunDirectoryError::Io { path: path.to_owned(), source };
        fs::create_dir_all(path).map_err(failed)?;
        if !is_empty(path).map_err(failed)? && !is_a_run(path) {
            return Err(RunDirectoryError::NotARun { path: path.to_owned() });
        }
        let Some(lock) = lock(&path.join("lock")).map_err(failed)? else {
            return Err(RunDirectoryError::InUse { path: path.to_owned() });
        };
        if Status::read(path).is_ok_and(|status| status.state == RunState::Finished) && !overwrite {
            return Err(RunDirectoryError::Finished { path: path.to_owned() });
        }
        clear(path).map_err(failed)?;

        let case_text = case.to_toml()?;
        let provenance = Provenance::of_this_process(&case_text, threads);
        let mut provenance_text =
            serde_json::to_vec_pretty(&provenance).map_err(|error| failed(error.into()))?;
        provenance_text.push(b'\n');
        write_atomic(&path.join("case.toml"), case_text.as_bytes()).map_err(failed)?;
        write_atomic(&path.join("provenance.json"), &provenance_text).map_err(failed)?;
        Ok(Self { path: path.to_owned(), case_text, provenance, _lock: lock })
    }

    /// Where it is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The content of `case.toml`.
    #[must_use]
    pub fn case_text(&self) -> &str {
        &self.case_text
    }

    /// The content of `provenance.json`.
    #[must_use]
    pub fn provenance(&self) -> &Provenance {
        &self.provenance
    }
}

fn is_empty(path: &Path) -> io::Result<bool> {
    Ok(fs::read_dir(path)?.next().is_none())
}

fn is_a_run(path: &Path) -> bool {
    ["lock", "case.toml", "status.json"].iter().any(|name| path.join(name).is_file())
}

/// The lock file, locked; nothing if another process has it.
fn lock(path: &Path) -> io::Result<Option<File>> {
    let file = File::options().create(true).truncate(false).write(true).open(path)?;
    match file.try_lock() {
        Ok(()) => Ok(Some(file)),
        Err(TryLockError::WouldBlock) => Ok(None),
        // Some network file systems have no locks; a run there is better than none.
        Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => {
            Ok(Some(file))
        }
        Err(TryLockError::Error(error)) => Err(error),
    }
}

/// Removes what an earlier run left, and nothing else.
fn clear(path: &Path) -> io::Result<()> {
    for name in MADE_BY_A_RUN {
        let victim = path.join(name);
        let removed = if victim.is_dir() && !victim.is_symlink() {
            fs::remove_dir_all(&victim)
        } else {
            fs::remove_file(&victim)
        };
        match removed {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
            _ => {}
        }
    }
    Ok(())
}
