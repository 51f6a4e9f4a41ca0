//! `run`: one case, from where it begins or continues to what comes out.

mod fidelity;
mod reduced;
mod results;
#[expect(clippy::module_inception, reason = "the command itself is what the room is named after")]
mod run;

pub use results::print_comparisons;
pub use run::{Options, command, run, run_plan};
