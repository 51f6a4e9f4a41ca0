//! Failures of sweeps, beside those of runs.

use crate::observer::LockError;
use crate::sweep::SweepDirectoryError;

pub use crate::runner::{Exit, Failure};

impl From<SweepDirectoryError> for Failure {
    fn from(error: SweepDirectoryError) -> Self {
        let exit = match error {
            SweepDirectoryError::Case(error) => return error.into(),
            SweepDirectoryError::NotASweep { .. }
            | SweepDirectoryError::Lock(LockError::NotALock { .. }) => Exit::Usage,
            SweepDirectoryError::None { .. } => Exit::NoInput,
            SweepDirectoryError::Other { .. } | SweepDirectoryError::Damaged { .. } => {
                Exit::BadCase
            }
            SweepDirectoryError::Lock(_) | SweepDirectoryError::Io(_) => Exit::InputOutput,
        };
        Self::new(exit, error.to_string())
    }
}
