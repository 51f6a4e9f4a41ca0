//! `ResumeError`: why a run cannot resume from a state.

use thiserror::Error;

use crate::body::Pose;
use crate::coupling::ShapeError;
use crate::simulation::scene::RemeshError;

/// Version of the file; others are refused.
pub(super) const VERSION: u32 = 3;

/// Why a run cannot resume from a state.
#[derive(Debug, Error)]
pub enum ResumeError {
    /// It was written by another version.
    #[error("its version is {found}, and {VERSION} is wanted")]
    Version {
        /// The version of the file.
        found: u32,
    },
    /// It has other bodies.
    #[error("its bodies are {state:?}, those of the case {case:?}")]
    Bodies {
        /// Names in the state.
        state: Vec<String>,
        /// Names in the case.
        case: Vec<String>,
    },
    /// Lengths or indices contradict each other.
    #[error("its parts do not fit together")]
    Inconsistent,
    /// The joints of the case put a body elsewhere.
    #[error(
        "body `{body}` was left at ({:.6}, {:.6}) turned by {:.6}, and the joints of this case \
         put it at ({:.6}, {:.6}) turned by {:.6}: a run resumes with the strokes it began with",
        .left.center.x, .left.center.y, .left.angle(), .put.center.x, .put.center.y, .put.angle()
    )]
    Joint {
        /// Name of the body.
        body: String,
        /// Where it is in the state.
        left: Box<Pose>,
        /// Where the joints of the case put it.
        put: Box<Pose>,
    },
    /// The gait of the case gives a body another outline.
    #[error(
        "the surface of body `{body}` is {distance:.3e} from where the gait of this case puts it: \
         a run resumes with the gait it began with"
    )]
    Outline {
        /// Name of the body.
        body: String,
        /// Distance of the surfaces (m).
        distance: f64,
    },
    /// The mesh moves in one and not in the other.
    #[error("its mesh moves and that of the case does not, or vice versa")]
    MeshMotion,
    /// What moves the mesh could not be set up.
    #[error(transparent)]
    Remesh(#[from] RemeshError),
    /// A gait gives its body no shape.
    #[error(transparent)]
    Shape(#[from] ShapeError),
}
