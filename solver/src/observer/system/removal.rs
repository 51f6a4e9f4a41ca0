//! Names of files in a folder, and their removal; links are not followed.

use std::fs;
use std::io;
use std::path::Path;

use super::atomic::AtPath;

/// Names of the files of a folder, none if it is a link or is not there.
pub(in crate::observer) fn names_in(folder: &Path) -> io::Result<Vec<String>> {
    if !fs::symlink_metadata(folder).is_ok_and(|found| found.is_dir()) {
        return Ok(Vec::new());
    }
    let name = |entry: io::Result<fs::DirEntry>| entry.map(|e| e.file_name().into_string().ok());
    fs::read_dir(folder)?.filter_map(|entry| name(entry).transpose()).collect()
}

/// Removes a file, if it is there.
///
/// # Errors
/// When the file system refuses.
pub fn remove_if_there(file: &Path) -> io::Result<()> {
    match fs::remove_file(file) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error).at(file),
        _ => Ok(()),
    }
}

pub(in crate::observer) fn remove_if_empty(folder: &Path) -> io::Result<()> {
    use io::ErrorKind::{DirectoryNotEmpty, NotADirectory, NotFound};
    match fs::remove_dir(folder) {
        Err(error) if !matches!(error.kind(), DirectoryNotEmpty | NotADirectory | NotFound) => {
            Err(error).at(folder)
        }
        _ => Ok(()),
    }
}
