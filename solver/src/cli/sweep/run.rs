//! `sweep run`: the points of a sweep that are missing.

use super::index::Index;
use super::run_options::Options;
use super::{many, point};
use crate::cli::exit::{Exit, Failure};

/// Runs points.
pub fn run(options: &Options) -> Result<Exit, Failure> {
    match options.index.and_then(Index::single) {
        Some(index) => point::run(options, index),
        None => many::run(options),
    }
}
