//! What is written to the terminal: colours only there, and none with `NO_COLOR`.

use std::io::{self, IsTerminal, Write};
use std::sync::OnceLock;

use crate::case::{Diagnostic, Severity};

/// Errors, and warnings, that are listed at once.
const MOST_DIAGNOSTICS: usize = 20;

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

/// Text in colour if standard error shows colours.
pub fn on_stderr(ink: Ink, text: &str) -> String {
    painted(ink, text, io::stderr().is_terminal())
}

/// A diagnostic with its severity in colour.
pub fn diagnostic(diagnostic: &Diagnostic) -> String {
    let (word, ink) = match diagnostic.severity {
        Severity::Error => ("error", Ink::Red),
        Severity::Warning => ("warning", Ink::Yellow),
    };
    diagnostic.to_string().replacen(word, &on_stderr(ink, word), 1)
}

/// `error: ...`, the first word in colour.
pub fn error(message: &str) -> String {
    format!("{}: {message}", on_stderr(Ink::Red, "error"))
}

/// Diagnostics one below the other, errors first; of many of a kind the first ones.
pub fn diagnostics(found: &[Diagnostic]) -> String {
    let mut texts = Vec::new();
    for (severity, many) in [(Severity::Error, "errors"), (Severity::Warning, "warnings")] {
        let of_kind = || found.iter().filter(|one| one.severity == severity);
        texts.extend(of_kind().take(MOST_DIAGNOSTICS).map(diagnostic));
        let n = of_kind().count();
        if n > MOST_DIAGNOSTICS {
            texts.push(format!("... and {} more {many}", n - MOST_DIAGNOSTICS));
        }
    }
    texts.join("\n\n")
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

/// Writes lines to standard error.
pub fn complain(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{text}");
}
