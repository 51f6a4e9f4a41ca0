//! What may be in a directory where a run begins: nothing of others.

use std::fs;
use std::path::Path;

use super::marker::is_a_run;
use super::run_directory_error::RunDirectoryError;
use super::run_lock::LOCK_FILE;
use crate::observer::system::{AtPath, UNFINISHED};

/// Refuses a directory with files of others. The lock and files that are not whole are all that a process leaves
/// which is killed before the marker is there.
pub fn check_is_for_runs(path: &Path) -> Result<(), RunDirectoryError> {
    if is_a_run(path) {
        return Ok(());
    }
    for entry in fs::read_dir(path).at(path)? {
        let name = entry.at(path)?.file_name();
        let is_ours = name == LOCK_FILE || name.to_string_lossy().starts_with(UNFINISHED);
        // Another process may have begun a run meanwhile
        if !is_ours && !is_a_run(path) {
            return Err(RunDirectoryError::NotARun { path: path.to_owned() });
        }
    }
    Ok(())
}
