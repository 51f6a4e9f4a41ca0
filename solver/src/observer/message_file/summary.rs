//! What a `run.mcap` holds, for who looks whether it is whole.

use std::collections::HashSet;
use std::io;
use std::path::Path;

use super::messages::Messages;
use crate::observer::system::AtPath;

/// What a `run.mcap` holds.
#[derive(Debug)]
pub struct MessageSummary {
    /// What is damaged, if anything is.
    pub damage: Option<String>,
    /// All messages.
    pub n_messages: usize,
    /// Those that report a step.
    pub n_steps: usize,
    /// Topic and time (ns) of the first that is there twice, which only those of the log may be.
    pub twice: Option<String>,
}

/// Reads the messages of the run in a directory.
///
/// # Errors
/// When there is no such file, or it cannot be read.
pub fn read_messages(directory: &Path) -> io::Result<MessageSummary> {
    let path = directory.join("run.mcap");
    let Messages { all, damage, .. } = Messages::read(&std::fs::read(&path).at(&path)?);
    let mut known = HashSet::new();
    let reported = all.iter().filter(|message| message.topic != "/log");
    let twice = reported
        .map(|message| (message.topic.as_str(), message.time))
        .find(|place| !known.insert(*place))
        .map(|(topic, time)| format!("{topic} at {time} ns"));
    let n_steps = all.iter().filter(|message| message.topic == "/step").count();
    Ok(MessageSummary { damage, n_messages: all.len(), n_steps, twice })
}
