//! The marker by which a directory is known as that of a run.

use std::fs;
use std::io;
use std::path::Path;

use crate::observer::system::write_whole;

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
