//! The marker by which a directory is known as that of a run, and what else may be where one begins.

use std::fs;
use std::io;
use std::path::Path;

use super::run_directory_error::RunDirectoryError;
use super::run_lock::LOCK_FILE;
use crate::observer::system::{AtPath, UNFINISHED, write_whole};

/// The file by which a run directory is known.
pub const MARKER_FILE: &str = ".alewife-run";

/// What it says.
const MARKER: &str = "This directory holds a run of alewife; another run may replace its files.\n";

/// Whether the marker of a run is there.
pub fn is_a_run(path: &Path) -> bool {
    let marker = path.join(MARKER_FILE);
    fs::symlink_metadata(&marker).is_ok_and(|found| found.is_file())
        && fs::read(&marker).is_ok_and(|text| text == MARKER.as_bytes())
}

/// Makes a directory that of a run.
pub fn mark(path: &Path) -> io::Result<()> {
    write_whole(&path.join(MARKER_FILE), MARKER.as_bytes())
}

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
