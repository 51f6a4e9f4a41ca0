//! The directory of a run: who holds it, what it says of the run and of its past, and how that is read back.

mod beginning;
mod bodies;
pub(super) mod checkpoint_list;
mod legs;
mod lock_reach;
mod marker;
mod motion_record;
mod provenance;
mod read_back;
mod restarts;
#[expect(clippy::module_inception, reason = "the directory itself is what the room is named after")]
mod run_directory;
mod run_directory_error;
mod run_lock;
mod status;
mod write_times;

pub(super) use bodies::{joint_ends, write_bodies};
pub use checkpoint_list::checkpoints;
pub use legs::LegFile;
pub use motion_record::MotionRecord;
pub use provenance::{Leg, Origin, Point, Provenance, checksum, executable};
pub(super) use read_back::SERIES_FILE;
pub use read_back::{Frame, History, frames, read_outcome, read_series};
pub use restarts::Restarts;
pub use run_directory::{
    COMPARISON_FILE, Earlier, FAILURE_FOLDER, FAILURE_STATE, MESH_SIZE_FILE, RunDirectory, STOP,
    Start, run_of_state,
};
pub(super) use run_directory::{FAILURE_FLOW, remove_failure};
pub use run_directory_error::RunDirectoryError;
pub use run_lock::{LOCK_FILE, LockError, RunLock};
pub use status::{Motion, RunState, Status, StatusFile};
pub use write_times::WriteTimes;
