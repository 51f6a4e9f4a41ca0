//! Sees everything, changes nothing: files, progress, log.
//!
//! A run writes one directory:
//!
//! | File | What it holds | When it is written |
//! |---|---|---|
//! | `case.toml` | The case as it is run, all defaults filled in | at the start |
//! | `bodies.json` | Swimmers and their bodies, joints, gaits | at the start |
//! | `provenance.json` | Which program ran it, where and how, in which legs | at the start and at the end |
//! | `status.json` | State, step, time, cost of each stage, warnings | every second and at the end |
//! | `log.jsonl` | Log, one JSON object a line | as it happens |
//! | `series.csv` | One row a step | flushed every second |
//! | `run.mcap` | Bodies and quantities as messages | flushed every few steps |
//! | `fields/*.vtu`, `fields.pvd` | Velocity, pressure, vorticity | whole files only |
//! | `tracers/*.vtu`, `tracers.pvd` | Particles of `[[tracer]]` | whole files only |
//! | `checkpoints/*.state` | States to resume from | every ten minutes and at the end |
//! | `comparison.json` | Computed against references, by the command line | at the end |
//! | `lock` | Held while the run is under way | – |

mod console;
mod files;
mod live;
mod message_file;
mod observers;
mod run_directory;
mod schedule;
mod system;
#[cfg(test)]
mod tests;
mod warnings;

pub use console::{Progress, Tally, columns_of, print_line, start_log};
pub use files::{
    Checkpoint, CheckpointFiles, FieldFiles, SeriesFile, field_file_size, latest_checkpoint,
    read_state, state_size, write_state_file,
};
pub use live::LiveServer;
pub use message_file::{MessageFile, MessageSummary, read_messages};
pub use observers::{Shown, observers};
pub use run_directory::{
    COMPARISON_FILE, Earlier, FAILURE_FOLDER, FAILURE_STATE, Frame, History, LOCK_FILE, Leg,
    LegFile, LockError, MESH_SIZE_FILE, Motion, MotionRecord, Origin, Point, Provenance, Restarts,
    RunDirectory, RunDirectoryError, RunLock, RunState, STOP, Start, Status, StatusFile,
    WriteTimes, checkpoints, checksum, executable, frames, read_outcome, read_series, run_of_state,
};
pub use system::process::{peak_memory, reset_peak_memory};
pub use system::{UNFINISHED, directory_of, remove_if_there, write_atomic};
pub use warnings::{Warning, begin_warnings, continue_warnings, warnings};
