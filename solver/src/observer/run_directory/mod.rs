//! The directory of a run: who holds it, what it says of the run and of its past, and how that is read back.

mod beginning;
mod bodies;
pub(super) mod checkpoint_list;
mod history;
mod kept;
mod legs;
mod lock_reach;
mod marker;
mod provenance;
mod restarts;
#[expect(clippy::module_inception, reason = "the directory itself is what the room is named after")]
mod run_directory;
mod run_directory_error;
mod run_lock;
mod series_rows;
mod status;
mod write_times;

pub(super) use bodies::{joint_ends, write_bodies};
pub use checkpoint_list::checkpoints;
pub use history::{Frame, History, frames};
pub use kept::read_outcome;
pub use legs::LegFile;
pub use provenance::{Leg, Origin, Point, Provenance, checksum, executable};
pub use restarts::Restarts;
pub use run_directory::{
    COMPARISON_FILE, Earlier, FAILURE_FOLDER, FAILURE_STATE, MESH_SIZE_FILE, RunDirectory, STOP,
    Start, run_of_state,
};
pub(super) use run_directory::{FAILURE_FLOW, remove_failure};
pub use run_directory_error::RunDirectoryError;
pub use run_lock::{LOCK_FILE, LockError, RunLock};
pub(super) use series_rows::SERIES_FILE;
pub use series_rows::read_series;
pub use status::{RunState, Status, StatusFile};
pub use write_times::WriteTimes;
