//! From the plan of a run to its outcome: where it begins, what may ask for its end, what came out.

mod blamed_key;
mod continuation;
mod failure;
mod live;
mod pipeline;
mod plan;
mod replay;
mod resume;
mod session;
mod signal;
mod simulate;
mod stop_file;
pub mod threads;
mod wall_limit;

pub use blamed_key::with_key;
pub use failure::{Exit, Failure, listing};
pub use live::DEFAULT_ADDRESS;
pub use pipeline::{run, write_comparisons};
pub use plan::{Finished, Outcome, RunPlan, Stopped};
pub use replay::recording;
pub use session::{Checked, SessionPlan, checked, session, write_state};
pub use signal::{SignalWatch, end_aborted_with, ended_by_signal, outlive_file_size_limit};
pub use simulate::{RunInto, simulate, simulate_afresh};
pub use wall_limit::WallLimit;
