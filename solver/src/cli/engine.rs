//! The one place where the command line meets mesh and solver.

use std::path::Path;

use alewife_mesh::{Mesh, Quality};

use super::signal::{SignalWatch, outlive_file_size_limit};
use crate::case::{Model, TimeSettings};
use crate::observer::{self, History, RunDirectory};
use crate::simulation::{self, Resume, RunError, RunSummary, SavedState};

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
}

/// Runs a case, from a saved state if there is one, with its files in `directory`; with `quiet`,
/// without progress on the terminal.
pub fn simulate_into(
    model: &Model,
    resumed: Option<&Resumed>,
    directory: &RunDirectory,
    quiet: bool,
) -> Result<RunSummary, RunError> {
    outlive_file_size_limit()?;
    let history = resumed.and_then(|resumed| resumed.history.as_ref());
    let mut observers = observer::observers(model, directory, history, quiet)?;
    // Newton's method is not left halfway: a steady run ends by the signal itself.
    if matches!(model.case.time, TimeSettings::Unsteady(_)) {
        observers.push(Box::new(SignalWatch::start()?));
    }
    let resume = resumed.map(|resumed| Resume {
        state: &resumed.state,
        series: history.map(|history| &history.series),
    });
    simulation::simulate_from(model, resume.as_ref(), &mut observers)
}

/// Starts the log: to standard error, and to `log.jsonl` of a run.
pub fn start_log(directory: Option<&Path>, verbosity: i8) -> std::io::Result<()> {
    observer::start_log(directory, verbosity)
}
