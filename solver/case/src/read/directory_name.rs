//! Names of cases and sweeps as those of directories.

use super::CaseFile;

/// The full name of a case, or the name of a sweep, as that of a directory.
#[must_use]
pub fn directory_name(name: &str) -> String {
    name.replace('/', "-")
}

impl CaseFile {
    /// The full name as that of a directory: `sphere-in-tube-free-0.5`.
    #[must_use]
    pub fn directory_name(&self) -> String {
        directory_name(&self.full_name())
    }
}
