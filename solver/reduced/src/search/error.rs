//! `SearchError`: why a search does not begin, or cannot be taken up again.

use alewife_interrupt::Stopped;
use thiserror::Error;

/// What is wrong with a search.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SearchError {
    /// Bounds of a search and its start do not fit.
    #[error("{name}: {what}")]
    Bounds {
        /// Name of the parameter.
        name: String,
        /// What is wrong, and what is accepted.
        what: String,
    },
    /// The objective has no value at the start.
    #[error("at the start: {0}")]
    Start(String),
    /// It was asked to end: its journal has what was evaluated.
    #[error(transparent)]
    Stopped(#[from] Stopped),
    /// The journal is that of another search.
    #[error("{0} is the journal of another search: take it away, or write elsewhere")]
    OtherSearch(String),
    /// The journal cannot be read or written.
    #[error("{file}: {error}")]
    File {
        /// Its path.
        file: String,
        /// Why.
        error: String,
    },
}
