//! `CalibrateError`: why coefficients could not be found.

use alewife_reduced::search::SearchError;
use alewife_reduced::tree::TreeError;
use thiserror::Error;

use crate::case::{CaseError, CaseFile, Diagnostic, Severity};
use crate::reduced::ReducedError;

/// What went wrong.
#[derive(Debug, Error)]
pub enum CalibrateError {
    /// The case asks for nothing.
    #[error("the case has no [calibration]; add it with `fit` and [[calibration.from]]")]
    Nothing,
    /// A run or a record is wrong.
    #[error("calibration.from.{number}: {what}")]
    Record {
        /// Its number in the case, from 0.
        number: usize,
        /// What in its table is to blame, such as `csv` or `columns.NAME.x`.
        key: String,
        /// What is wrong, and what is accepted.
        what: String,
    },
    /// The case of a run is wrong.
    #[error("calibration.from.{number}: {error}")]
    Case {
        /// Its number in the case, from 0.
        number: usize,
        /// What is wrong.
        error: Box<CaseError>,
    },
    /// Nothing has been fitted, and why.
    #[error("{0}")]
    Fit(String),
    /// The program that proposes does not answer as it should.
    #[error("{0}")]
    Program(String),
    /// A search does not begin, or cannot be taken up again.
    #[error(transparent)]
    Search(#[from] SearchError),
    /// A reduced model cannot be made.
    #[error(transparent)]
    Model(#[from] ReducedError),
    /// A motion or a fit fails.
    #[error(transparent)]
    Tree(#[from] TreeError),
}

impl CalibrateError {
    /// What is wrong in a case, with its place there; none of what is no matter of the case.
    #[must_use]
    pub fn diagnostic(&self, file: &CaseFile) -> Option<Diagnostic> {
        let (key, message, help) = match self {
            Self::Record { number, key, what } => {
                let help = match key.split('.').next().unwrap_or_default() {
                    "run" => "give a run directory, or one with run directories in it",
                    "csv" => {
                        "give a CSV file with a header, by its path from the file in which it is written"
                    }
                    "time" | "columns" => "name a column of numbers, as the header has it",
                    "frame" => "give both columns, NAME.x and NAME.y, or leave `frame` out",
                    _ => "see the page on calibration",
                };
                (format!("calibration.from.{number}.{key}"), what.clone(), help.to_owned())
            }
            Self::Case { number, error } => {
                let key = format!("calibration.from.{number}.set");
                match &**error {
                    CaseError::Wrong(found) if !found.is_empty() => {
                        let Diagnostic { message, help, .. } = &found[0];
                        (key, format!("with these settings: {message}"), help.clone())
                    }
                    error => (key, format!("with these settings: {error}"), String::new()),
                }
            }
            Self::Fit(what) => {
                let help = "coefficients that move what is recorded: see the page on calibration";
                ("calibration.fit".to_owned(), what.clone(), help.to_owned())
            }
            Self::Program(what) => {
                let help = "mend the program, and call again: what was tried is in the journal";
                ("calibration.search.command".to_owned(), what.clone(), help.to_owned())
            }
            _ => return None,
        };
        let location = file.location(&key);
        Some(Diagnostic { severity: Severity::Error, key, message, help, location })
    }
}
