//! What a person sees of runs: progress on the terminal, and the log there and in `log.jsonl`.

mod log;
mod progress;
mod tally;
mod terminal;

pub use log::start_log;
pub use progress::Progress;
pub use tally::Tally;
pub use terminal::{columns_of, print_line};
