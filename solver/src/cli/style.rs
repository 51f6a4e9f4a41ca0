//! What is written to the terminal: colours only there, and none with `NO_COLOR`.

use std::io::{self, IsTerminal, Write};

use crate::case::{Diagnostic, Severity};

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

/// Writes lines to standard output. A reader that has gone away is no reason to complain.
pub fn say(text: &str) {
    let _ = writeln!(io::stdout().lock(), "{text}");
}

/// Writes lines to standard error.
pub fn complain(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{text}");
}
