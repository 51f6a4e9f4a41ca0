//! What a run asks for that repeats a session, and cases that wait for commands nobody gives.

use std::path::Path;

use super::failure::{Exit, Failure};
use crate::case::{CaseFile, Diagnostic, Recording, Severity};

/// What is recorded in the file that a run of a case repeats, if it does.
///
/// # Errors
/// When there is none and the case waits for commands, or when it cannot be read or is of another case.
pub fn recording(file: &CaseFile, replay: Option<&Path>) -> Result<Option<Recording>, Failure> {
    let commands = &file.model.commands;
    let Some(path) = replay else {
        return if commands.is_empty() { Ok(None) } else { Err(nobody_commands(file)) };
    };
    let shown = path.display();
    let text = std::fs::read_to_string(path)
        .map_err(|error| Failure::new(Exit::NoInput, format!("--replay {shown}: {error}")))?;
    let wrong = |what: String| Failure::new(Exit::BadCase, format!("--replay {shown}: {what}"));
    let recording = Recording::parse(&text).map_err(wrong)?;
    for asked in &recording.asked {
        commands.get(&asked.command).map_err(|error| wrong(error.to_string()))?;
    }
    Ok(Some(recording))
}

/// A case that waits for commands, with where they stand.
fn nobody_commands(file: &CaseFile) -> Failure {
    let diagnostics = file.model.commands.keys().map(|(name, key)| Diagnostic {
        severity: Severity::Error,
        key: key.to_owned(),
        message: format!("`{name}` waits for commands, and nobody gives them in this run"),
        help: "repeat a session with --replay commands.csv, or open one from Python with \
               alewife.session(case); write a number, a sine or a table in place of `command` for a run by \
               itself"
            .to_owned(),
        location: file.location(key),
    });
    Failure::wrong(&diagnostics.collect::<Vec<_>>())
}
