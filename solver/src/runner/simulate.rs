//! A case is run with all who see it, and all that may ask for its end.

use std::path::PathBuf;

use super::signal::SignalWatch;
use super::stop_file::StopFile;
use super::threads;
use super::wall_limit::WallLimit;
use crate::case::{Model, Recording};
use crate::observer::{self, History, RunDirectory, Shown, WriteTimes};
use crate::run::{self, Dimension, RunError, RunSummary, SavedState, Solve};

/// How a case is run into a directory.
#[derive(Debug)]
pub struct RunInto<'a> {
    /// Where its files go.
    pub directory: &'a RunDirectory,
    /// What is shown of it.
    pub shown: Shown,
    /// What may ask for its end.
    pub watch: SignalWatch,
    /// Its time on the clock, if that is limited.
    pub limit: Option<WallLimit>,
}

/// What a run resumes from.
#[derive(Debug)]
pub struct Resumed<const D: usize> {
    /// Everything that evolves.
    pub state: SavedState<D>,
    /// What was written up to there, if the state lies in a run.
    pub history: Option<History>,
    /// Whether the run continues in its own directory.
    pub is_in_place: bool,
    /// Where the state lies.
    pub from: PathBuf,
}

/// Runs a case of any dimension without files.
pub fn simulate(model: &Model, watch: SignalWatch) -> Result<RunSummary, RunError> {
    threads::within(|| match model.case.geometry.dimensions() {
        2 => run::simulate::<2>(model, &mut [Box::new(watch)]),
        _ => run::simulate::<3>(model, &mut [Box::new(watch)]),
    })
}

/// Runs a case of any dimension from its beginning.
pub fn simulate_afresh(model: &Model, run: RunInto<'_>) -> Result<RunSummary, RunError> {
    match model.case.geometry.dimensions() {
        2 => simulate_into::<2>(model, None, None, run),
        _ => simulate_into::<3>(model, None, None, run),
    }
}

/// Runs a case, from a saved state if there is one, and with what is recorded if it repeats a session.
pub fn simulate_into<const D: usize>(
    model: &Model,
    resumed: Option<&Resumed<D>>,
    recording: Option<&Recording>,
    run: RunInto<'_>,
) -> Result<RunSummary, RunError>
where
    Dimension<D>: Solve<D>,
{
    threads::within(|| {
        let history = resumed.and_then(|resumed| resumed.history.as_ref());
        let writes = WriteTimes::after(history.and_then(|history| history.longest_checkpoint));
        let mut observers = observer::observers(model, run.directory, history, run.shown, &writes)?;
        observers.push(Box::new(run.watch));
        if let Some(limit) = run.limit {
            observers.push(Box::new(limit.learning_from(&writes)));
        }
        observers.push(Box::new(StopFile::new(run.directory.path())));
        let start = run::Start { saved: resumed.map(|resumed| &resumed.state), recording };
        run::replay(model, start, &mut observers)
    })
}
