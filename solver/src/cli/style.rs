//! What is written to the terminal: colours only there, and none with `NO_COLOR`.

use std::io::{self, IsTerminal, Write};
use std::sync::OnceLock;

pub use crate::runner::listing as diagnostics;

/// A way to write text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ink {
    /// As a heading.
    Bold,
    /// Bad.
    Red,
    /// Worth a look.
    Yellow,
    /// Good.
    Green,
}

impl Ink {
    fn code(self) -> &'static str {
        match self {
            Self::Bold => "1",
            Self::Red => "1;31",
            Self::Yellow => "1;33",
            Self::Green => "1;32",
        }
    }
}

fn wants_colour(is_terminal: bool) -> bool {
    let is_unset = |name: &str| std::env::var_os(name).is_none_or(|value| value.is_empty());
    is_terminal && is_unset("NO_COLOR") && std::env::var_os("TERM").is_none_or(|t| t != "dumb")
}

fn painted(ink: Ink, text: &str, is_terminal: bool) -> String {
    if wants_colour(is_terminal) {
        format!("\x1b[{}m{text}\x1b[0m", ink.code())
    } else {
        text.to_owned()
    }
}

/// Text in colour if standard output shows colours.
pub fn on_stdout(ink: Ink, text: &str) -> String {
    painted(ink, text, io::stdout().is_terminal())
}

/// Text whose lines may begin with the word `error` or `warning`, these in colour.
fn with_words(text: &str, is_terminal: bool) -> String {
    let line = |line: &str| {
        let words = [("error", Ink::Red), ("warning", Ink::Yellow)];
        let begin = words.iter().find(|(word, _)| line.starts_with(&format!("{word}: ")));
        begin.map_or_else(
            || line.to_owned(),
            |(word, ink)| line.replacen(word, &painted(*ink, word, is_terminal), 1),
        )
    };
    text.split('\n').map(line).collect::<Vec<_>>().join("\n")
}

/// Why standard output could not be written, if it could not.
static STDOUT_ERROR: OnceLock<io::Error> = OnceLock::new();

/// Writes lines to standard output. A reader that has gone away is no reason to complain; a full disk
/// is one, and decides the exit code in the end.
pub fn say(text: &str) {
    if let Err(error) = writeln!(io::stdout().lock(), "{text}")
        && error.kind() != io::ErrorKind::BrokenPipe
    {
        // The first one says what is wrong
        let _ = STDOUT_ERROR.set(error);
    }
}

/// Why something was not written to standard output, if it was not.
pub fn stdout_error() -> Option<&'static io::Error> {
    if let Err(error) = io::stdout().lock().flush()
        && error.kind() != io::ErrorKind::BrokenPipe
    {
        let _ = STDOUT_ERROR.set(error);
    }
    STDOUT_ERROR.get()
}

/// Writes lines to standard error, `error` and `warning` at their beginning in colour.
pub fn complain(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{}", with_words(text, io::stderr().is_terminal()));
}
