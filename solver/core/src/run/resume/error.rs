//! `ResumeError`: why a run cannot resume from a state.

use thiserror::Error;

use crate::algebra::LinearError;
use crate::coupling::ShapeError;
use crate::motion::RemeshError;

/// Version of what is saved; others are refused.
pub const VERSION: u32 = 14;

/// Why a run cannot resume from a state.
#[derive(Debug, Error)]
pub enum ResumeError {
    /// It was written by another version.
    #[error("its version is {found}, and {VERSION} is wanted")]
    Version {
        /// The version of the file.
        found: u32,
    },
    /// It is of something else.
    #[error(
        "it was left by a case with {key} = {state}, and in this case it is {case}: a run resumes with \
         the geometry, fluid, bodies and motions it began with"
    )]
    OtherCase {
        /// Path of the key, as on the command line.
        key: String,
        /// Its value in the state.
        state: String,
        /// Its value in the case.
        case: String,
    },
    /// Something else was asked for before.
    #[error(
        "what was asked for before time {time} is not what is recorded: repeat the recording from the start, \
         with --overwrite"
    )]
    OtherCommands {
        /// Time of the state (s).
        time: f64,
    },
    /// The case cannot be written.
    #[error("the case cannot be written: {0}")]
    Unwritable(#[from] serde_json::Error),
    /// Lengths or indices contradict each other.
    #[error("its parts do not fit together")]
    Inconsistent,
    /// The mesh moves in one and not in the other.
    #[error("its mesh moves and that of the case does not, or vice versa")]
    MeshMotion,
    /// What moves the mesh could not be set up.
    #[error(transparent)]
    Remesh(#[from] RemeshError),
    /// The linear solver cannot go on from what it kept.
    #[error(transparent)]
    Solver(#[from] LinearError),
    /// A gait gives its body no shape.
    #[error(transparent)]
    Shape(#[from] ShapeError),
}
