//! Sees everything, changes nothing: files, progress, log.
//!
//! A run writes one directory:
//!
//! | File | What it holds | When it is written |
//! |---|---|---|
//! | `case.toml` | The case as it is run, all defaults filled in | at the start |
//! | `bodies.json` | Swimmers and their bodies, joints, gaits | at the start |
//! | `provenance.json` | Which program ran it, where and how, in which legs | at the start and at the end |
//! | `status.json` | State, step, time, cost of each stage | every second and at the end |
//! | `log.jsonl` | Log, one JSON object a line | as it happens |
//! | `series.csv` | One row a step | flushed every second |
//! | `run.mcap` | Bodies and quantities as messages | flushed every few steps |
//! | `fields/*.vtu`, `fields.pvd` | Velocity, pressure, vorticity | whole files only |
//! | `checkpoints/*.state` | States to resume from | every ten minutes and at the end |
//! | `comparison.json` | Computed against references, by the command line | at the end |
//! | `lock` | Held while the run is under way | – |

mod console;
mod files;
mod live;
mod message_file;
mod run_directory;
mod schedule;
mod system;
#[cfg(test)]
mod tests;

use crate::case::Model;
use crate::run::{Dimension, Observer, Solve};
use run_directory::write_bodies;

pub use console::{Progress, Tally, columns_of, start_log};
pub use files::{
    Checkpoint, CheckpointFiles, FieldFiles, SeriesFile, field_file_size, latest_checkpoint,
    read_state, state_size,
};
pub use live::LiveServer;
pub use message_file::MessageFile;
pub use run_directory::{
    COMPARISON_FILE, Earlier, FAILURE_FOLDER, FAILURE_STATE, History, Leg, LegFile, LockError,
    MESH_SIZE_FILE, Origin, Point, Provenance, Restarts, RunDirectory, RunDirectoryError, RunLock,
    RunState, STOP, Start, Status, StatusFile, WriteTimes, checkpoints, executable, read_outcome,
    read_series, run_of_state,
};
pub use system::process::{peak_memory, reset_peak_memory};
pub use system::{UNFINISHED, directory_of, write_atomic};

/// What is shown of a run while it is under way.
#[derive(Debug, Default)]
pub struct Shown {
    /// Whether there is no progress on the terminal.
    pub quiet: bool,
    /// Whom viewers connect to.
    pub live: Option<LiveServer>,
}

/// All observers of a run in `directory`, which goes on after a `history` if there is one. What states take to write is told in `times`.
///
/// Make them before the mesh is generated: `status.json` shows the run from then on, and they are
/// notified if the simulation cannot be built.
///
/// # Errors
/// When a file cannot be made.
pub fn observers<const D: usize>(
    model: &Model,
    directory: &RunDirectory,
    history: Option<&History>,
    shown: Shown,
    times: &WriteTimes,
) -> std::io::Result<Vec<Box<dyn Observer<D>>>>
where
    Dimension<D>: Solve<D>,
{
    let case = &model.case;
    write_bodies(directory.path(), model)?;
    let checkpoints = CheckpointFiles::create(directory.path(), case, history, times.clone())?;
    let mut everyone: Vec<Box<dyn Observer<D>>> = vec![
        Box::new(SeriesFile::create(directory.path(), case, history)?),
        Box::new(MessageFile::create(directory, model, history, shown.live)?),
        Box::new(FieldFiles::new(directory, case, history)),
        // After those whose rows and messages belong to a state
        Box::new(checkpoints),
        Box::new(LegFile::new(directory, history)),
    ];
    if !shown.quiet {
        everyone.push(Box::new(Progress::new(model)));
    }
    // The status comes last: when it says `finished`, all other files are complete.
    everyone.push(Box::new(StatusFile::create(directory.path(), case, history, times.clone())?));
    Ok(everyone)
}
