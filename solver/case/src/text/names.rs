//! Names in a case: what may be one, of a body as of a variant.

use std::collections::BTreeMap;

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

/// A step along a dotted path.
pub struct Step<'a, 'p, T> {
    /// Where it leads to.
    pub node: &'a T,
    /// What is left of the path.
    pub after: &'p str,
}

/// The entry whose key has dots, such as `"body.x" = ...`, at the beginning of a path.
pub fn with_dots<'a, 'p, T>(
    entries: &'a BTreeMap<String, T>,
    path: &'p str,
) -> Option<Step<'a, 'p, T>> {
    let dotted = entries.iter().filter(|(key, _)| key.contains('.'));
    let mut steps = dotted.filter_map(|(key, node)| {
        path.strip_prefix(key.as_str()).map(|after| Step { node, after })
    });
    steps.find(|Step { after, .. }| after.is_empty() || after.starts_with('.'))
}
