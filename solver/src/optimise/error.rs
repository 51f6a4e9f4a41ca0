//! `OptimiseError`: why a search of a flow or a reduced motion does not begin.

use alewife_reduced::search::SearchError;
use thiserror::Error;

use crate::case::CaseError;
use crate::gradient::GradientError;
use crate::reduced::ReducedError;

/// Why a search of a flow or a reduced motion does not begin.
#[derive(Debug, Error)]
pub enum OptimiseError {
    /// The case has no search, or one that cannot be made.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// There is no flow at the start, or no gradient.
    #[error(transparent)]
    Gradient(#[from] GradientError),
    /// There is no reduced motion.
    #[error(transparent)]
    Model(#[from] ReducedError),
    /// The search itself.
    #[error(transparent)]
    Search(#[from] SearchError),
}
