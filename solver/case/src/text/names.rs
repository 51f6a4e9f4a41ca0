//! Names in a case: what may be one, of a body as of a variant.

/// The table that says what a sweep varies; it is no part of the case itself.
pub const SWEEP: &str = "sweep";

/// Most characters of a name.
pub const LONGEST_NAME: usize = 64;

/// Why a name cannot be that of a directory; `None` if it can.
#[must_use]
pub fn unusable_as_directory(name: &str) -> Option<String> {
    let n = name.chars().count();
    if name.trim().is_empty() {
        Some("it is empty".to_owned())
    } else if name == "." || name == ".." {
        Some("it stands for a directory that is there already".to_owned())
    } else if name.chars().any(char::is_control) {
        Some("it has a control character, such as a line break".to_owned())
    } else if name.contains(['/', '\\']) {
        Some("it has a slash".to_owned())
    } else {
        (n > LONGEST_NAME).then(|| format!("it has {n} characters, more than {LONGEST_NAME}"))
    }
}

/// Whether a name is one word of letters, digits, - and _.
#[must_use]
pub fn is_word(name: &str) -> bool {
    !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_')
}
