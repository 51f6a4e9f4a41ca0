//! The one place where the command line meets mesh and solver.

use std::path::Path;

use alewife_mesh::{Mesh, Quality};

use super::signal::SignalWatch;
use crate::case::Model;
use crate::observer::{self, History, RunDirectory};
use crate::simulation::{self, RunError, RunSummary, SavedState};

/// The mesh of a case.
pub fn build_mesh(model: &Model) -> Result<Mesh<2>, RunError> {
    simulation::build_mesh(model)
}

/// How good a mesh is.
pub fn mesh_quality(mesh: &Mesh<2>) -> Quality<2> {
    simulation::mesh_quality(mesh)
}

/// Runs a case without observers.
pub fn simulate(model: &Model) -> Result<RunSummary, RunError> {
    simulation::simulate(model, &mut [])
}

/// What a run resumes from.
#[derive(Debug)]
pub struct Resumed {
    /// Everything that evolves.
    pub state: SavedState<2>,
    /// What was written up to there, if the state lies in a run.
    pub history: Option<History>,
    /// Whether the run goes on in its own directory.
    pub is_in_place: bool,
}

/// Runs a case, from a saved state if there is one, with its files in `directory`; with `quiet`,
/// without progress on the terminal.
pub fn simulate_into(
    model: &Model,
    resumed: Option<&Resumed>,
    directory: &RunDirectory,
    quiet: bool,
) -> Result<RunSummary, RunError> {
    let history = resumed.and_then(|resumed| resumed.history.as_ref());
    let mut observers = observer::observers(model, directory, history, quiet)?;
    observers.push(Box::new(SignalWatch::start()?));
    simulation::simulate_from(model, resumed.map(|resumed| &resumed.state), &mut observers)
}

/// Starts the log: to standard error, and to `log.jsonl` of a run.
pub fn start_log(directory: Option<&Path>, verbosity: i8) -> std::io::Result<()> {
    observer::start_log(directory, verbosity)
}
