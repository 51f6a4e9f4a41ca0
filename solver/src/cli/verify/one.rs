//! A run, by the model it was made with.

use std::path::Path;

use super::found::Found;
use super::{motion, run};
use crate::observer::Status;

/// Looks at the run in a directory.
pub fn verify(directory: &Path) -> Found {
    let model = Status::read(directory).ok().and_then(|status| status.fidelity);
    model.map_or_else(|| run::verify(directory), |model| motion::verify(directory, &model))
}
