//! `Found`: what is in a directory, and what is wrong there.

use std::fmt::Display;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::cli::style::say;

/// What is wrong in a file.
#[derive(Debug)]
struct Problem {
    file: String,
    what: String,
}

/// What is in a directory.
#[derive(Debug)]
pub struct Found {
    directory: PathBuf,
    /// `run` or `sweep`.
    kind: &'static str,
    /// How it stands, in a word or two.
    pub state: String,
    /// What was looked at, and how much of it.
    counts: Vec<Count>,
    problems: Vec<Problem>,
}

#[derive(Debug)]
struct Count {
    what: &'static str,
    n: usize,
}

impl Found {
    /// Nothing yet.
    pub fn new(directory: &Path, kind: &'static str) -> Self {
        let (counts, problems) = (Vec::new(), Vec::new());
        Self {
            directory: directory.to_owned(),
            kind,
            state: "unknown".to_owned(),
            counts,
            problems,
        }
    }

    /// Something is wrong in a file.
    pub fn wrong(&mut self, file: &str, what: impl Display) {
        self.problems.push(Problem { file: file.to_owned(), what: what.to_string() });
    }

    /// What was read of a file; nothing where it cannot be, which is reported.
    pub fn read<T, E: Display>(&mut self, file: &str, read: Result<T, E>) -> Option<T> {
        read.map_err(|error| self.wrong(file, error)).ok()
    }

    /// So much was looked at.
    pub fn count(&mut self, what: &'static str, n: usize) {
        self.counts.push(Count { what, n });
    }

    /// Adds what was found in a directory below.
    pub fn take_in(&mut self, below: &str, other: Self) {
        let all = other.problems.into_iter();
        self.problems.extend(
            all.map(|Problem { file, what }| Problem { file: format!("{below}/{file}"), what }),
        );
    }

    /// Whether nothing is wrong.
    pub fn is_sound(&self) -> bool {
        self.problems.is_empty()
    }

    pub fn to_json(&self) -> Value {
        let counts: serde_json::Map<String, Value> =
            self.counts.iter().map(|count| (count.what.to_owned(), count.n.into())).collect();
        let problem = |one: &Problem| json!({ "file": one.file, "problem": one.what });
        json!({
            "directory": self.directory,
            "kind": self.kind,
            "state": self.state,
            "sound": self.is_sound(),
            "counts": counts,
            "problems": self.problems.iter().map(problem).collect::<Vec<_>>(),
        })
    }

    pub fn print(&self) {
        let counts: Vec<String> =
            self.counts.iter().map(|count| format!("{}: {}", count.what, count.n)).collect();
        let sound = match self.problems.len() {
            0 => "sound".to_owned(),
            1 => "1 problem".to_owned(),
            n => format!("{n} problems"),
        };
        let (directory, state) = (self.directory.display(), &self.state);
        say(&format!("{directory}: {sound}; {state}; {}", counts.join(", ")));
        for Problem { file, what } in &self.problems {
            say(&format!("  {file}: {what}"));
        }
    }
}
