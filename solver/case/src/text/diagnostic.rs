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

/// Characters of a line that are shown before and from the place on that is meant.
const SHOWN: [usize; 2] = [100, 120];

/// The part of a line that is shown.
struct Excerpt {
    text: String,
    /// Characters before the place that is meant.
    column: usize,
    /// Characters it covers.
    width: usize,
}

/// The part of a line around a place, all of it if it is short.
fn excerpt(location: &Location) -> Excerpt {
    let [before, after] = SHOWN;
    let place = location.column - 1;
    // One character for another, so that columns stay
    let mut text = location.text.chars().map(visible);
    let left_out = place.saturating_sub(before);
    let mut shown = if left_out > 0 { "...".to_owned() } else { String::new() };
    let column = place - left_out + shown.len();
    shown.extend(text.by_ref().skip(left_out).take(place - left_out + after));
    if text.next().is_some() {
        shown += "...";
    }
    Excerpt { text: shown, column, width: location.width.min(after) }
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
                let Excerpt { text, column, width } = excerpt(location);
                write!(f, "\n{margin} |\n{number} | {text}")?;
                // Tabs stay tabs, so that the caret stands below what it points at.
                let before = text.chars().take(column);
                let indent: String = before.map(|c| if c == '\t' { '\t' } else { ' ' }).collect();
                write!(f, "\n{margin} | {indent}{}", "^".repeat(width))?;
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
    #[error("cannot read {path}: {source}{}", remedy(source))]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The file is read but wrong.
    #[error("{}", listing(.0))]
    Wrong(Vec<Diagnostic>),
    /// A file that does not come with the case is not there.
    #[error("{0}")]
    Elsewhere(Diagnostic),
}

/// What helps where a file cannot be read.
fn remedy(error: &std::io::Error) -> &'static str {
    match error.kind() {
        std::io::ErrorKind::PermissionDenied => {
            "; you may not read it: give yourself the right (chmod u+r), or copy it as who may"
        }
        _ => "",
    }
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
    fn of_a_long_line_the_place_that_is_meant_is_shown() {
        let text = format!("{}HERE{}", "a".repeat(5000), "b".repeat(5000));
        let location =
            Location { file: "a.toml".to_owned(), line: 1, column: 5001, width: 4, text };
        let mut diagnostic = Diagnostic::error("a", "wrong".to_owned(), "");
        diagnostic.location = Some(location);
        let shown = diagnostic.to_string();
        let lines: Vec<&str> = shown.lines().collect();
        let place = lines[3].find("HERE").unwrap();
        assert_eq!(lines[4].find("^^^^"), Some(place), "{shown}");
        assert!(lines[3].len() < 260 && lines[3].ends_with("..."), "{shown}");
    }

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
