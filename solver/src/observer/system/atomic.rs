//! Files that are seen whole or not at all.

use std::fs::File;
use std::io::{self, Write};
use std::path::Path;

use tempfile::NamedTempFile;

/// How the names of files begin that are not whole yet.
pub const UNFINISHED: &str = ".unfinished-";

/// An error of the file system that names the file.
pub(in crate::observer) trait AtPath<T> {
    /// The same with the path in front of it, once.
    fn at(self, path: &Path) -> io::Result<T>;
}

impl<T> AtPath<T> for io::Result<T> {
    fn at(self, path: &Path) -> io::Result<T> {
        self.map_err(|error| {
            let path = path.display().to_string();
            let reported = error.to_string();
            let reported =
                if reported.starts_with(&path) { reported } else { format!("{path}: {reported}") };
            io::Error::new(error.kind(), reported)
        })
    }
}

/// Writes a file that is seen whole or not at all, even after a power cut, and is there after one.
///
/// # Errors
/// When the file system refuses, with the path; the old file is then still there.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> io::Result<()> {
    write_whole(path, bytes)?;
    // The new name is on the disk only once the directory is.
    #[cfg(unix)]
    File::open(directory_of(path)).and_then(|directory| directory.sync_all()).at(path)?;
    Ok(())
}

/// The same, but that after a power cut the old file may still be there, until [`write_atomic`] writes another
/// into its directory: one wait for the disk less.
///
/// # Errors
/// When the file system refuses, with the path; the old file is then still there.
pub(in crate::observer) fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    replace(path, bytes).at(path)
}

/// The directory a file is in.
pub fn directory_of(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = unfinished_file(directory_of(path))?;
    // The temporary name means nothing to anybody
    file.as_file_mut().write_all(bytes)?;
    file.as_file().sync_all()?;
    file.persist(path).map_err(|refused| refused.error)?;
    Ok(())
}

/// A file in a directory that goes away unless it is given a name.
///
/// # Errors
/// When the file system refuses.
pub(in crate::observer) fn unfinished_file(directory: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(UNFINISHED);
    // Temporary files are for their owner only; what a run leaves is for whoever may read it.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(directory)
}
