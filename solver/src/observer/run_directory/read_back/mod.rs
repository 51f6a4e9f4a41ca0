//! What a run wrote, read back from its directory: its rows, its past for the run that resumes it, its outcome.

mod history;
mod kept;
mod series_rows;

pub use history::{Frame, History, frames};
pub use kept::read_outcome;
pub(in crate::observer) use series_rows::SERIES_FILE;
pub use series_rows::read_series;
