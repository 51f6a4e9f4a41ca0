//! `run`: one case, from where it begins or continues to what comes out.

mod continuation;
mod live;
mod results;
#[expect(clippy::module_inception, reason = "the command itself is what the room is named after")]
mod run;
mod typed;

pub use results::print_comparisons;
pub use run::{Options, PointRun, run, run_file};
pub use typed::quoted;
