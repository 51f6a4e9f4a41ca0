//! Soft cases that are given as text.

use std::fs;

use alewife_case::CaseError;
use alewife_case::soft::SoftFile;
use tempfile::TempDir;

/// What is read of a case, as it is written to `case.toml` in a folder.
pub fn read_in(folder: &TempDir, text: &str) -> Result<SoftFile, CaseError> {
    let path = folder.path().join("case.toml");
    fs::write(&path, text).expect("it is written");
    SoftFile::read(&path.display().to_string(), &[])
}

/// The same in a folder of its own.
pub fn read(text: &str) -> Result<SoftFile, CaseError> {
    read_in(&TempDir::new().expect("there is room"), text)
}
