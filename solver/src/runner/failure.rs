//! `Failure`: why something was not done, and `Exit`, the codes the program ends with, after sysexits.

use std::io;
use std::process::ExitCode;

use crate::case::{CaseError, Diagnostic, Severity};
use crate::observer::{LockError, RunDirectoryError};
use crate::run::RunError;
use crate::step::FlowError;

/// Errors, and warnings, that are listed at once.
const MOST_DIAGNOSTICS: usize = 20;

/// What became of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Exit {
    /// Done.
    Done = 0,
    /// The command line is invalid.
    Usage = 2,
    /// The solver diverged.
    Diverged = 10,
    /// The mesh could not be made.
    Mesh = 11,
    /// A result is outside its tolerance.
    OutsideTolerance = 20,
    /// The case is wrong.
    BadCase = 65,
    /// There is no such case.
    NoInput = 66,
    /// A bug in the program.
    Bug = 70,
    /// Memory has run out.
    OutOfMemory = 71,
    /// A file could not be read or written.
    InputOutput = 74,
    /// The run was stopped, and continues when it is run again.
    Stopped = 75,
    /// It was restarted again and again without a step.
    NoProgress = 76,
    /// Another process has the point of a sweep; said to the process of the sweep alone.
    InUse = 77,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit as u8)
    }
}

/// Why the program did not do what it was asked for.
#[derive(Debug)]
pub struct Failure {
    /// Code to end with.
    pub exit: Exit,
    /// What is printed.
    pub message: String,
}

impl Failure {
    /// A failure printed as `error: ...`.
    pub fn new(exit: Exit, message: impl AsRef<str>) -> Self {
        Self { exit, message: format!("error: {}", message.as_ref()) }
    }

    /// The same, below the name of the case that it is about.
    pub fn of(self, case: &str) -> Self {
        Self { message: format!("{case}:\n{}", self.message), ..self }
    }

    /// Several failures as one, which ends with the code of the first; none if there are none.
    pub fn all(failures: Vec<Self>) -> Option<Self> {
        let exit = failures.first()?.exit;
        let messages: Vec<String> = failures.into_iter().map(|failure| failure.message).collect();
        Some(Self { exit, message: messages.join("\n\n") })
    }

    /// A case that is wrong, with all its diagnostics.
    pub fn wrong(diagnostics: &[Diagnostic]) -> Self {
        Self { exit: Exit::BadCase, message: listing(diagnostics) }
    }
}

/// Diagnostics one below the other, errors first; of many of a kind the first ones.
pub fn listing(found: &[Diagnostic]) -> String {
    let mut texts = Vec::new();
    for (severity, many) in [(Severity::Error, "errors"), (Severity::Warning, "warnings")] {
        let of_kind = || found.iter().filter(|one| one.severity == severity);
        texts.extend(of_kind().take(MOST_DIAGNOSTICS).map(ToString::to_string));
        let n = of_kind().count();
        if n > MOST_DIAGNOSTICS {
            texts.push(format!("... and {} more {many}", n - MOST_DIAGNOSTICS));
        }
    }
    texts.join("\n\n")
}

impl From<CaseError> for Failure {
    fn from(error: CaseError) -> Self {
        match error {
            CaseError::Wrong(diagnostics) => Self::wrong(&diagnostics),
            CaseError::NotFound { .. } => Self::new(Exit::NoInput, error.to_string()),
            CaseError::Elsewhere(what) => Self { exit: Exit::NoInput, message: what.to_string() },
            CaseError::Unreadable { .. } => Self::new(Exit::InputOutput, error.to_string()),
        }
    }
}

/// The code a stopped run ends with.
pub fn exit_of(error: &RunError) -> Exit {
    match error {
        RunError::Flow(error) => match error {
            FlowError::NewtonStalled { .. }
            | FlowError::NotFinite { .. }
            | FlowError::Singular { .. } => Exit::Diverged,
            FlowError::Shape(_) => Exit::BadCase,
            FlowError::MeshMotion(_) => Exit::Mesh,
            FlowError::Stopped { .. } => Exit::Stopped,
        },
        RunError::StepSizeUnderflow { .. }
        | RunError::Contact { .. }
        | RunError::MeetsItself { .. }
        | RunError::BlownUp { .. } => Exit::Diverged,
        RunError::Unsupported(_)
        | RunError::Resume(_)
        | RunError::Command(_)
        | RunError::Waits { .. }
        | RunError::TooLarge { .. }
        | RunError::BeyondMaxCells { .. }
        | RunError::TooManyCells { .. }
        | RunError::NotFinite { .. } => Exit::BadCase,
        RunError::Mesh(_) | RunError::Remesh { .. } | RunError::MeshTooLarge { .. } => Exit::Mesh,
        RunError::Session(_) => Exit::Usage,
        RunError::Output(_) => Exit::InputOutput,
    }
}

/// What helps where a file could not be written.
fn remedy(error: &RunError) -> &'static str {
    use io::ErrorKind::{FileTooLarge, PermissionDenied, QuotaExceeded, StorageFull};
    match error {
        RunError::Output(error) => match error.kind() {
            StorageFull | QuotaExceeded | FileTooLarge => {
                "; make space and run it again: it continues from its latest checkpoint, or begins again where \
                 there is none"
            }
            PermissionDenied => "; give yourself the right to write there, and run it again",
            _ => "",
        },
        _ => "",
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        let exit = exit_of(&error);
        let message = format!("{error}{}", remedy(&error));
        // Who stops a run makes no error
        if exit == Exit::Stopped { Self { exit, message } } else { Self::new(exit, message) }
    }
}

impl From<RunDirectoryError> for Failure {
    fn from(error: RunDirectoryError) -> Self {
        let exit = match error {
            RunDirectoryError::Finished { .. }
            | RunDirectoryError::Resumable { .. }
            | RunDirectoryError::NotADirectory { .. }
            | RunDirectoryError::Lock(LockError::NotALock { .. })
            | RunDirectoryError::NotARun { .. } => Exit::Usage,
            _ => Exit::InputOutput,
        };
        Self::new(exit, error.to_string())
    }
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        Self::new(Exit::InputOutput, error.to_string())
    }
}
