//! The files a run writes on its way: rows, fields, and states to resume from.

mod checkpoints;
mod commands;
mod csv;
mod fields;
mod state_file;
mod tracers;

pub use checkpoints::{Checkpoint, CheckpointFiles, latest_checkpoint};
pub use commands::CommandsFile;
pub use csv::SeriesFile;
pub use fields::{FieldFiles, field_file_size};
pub use state_file::{read_state, state_size, write_state as write_state_file};
pub use tracers::TracerFiles;
