//! Sessions with the files of a run, or without any: from a checked case to a `Session`.

use std::path::{Path, PathBuf};

use super::blamed_key::with_key;
use super::failure::{Exit, Failure, listing};
use super::resume::read_resumed;
use super::simulate::Resumed;
use crate::case::{Case, CaseFile, Diagnostic, Severity, check, check_flow};
use crate::observer::{
    self, Earlier, Point, RunDirectory, Shown, Start, WriteTimes, write_state_file,
};
use crate::run::{Dimension, SavedState, Session, Solve};

/// A session that is asked for.
#[derive(Debug)]
pub struct SessionPlan {
    /// The case, which has been checked.
    pub file: CaseFile,
    /// The directory of its files; none are written if absent.
    pub out: Option<PathBuf>,
    /// A state to continue from, or a run that holds one.
    pub resume: Option<PathBuf>,
    /// Whether a run that is in the directory is replaced.
    pub overwrite: bool,
    /// Threads it uses, for its records.
    pub threads: usize,
}

/// A case that has been checked.
#[derive(Debug)]
pub struct Checked {
    /// The case.
    pub file: CaseFile,
    /// What is odd in it.
    pub warnings: Vec<Diagnostic>,
}

/// Reads and checks a case.
///
/// # Errors
/// All that is wrong with it.
pub fn checked(case: &str, settings: &[String]) -> Result<Checked, Failure> {
    let file = Case::read(case, settings)?;
    let found = check(&file);
    let (errors, warnings): (Vec<_>, Vec<_>) =
        found.into_iter().partition(|one| one.severity == Severity::Error);
    if errors.is_empty() {
        Ok(Checked { file, warnings })
    } else {
        Err(Failure { exit: Exit::BadCase, message: listing(&errors) })
    }
}

/// Opens a session.
///
/// # Errors
/// Whatever keeps a run from its beginning.
pub fn session<const D: usize>(plan: &SessionPlan) -> Result<Session<D>, Failure>
where
    Dimension<D>: Solve<D>,
{
    let SessionPlan { file, out, resume, .. } = plan;
    let missing = check_flow(file);
    if !missing.is_empty() {
        return Err(Failure { exit: Exit::BadCase, message: listing(&missing) });
    }
    let place = out.as_deref().unwrap_or(Path::new(""));
    let resumed: Option<Resumed<D>> =
        resume.as_deref().map(|path| read_resumed(path, file.case(), place)).transpose()?;
    let state = resumed.as_ref().map(|resumed| &resumed.state);
    let observers = match out {
        None => Vec::new(),
        Some(out) => observers(plan, out, resumed.as_ref())?,
    };
    let opened = match state {
        None => Session::open(&file.model, observers),
        Some(state) => Session::resume(&file.model, state, observers),
    };
    opened.map_err(|error| with_key(file, error))
}

fn observers<const D: usize>(
    plan: &SessionPlan,
    out: &Path,
    resumed: Option<&Resumed<D>>,
) -> Result<Vec<Box<dyn crate::run::Observer<D>>>, Failure>
where
    Dimension<D>: Solve<D>,
{
    let earlier = match resumed {
        Some(resumed) if resumed.is_in_place => Earlier::Continue,
        _ if plan.overwrite => Earlier::Replace,
        _ => Earlier::Keep,
    };
    let from = resumed.map_or(Point::default(), |resumed| Point {
        step: resumed.state.step(),
        time: resumed.state.time(),
    });
    let start = Start { threads: plan.threads, from, lock: None };
    let directory = RunDirectory::create(out, plan.file.case(), start, earlier)?;
    let history = resumed.and_then(|resumed| resumed.history.as_ref());
    let times = WriteTimes::after(history.and_then(|history| history.longest_checkpoint));
    let shown = Shown { quiet: true, live: None };
    let mut all = observer::observers(&plan.file.model, &directory, history, shown, &times)?;
    all.push(Box::new(Held { _directory: directory }));
    Ok(all)
}

/// Holds a directory as long as a session.
struct Held {
    _directory: RunDirectory,
}

impl<const D: usize> crate::run::Observer<D> for Held {
    fn on_step(&mut self, _snapshot: &crate::run::Snapshot<'_, D>) -> std::io::Result<()> {
        Ok(())
    }
}

/// Writes a state to a file, from which runs and sessions continue.
///
/// # Errors
/// When the file system refuses.
pub fn write_state<const D: usize>(path: &Path, state: &SavedState<D>) -> Result<(), Failure> {
    write_state_file(path, state)?;
    Ok(())
}
