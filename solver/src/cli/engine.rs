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

/// Runs a case without files.
pub fn simulate(model: &Model, watch: SignalWatch) -> Result<RunSummary, RunError> {
    simulation::simulate(model, &mut [Box::new(watch)])
}

/// How a case is run into a directory.
#[derive(Debug)]
pub struct RunInto<'a> {
    /// Where its files go.
    pub directory: &'a RunDirectory,
    /// Whether there is no progress on the terminal.
    pub quiet: bool,
    /// What may ask for its end.
    pub watch: SignalWatch,
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

/// Runs a case, from a saved state if there is one.
pub fn simulate_into(
    model: &Model,
    resumed: Option<&Resumed>,
    run: RunInto<'_>,
) -> Result<RunSummary, RunError> {
    let history = resumed.and_then(|resumed| resumed.history.as_ref());
    let mut observers = observer::observers(model, run.directory, history, run.quiet)?;
    observers.push(Box::new(run.watch));
    simulation::simulate_from(model, resumed.map(|resumed| &resumed.state), &mut observers)
}

/// Starts the log: to standard error, and to `log.jsonl` of a run.
pub fn start_log(directory: Option<&Path>, verbosity: i8) -> std::io::Result<()> {
    observer::start_log(directory, verbosity)
}
