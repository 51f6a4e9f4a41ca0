//! `RunPlan`: a run that is asked for, by whomever; `Outcome`: what became of it.

use std::path::PathBuf;

use crate::case::{CaseFile, Diagnostic, WallTime};
use crate::observer::RunLock;
use crate::run::RunSummary;
use crate::validation::Comparison;

/// A run that is asked for.
#[derive(Debug)]
pub struct RunPlan {
    /// The case, which has been checked.
    pub file: CaseFile,
    /// What is odd in it.
    pub warnings: Vec<Diagnostic>,
    /// The directory of the run.
    pub out: PathBuf,
    /// That, where it is held already.
    pub lock: Option<RunLock>,
    /// Threads; those the batch system or the machine grants if absent.
    pub threads: Option<usize>,
    /// A state to continue from, or a run that holds one.
    pub resume: Option<PathBuf>,
    /// What is asked for while it goes on, if it repeats a session: a `commands.csv`.
    pub replay: Option<PathBuf>,
    /// Whether a finished run continues where its case ends later now.
    pub continues: bool,
    /// Whether a run that is in the directory is replaced, and not continued.
    pub overwrite: bool,
    /// Its time on the clock; that of the batch job if absent.
    pub max_walltime: Option<WallTime>,
    /// Where viewers connect to.
    pub live: Option<String>,
    /// Origins of web pages that may look on, besides those of this machine.
    pub live_origins: Vec<String>,
    /// Whether it is compared with the references of its case.
    pub compares: bool,
    /// Whether there is no progress on the terminal.
    pub quiet: bool,
    /// How much more than warnings the log says on the terminal.
    pub verbose: u8,
}

impl RunPlan {
    /// A run from its first step, or from the latest checkpoint in its directory.
    #[must_use]
    pub fn new(file: CaseFile, out: PathBuf) -> Self {
        Self {
            file,
            warnings: Vec::new(),
            out,
            lock: None,
            threads: None,
            resume: None,
            replay: None,
            continues: false,
            overwrite: false,
            max_walltime: None,
            live: None,
            live_origins: Vec::new(),
            compares: true,
            quiet: false,
            verbose: 0,
        }
    }
}

/// What became of a run that did not fail.
#[derive(Debug)]
pub enum Outcome {
    /// It came to its end.
    Finished(Box<Finished>),
    /// It had come to its end before.
    WasFinished,
    /// It was stopped on its way.
    Stopped(Stopped),
}

/// A run that came to its end.
#[derive(Debug)]
pub struct Finished {
    /// What it came to.
    pub summary: RunSummary,
    /// How it compares with the references of its case.
    pub comparisons: Vec<Comparison>,
    /// Steps made before this process.
    pub steps_before: usize,
    /// Seconds on the clock that it took.
    pub wall: f64,
}

/// A run that was stopped on its way.
#[derive(Debug)]
pub struct Stopped {
    /// Where, and why as far as that is known.
    pub reason: String,
    /// Whether it left a state to continue from.
    pub has_state: bool,
}
