//! `Commands`: all that a case waits for, by name; and what was asked for so far.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::spec::body::command::Command;
use crate::text::nearest::several_nearest;

/// Something that is asked for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Asked {
    /// From when on (s).
    pub time: f64,
    /// Name of the command.
    pub command: String,
    /// The value that is asked for; beyond its limits it is clipped.
    pub target: f64,
}

/// Why something cannot be asked for.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CommandError {
    /// There is no such command.
    #[error("there is no command `{name}`; {}", known(.nearest, .all))]
    Unknown {
        /// What was named.
        name: String,
        /// What may be meant.
        nearest: Vec<String>,
        /// All there are.
        all: Vec<String>,
    },
    /// No number.
    #[error("`{name}` is asked for {target}; give a finite number")]
    NotFinite {
        /// The command.
        name: String,
        /// What was asked for.
        target: f64,
    },
    /// The past cannot be changed.
    #[error(
        "`{name}` is asked for {target} from time {time} on, and was asked before from {last} on"
    )]
    Past {
        /// The command.
        name: String,
        /// What was asked for.
        target: f64,
        /// From when on (s).
        time: f64,
        /// When something was asked for last (s).
        last: f64,
    },
}

fn known(nearest: &[String], all: &[String]) -> String {
    let list = |names: &[String]| names.join(", ");
    match (nearest, all) {
        (_, []) => {
            "the case has none: write `command = { ... }` in the place of a stroke".to_owned()
        }
        ([], all) => format!("there are: {}", list(all)),
        (nearest, all) => format!("did you mean {}? There are: {}", list(nearest), list(all)),
    }
}

/// A command, and the key of the case where it stands.
#[derive(Debug, Clone)]
struct Input {
    key: String,
    command: Command,
}

/// All commands of a case, which share what is asked for with the strokes of its model.
#[derive(Debug, Clone, Default)]
pub struct Commands {
    inputs: BTreeMap<String, Input>,
}

impl Commands {
    /// Adds a command, from now on with nothing asked for.
    pub(crate) fn connect(&mut self, name: String, key: String, command: &mut Command) {
        command.disconnect();
        self.inputs.entry(name).or_insert_with(|| Input { key, command: command.clone() });
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.inputs.is_empty()
    }

    /// Names of all.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        self.inputs.keys().cloned().collect()
    }

    /// Where they stand in the case, by name.
    pub fn keys(&self) -> impl Iterator<Item = (&str, &str)> {
        self.inputs.iter().map(|(name, input)| (name.as_str(), input.key.as_str()))
    }

    /// A command by its name.
    ///
    /// # Errors
    /// [`CommandError::Unknown`].
    pub fn get(&self, name: &str) -> Result<&Command, CommandError> {
        self.inputs.get(name).map(|input| &input.command).ok_or_else(|| {
            let all = self.names();
            let known: Vec<&str> = all.iter().map(String::as_str).collect();
            let nearest = several_nearest(name, &known).into_iter().map(str::to_owned).collect();
            CommandError::Unknown { name: name.to_owned(), nearest, all }
        })
    }

    /// Asks for something.
    ///
    /// # Errors
    /// [`CommandError`].
    pub fn ask(&self, one: &Asked) -> Result<(), CommandError> {
        let Asked { time, command: name, target } = one;
        let (time, target) = (*time, *target);
        let command = self.get(name)?;
        let name = || name.clone();
        if !target.is_finite() {
            return Err(CommandError::NotFinite { name: name(), target });
        }
        if let Some(last) = command.last_asked().filter(|last| *last > time || time.is_nan()) {
            return Err(CommandError::Past { name: name(), target, time, last });
        }
        command.ask(time, target);
        Ok(())
    }
}
