//! `EnvironmentError`: why an environment was not opened, or an action not taken.

use thiserror::Error;

use crate::case::{CaseError, CommandError, Diagnostic};
use crate::reduced::ReducedError;
use crate::run::RunError;
use crate::runner::{Exit, Failure};

/// What went wrong.
#[derive(Debug, Error)]
pub enum EnvironmentError {
    /// There is none.
    #[error(
        "the case has no [environment]; write one, with interval, observations, actions and reward"
    )]
    None,
    /// A sample of the case makes no sense.
    #[error("with {numbers}: {what}; make the laws of environment.randomise narrower")]
    Sample {
        /// The numbers it has.
        numbers: String,
        /// What is wrong, and what is accepted.
        what: String,
    },
    /// A case, read with other numbers, makes no sense.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// What is wrong with the case.
    #[error("{}: {}; {}", .0.key, .0.message, .0.help)]
    Mistake(Box<Diagnostic>),
    /// An observation is no number from the beginning.
    #[error(
        "{name} is {value} at the start of an episode; write an expression that is a number there"
    )]
    Start {
        /// The observation.
        name: String,
        /// Its value.
        value: f64,
    },
    /// An action is no number.
    #[error(
        "environment {environment}: the action of `{command}` is {value}; give a finite number, from -1 to 1"
    )]
    Action {
        /// Number of the environment, from 0.
        environment: usize,
        /// The command.
        command: String,
        /// What was asked for.
        value: f64,
    },
    /// Actions of another number.
    #[error(
        "{found} numbers for the actions of {environments} environments, which take {each} each"
    )]
    Shape {
        /// How many there are.
        found: usize,
        /// How many environments there are.
        environments: usize,
        /// How many numbers each takes.
        each: usize,
    },
    /// An episode is over.
    #[error("the episode of environment {environment} is over; reset it")]
    Over {
        /// Number of the environment, from 0.
        environment: usize,
    },
    /// There are none, or no threads.
    #[error("{0}")]
    Number(String),
    /// The reduced model does not know something.
    #[error(transparent)]
    Reduced(#[from] ReducedError),
    /// The full solver stopped.
    #[error(transparent)]
    Run(#[from] RunError),
    /// A command is asked for something it cannot be.
    #[error(transparent)]
    Command(#[from] CommandError),
}

impl From<EnvironmentError> for Failure {
    fn from(error: EnvironmentError) -> Self {
        match error {
            EnvironmentError::Run(error) => error.into(),
            EnvironmentError::Case(error) => error.into(),
            EnvironmentError::Mistake(mistake) => Self::wrong(&[*mistake]),
            error => {
                let exit = match error {
                    EnvironmentError::None
                    | EnvironmentError::Sample { .. }
                    | EnvironmentError::Start { .. }
                    | EnvironmentError::Reduced(_) => Exit::BadCase,
                    _ => Exit::Usage,
                };
                Self::new(exit, error.to_string())
            }
        }
    }
}
