//! `Diagnostic`: what is wrong in a case, where, and what to do about it; `CaseError`.

use std::fmt;
use std::path::PathBuf;

use thiserror::Error;

use super::source::Location;

/// Whether a diagnostic stops a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Severity {
    /// The case cannot be run.
    Error,
    /// The case can be run, but may not do what is meant.
    Warning,
}

/// One thing that is wrong in a case.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// Whether it stops a run.
    pub severity: Severity,
    /// The key, with its tables: `body.0.shape.disc.radius`.
    pub key: String,
    /// What is wrong, with the value found.
    pub message: String,
    /// What is accepted, or what to do.
    pub help: String,
    /// Where it is written; nowhere if it is a default.
    pub location: Option<Location>,
}

impl Diagnostic {
    /// An error at a key of the case.
    #[must_use]
    pub(crate) fn error(key: &str, message: String, help: &str) -> Self {
        let (key, help) = (key.to_owned(), help.to_owned());
        Self { severity: Severity::Error, key, message, help, location: None }
    }
}

/// A text of a file as it may be shown on a terminal: control characters, which could move the cursor
/// or change colours, are written out (`\u{1b}`).
#[must_use]
pub fn printable(text: &str) -> String {
    let is_plain = |c: char| !c.is_control() || c == '\n' || c == '\t';
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        if is_plain(c) { shown.push(c) } else { shown.extend(c.escape_unicode()) }
    }
    shown
}

/// A character that stands for one that cannot be shown.
fn visible(c: char) -> char {
    if c.is_control() && c != '\t' { char::REPLACEMENT_CHARACTER } else { c }
}

/// `error: ...`, the location, the line with a caret below, and the help.
impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let severity = match self.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        write!(f, "{severity}: {}", printable(&self.message))?;
        let margin = match &self.location {
            Some(location) => {
                let number = location.line.to_string();
                let margin = " ".repeat(number.len());
                write!(f, "\n{margin}--> {}", printable(&location.to_string()))?;
                // One character for another, so that columns stay
                let line: String = location.text.chars().map(visible).collect();
                write!(f, "\n{margin} |\n{number} | {line}")?;
                // Tabs stay tabs, so that the caret stands below what it points at.
                let indent: String = location
                    .text
                    .chars()
                    .take(location.column - 1)
                    .map(|c| if c == '\t' { '\t' } else { ' ' })
                    .collect();
                write!(f, "\n{margin} | {indent}{}", "^".repeat(location.width))?;
                margin
            }
            None => String::new(),
        };
        if self.help.is_empty() {
            Ok(())
        } else {
            write!(f, "\n{margin} = {}", printable(&self.help))
        }
    }
}

/// Why there is no case to run.
#[derive(Debug, Error)]
pub enum CaseError {
    /// There is no such file, or no case of that name.
    #[error("{what}; {help}")]
    NotFound {
        /// What was asked for.
        what: String,
        /// What there is.
        help: String,
    },
    /// The file is there but cannot be read.
    #[error("cannot read {path}: {source}")]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The file is read but wrong.
    #[error("{}", listing(.0))]
    Wrong(Vec<Diagnostic>),
}

impl CaseError {
    /// One error at a key of the case, without its location.
    pub(crate) fn at(key: &str, message: String, help: &str) -> Self {
        Self::Wrong(vec![Diagnostic::error(key, message, help)])
    }
}

/// All diagnostics, one below the other.
fn listing(diagnostics: &[Diagnostic]) -> String {
    diagnostics.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_do_not_reach_the_terminal() {
        assert_eq!(printable("a\u{1b}[31mb\tc\nd"), "a\\u{1b}[31mb\tc\nd");
        let text = "title = \"\u{1b}[2J\"".to_owned();
        let location = Location { file: "a.toml".to_owned(), line: 1, column: 9, width: 3, text };
        let mut diagnostic = Diagnostic::error("title", "bad \u{7}".to_owned(), "");
        diagnostic.location = Some(location);
        let shown = diagnostic.to_string();
        assert!(!shown.chars().any(|c| c.is_control() && c != '\n'), "{shown:?}");
        assert!(shown.contains("bad \\u{7}") && shown.contains("\"\u{fffd}[2J\""), "{shown}");
    }
}
