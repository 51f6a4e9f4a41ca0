//! Messages and log of a run: whether they can be read, and have each step once.

use std::path::Path;

use serde_json::Value;

use super::found::Found;
use super::known::Known;
use crate::case::Cadence;
use crate::observer::read_messages;

/// Looks at `run.mcap`.
pub fn check_messages(directory: &Path, known: &Known, found: &mut Found) {
    let file = "run.mcap";
    let writes = known.case.as_ref().is_some_and(|case| case.output.series != Cadence::Never);
    if !directory.join(file).exists() {
        if writes && known.is_finished() {
            found.wrong(file, "it is missing");
        }
        return;
    }
    let Some(messages) = found.read(file, read_messages(directory)) else { return };
    found.count("messages", messages.n_messages);
    if let Some(damage) = messages.damage {
        found.wrong(file, format!("it is damaged: {damage}"));
    }
    if let Some(twice) = messages.twice {
        found.wrong(file, format!("it has a message twice: {twice}"));
    }
    let rows = known.series.as_ref().map(|series| series.times.len());
    if known.is_finished() && rows.is_some_and(|rows| rows != messages.n_steps) {
        let n = messages.n_steps;
        let what = format!("it has {n} steps, and series.csv has {} rows", rows.unwrap_or(0));
        found.wrong(file, what);
    }
}

/// Looks at `log.jsonl`, of which the last line of a process that was killed may be half there.
pub fn check_log(directory: &Path, known: &Known, found: &mut Found) {
    let file = "log.jsonl";
    let Ok(text) = std::fs::read(directory.join(file)) else {
        return found.wrong(file, "it cannot be read");
    };
    let text = String::from_utf8_lossy(&text);
    let whole = text.rfind('\n').map_or("", |end| &text[..end]);
    for (index, line) in whole.lines().enumerate() {
        // Where a process was killed the next one continued in the same line
        if !line.is_empty() && serde_json::from_str::<Value>(line).is_err() {
            let legs = known.provenance.as_ref().map_or(0, |provenance| provenance.legs.len());
            if legs < 2 {
                return found.wrong(file, format!("line {} is no JSON", index + 1));
            }
        }
    }
}
