//! The one place where the command line meets mesh and solver.

use std::path::Path;

use alewife_mesh::Mesh;

use super::signal::SignalWatch;
use crate::case::Model;
use crate::observer::{self, History, RunDirectory};
use crate::simulation::{self, Dimension, RunError, RunSummary, SavedState, Solve};

/// The mesh of a case.
pub fn build_mesh<const D: usize>(model: &Model) -> Result<Mesh<D>, RunError>
where
    Dimension<D>: Solve<D>,
{
    simulation::build_mesh(model)
}

/// What a run resumes from.
#[derive(Debug)]
pub struct Resumed<const D: usize> {
    /// Everything that evolves.
    pub state: SavedState<D>,
    /// What was written up to there, if the state lies in a run.
    pub history: Option<History>,
    /// Whether the run goes on in its own directory.
    pub is_in_place: bool,
}

/// Runs a case of any dimension from its beginning, with its files in `directory` if there is one.
pub fn simulate(model: &Model, directory: Option<&RunDirectory>) -> Result<RunSummary, RunError> {
    match (model.case.geometry.dimensions(), directory) {
        (2, Some(directory)) => simulate_into::<2>(model, None, directory, true),
        (2, None) => simulation::simulate::<2>(model, &mut []),
        (_, Some(directory)) => simulate_into::<3>(model, None, directory, true),
        (_, None) => simulation::simulate::<3>(model, &mut []),
    }
}

/// Runs a case, from a saved state if there is one, with its files in `directory`; with `quiet`,
/// without progress on the terminal.
pub fn simulate_into<const D: usize>(
    model: &Model,
    resumed: Option<&Resumed<D>>,
    directory: &RunDirectory,
    quiet: bool,
) -> Result<RunSummary, RunError>
where
    Dimension<D>: Solve<D>,
{
    let history = resumed.and_then(|resumed| resumed.history.as_ref());
    let mut observers = observer::observers(model, directory, history, quiet)?;
    observers.push(Box::new(SignalWatch::start()?));
    simulation::simulate_from(model, resumed.map(|resumed| &resumed.state), &mut observers)
}

/// Starts the log: to standard error, and to `log.jsonl` of a run.
pub fn start_log(directory: Option<&Path>, verbosity: i8) -> std::io::Result<()> {
    observer::start_log(directory, verbosity)
}
