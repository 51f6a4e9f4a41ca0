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

// `SHIPPED: &[Shipped]`, by name; written by build.rs.
include!(concat!(env!("OUT_DIR"), "/shipped_cases.rs"));

/// All shipped cases, by name.
#[must_use]
pub fn list() -> &'static [Shipped] {
    SHIPPED
}

/// The shipped case of that name.
#[must_use]
pub fn find(name: &str) -> Option<&'static Shipped> {
    SHIPPED.iter().find(|case| case.name == name)
}
