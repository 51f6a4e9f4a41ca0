//! `ReducedError`: why a reduced model could not be made or moved.

use alewife_reduced::tree::TreeError;
use thiserror::Error;

/// What went wrong.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ReducedError {
    /// The case has what no reduced model knows; `check_reduced` has it with its key.
    #[error("the reduced model does not know {0}")]
    Unknown(String),
    /// A step failed.
    #[error(transparent)]
    Tree(#[from] TreeError),
}
