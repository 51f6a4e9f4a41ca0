//! What commands write of a soft case: a case that runs, with the files it names.

use std::path::Path;
use std::{fs, io};

use alewife_case::soft::SoftFile;
use alewife_case::soft::spec::SoftCase;

use crate::search::write_whole;

/// Names of the files beside a case that is written.
const BESIDE: [&str; 2] = ["record.csv", "mesh.msh"];

/// Writes `case.toml` with the files that the case names beside it: a case that runs as it stands there.
///
/// # Errors
/// What the file system reports, and a case that is no TOML.
pub fn write_case(directory: &Path, file: &SoftFile, case: &SoftCase) -> io::Result<()> {
    let mut case = case.clone();
    let [record, mesh] = BESIDE;
    if let (Some(spec), Some(beside)) = (&mut case.record, &file.record) {
        record.clone_into(&mut spec.file);
        write_whole(&directory.join(record), &beside.bytes)?;
    }
    let given = case.solid.first_mut().and_then(|solid| solid.mesh.as_mut());
    if let (Some(spec), Some(beside)) = (given, &file.mesh) {
        mesh.clone_into(&mut spec.file);
        write_whole(&directory.join(mesh), &beside.bytes)?;
    }
    let text = toml::to_string_pretty(&case).map_err(io::Error::other)?;
    write_whole(&directory.join("case.toml"), text)
}

/// A number that tells the `case.toml` of a search from any other, for its report.
///
/// # Errors
/// What the file system reports.
pub fn checksum_of_case(directory: &Path) -> io::Result<String> {
    fs::read(directory.join("case.toml")).map(|bytes| checksum(&bytes))
}

fn checksum(bytes: &[u8]) -> String {
    format!("crc32:{:08x}-{}", crc32fast::hash(bytes), bytes.len())
}

/// A number that tells a case with its files from others.
#[must_use]
pub fn fingerprint(file: &SoftFile) -> String {
    let mut bytes = toml::to_string(&file.case).unwrap_or_default().into_bytes();
    for beside in [&file.record, &file.mesh].into_iter().flatten() {
        bytes.extend_from_slice(&beside.bytes);
    }
    checksum(&bytes)
}
