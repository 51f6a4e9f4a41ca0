//! The cases shipped with the program, embedded when it is built.

use std::path::{Path, PathBuf};

use crate::text::source::Source;

/// A shipped case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shipped {
    /// Name: that of its folder in `cases/`.
    pub name: &'static str,
    /// Path of its file in the repository.
    pub file: &'static str,
    /// Content of the file.
    pub text: &'static str,
}

/// A file that a shipped case names.
struct ShippedFile {
    /// Its path in the repository.
    path: &'static str,
    bytes: &'static [u8],
}

// `SHIPPED: &[Shipped]` and `SOFT: &[Shipped]`, by name, and `FILES: &[ShippedFile]`; written by build.rs.
include!(concat!(env!("OUT_DIR"), "/shipped_cases.rs"));

/// All shipped cases of the full solver, by name.
#[must_use]
pub fn list() -> &'static [Shipped] {
    SHIPPED
}

/// The shipped cases of the soft tier, by name.
#[must_use]
pub fn soft() -> &'static [Shipped] {
    SOFT
}

/// The content of a file that is shipped beside the file of a case, or beside that of another one as
/// `../OTHER/FILE`.
#[must_use]
pub fn file_beside(case_file: &str, name: &str) -> Option<&'static [u8]> {
    let own = case_file.strip_suffix("case.toml")?;
    let (folder, name) = match name.strip_prefix("../") {
        Some(beside_other) => ("cases/", beside_other),
        None => (own, name),
    };
    let is_it = |file: &&ShippedFile| file.path.strip_prefix(folder) == Some(name);
    FILES.iter().find(is_it).map(|file| file.bytes)
}

/// A file that another one names.
pub(crate) enum Beside {
    /// Shipped with the program.
    Shipped(&'static [u8]),
    /// To be read from this path, where it may not be.
    OnDisk(PathBuf),
}

/// Finds what a file names: beside it on the disk, or, of a shipped case, among the files shipped with it, else in the folder
/// in which the program is called. None where it cannot be reached.
pub(crate) fn beside(source: &Source, file: &str) -> Option<Beside> {
    if let Some(directory) = &source.directory {
        return Some(Beside::OnDisk(directory.join(file)));
    }
    let is_shipped = || SHIPPED.iter().chain(SOFT).any(|case| case.file == source.name);
    let path = Path::new(file);
    let brought = || (is_shipped() && path.is_file()).then(|| Beside::OnDisk(path.to_owned()));
    file_beside(&source.name, file).map(Beside::Shipped).or_else(brought)
}

/// The shipped case of that name.
#[must_use]
pub fn find(name: &str) -> Option<&'static Shipped> {
    SHIPPED.iter().chain(SOFT).find(|case| case.name == name)
}

#[cfg(test)]
mod tests {
    use super::file_beside;

    #[test]
    fn files_of_other_cases_are_found_by_their_folders() {
        let own = file_beside("cases/vessel/case.toml", "vessel.msh");
        assert!(own.is_some());
        assert_eq!(file_beside("cases/three-sphere-3d/case.toml", "../vessel/vessel.msh"), own);
        for wrong in ["vessel.msh", "../vessel.msh", "../../cases/vessel/vessel.msh", "../vessel/"]
        {
            assert_eq!(file_beside("cases/three-sphere-3d/case.toml", wrong), None, "{wrong}");
        }
    }
}
