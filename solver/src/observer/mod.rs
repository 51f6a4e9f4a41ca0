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

mod atomic;
mod bodies;
mod checkpoint_list;
mod checkpoints;
mod csv;
mod drawing;
mod fields;
mod foxglove;
mod history;
mod kept;
mod legs;
mod live;
mod live_client;
mod live_hub;
mod log;
mod mcap;
mod messages;
mod primitives;
mod process;
mod progress;
mod provenance;
mod quantities;
mod removal;
mod restarts;
mod run_directory;
mod run_directory_error;
mod run_lock;
mod scene;
mod schedule;
mod series_rows;
mod solids;
mod state_file;
mod status;
mod tally;
mod terminal;
#[cfg(test)]
mod tests;
mod write_times;

use self::bodies::write_bodies;
use crate::case::Model;
use crate::run::{Dimension, Observer, Solve};

pub use atomic::{UNFINISHED, directory_of, write_atomic};
pub use checkpoint_list::checkpoints;
pub use checkpoints::{Checkpoint, CheckpointFiles, latest_checkpoint};
pub use csv::SeriesFile;
pub use fields::{FieldFiles, field_file_size};
pub use history::History;
pub use kept::read_outcome;
pub use legs::LegFile;
pub use live::LiveServer;
pub use log::start_log;
pub use mcap::MessageFile;
pub use process::{peak_memory, reset_peak_memory};
pub use progress::Progress;
pub use provenance::{Leg, Origin, Point, Provenance, executable};
pub use restarts::Restarts;
pub use run_directory::{
    COMPARISON_FILE, Earlier, FAILURE_FOLDER, FAILURE_STATE, MESH_SIZE_FILE, RunDirectory, STOP,
    Start, run_of_state,
};
pub use run_directory_error::RunDirectoryError;
pub use run_lock::{LockError, RunLock};
pub use series_rows::read_series;
pub use state_file::{read_state, state_size};
pub use status::{RunState, Status, StatusFile};
pub use tally::Tally;
pub use terminal::columns_of;
pub use write_times::WriteTimes;

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
