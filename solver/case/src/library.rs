//! The cases shipped with the program, embedded when it is built.

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

// `SHIPPED: &[Shipped]`, by name, and `FILES: &[ShippedFile]`; written by build.rs.
include!(concat!(env!("OUT_DIR"), "/shipped_cases.rs"));

/// All shipped cases, by name.
#[must_use]
pub fn list() -> &'static [Shipped] {
    SHIPPED
}

/// The content of a file that is shipped beside the file of a case.
#[must_use]
pub fn file_beside(case_file: &str, name: &str) -> Option<&'static [u8]> {
    let folder = case_file.strip_suffix("case.toml")?;
    let is_it = |file: &&ShippedFile| file.path.strip_prefix(folder) == Some(name);
    FILES.iter().find(is_it).map(|file| file.bytes)
}

/// The shipped case of that name.
#[must_use]
pub fn find(name: &str) -> Option<&'static Shipped> {
    SHIPPED.iter().find(|case| case.name == name)
}
