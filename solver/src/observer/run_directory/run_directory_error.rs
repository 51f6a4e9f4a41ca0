//! `RunDirectoryError`: why a run may not use a directory.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

use super::run_lock::LockError;

/// Why a run may not use a directory.
#[derive(Debug, Error)]
pub enum RunDirectoryError {
    /// It holds a run that came to its end.
    #[error("{path} holds a finished run; give another directory with --out, or --overwrite it")]
    Finished {
        /// The directory.
        path: PathBuf,
    },
    /// Another process runs in it, or that cannot be known.
    #[error(transparent)]
    Lock(#[from] LockError),
    /// It holds a run that can be resumed.
    #[error(
        "{path} holds a run that failed and can be resumed with other settings; give --resume {state}, \
         another directory with --out, or --overwrite it"
    )]
    Resumable {
        /// The directory.
        path: PathBuf,
        /// The state it left.
        state: PathBuf,
    },
    /// It holds files that are not those of a run.
    #[error("{path} is not empty and holds no run of alewife; give another directory with --out")]
    NotARun {
        /// The directory.
        path: PathBuf,
    },
    /// It is a file.
    #[error("{path} is a file, and a run takes a directory; give another name with --out")]
    NotADirectory {
        /// The file.
        path: PathBuf,
    },
    /// It cannot be made.
    #[error("the directory {path} cannot be made: {source}; give one you may write to with --out")]
    NotMade {
        /// The directory.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The case cannot be written as TOML.
    #[error("the case cannot be written to case.toml: {0}")]
    Case(#[from] toml::ser::Error),
    /// The file system refused.
    #[error(transparent)]
    Io(#[from] io::Error),
}
