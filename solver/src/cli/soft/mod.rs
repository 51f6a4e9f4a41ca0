//! Soft cases on the command line: `run --fidelity soft`, `check`, `show`, `calibrate`, `optimise`, `loop`.

mod calibrate;
mod check;
mod directory;
mod rounds;
mod run;
mod search;

pub use calibrate::calibrate;
pub use check::{check, show};
pub use directory::{hold, not_written, prepare};
pub use rounds::{LoopOptions, rounds};
pub use run::{Place, run};
pub use search::{SearchOptions, progress_line, search_failure, seek};

use alewife_reduced::tier::TierError;

use super::exit::{Exit, Failure};

impl From<TierError> for Failure {
    fn from(error: TierError) -> Self {
        match error {
            TierError::Case(diagnostics) => Self::wrong(&diagnostics),
            TierError::Soft(error) => Self::new(
                Exit::Diverged,
                format!("{error}; shorter steps (more soft.substeps) or softer fibres may help"),
            ),
        }
    }
}
