//! `GaitError`: why a gait makes no body, with the numbers.

use alewife_mesh::MeshError;

/// A gait that cannot be evaluated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GaitError {
    /// The outline at rest could not be made.
    #[error("the lengths of the shape make no body")]
    Shape,
    /// A wave of curvature needs two points or more.
    #[error("the curvature is given at {points} points of the midline: at least 2 are needed")]
    Curvature {
        /// How many are given.
        points: usize,
    },
    /// The law of a body that pulsates gives no positive radius at some time.
    #[error("at t = {time:.6} the radius would be {radius:.3e}: it must be positive and finite")]
    Radius {
        /// When (s).
        time: f64,
        /// The radius (m).
        radius: f64,
    },
    /// At some time there is no such midline.
    #[error(
        "at t = {time:.6} the midline would have to be stretched to follow the gait: make its \
         amplitude smaller"
    )]
    Midline {
        /// When (s).
        time: f64,
    },
    /// The outline crosses itself.
    #[error(
        "at t = {time:.6} the body bends so far that its outline crosses itself near \
         ({:.4}, {:.4}) of the body: make amplitude, curvature or bending smaller",
        .point[0], .point[1]
    )]
    Crossing {
        /// When (s).
        time: f64,
        /// Where (m), in the frame of the body.
        point: [f64; 2],
    },
    /// The outline encloses no body for another reason.
    #[error("at t = {time:.6} the outline is not that of a body: {reason}")]
    Outline {
        /// When (s).
        time: f64,
        /// Why.
        reason: MeshError,
    },
    /// No offset along the normals gives the outline the area at rest.
    #[error(
        "at t = {time:.6} the body bends so far that its area cannot be kept: make amplitude, \
         curvature or bending smaller"
    )]
    NoOffset {
        /// When (s).
        time: f64,
    },
    /// The area changes by more than a small correction.
    #[error(
        "at t = {time:.6} the area would change: the outline has to be moved along its normals \
         with {ratio:.2e} of its mean normal speed to keep it, and {allowed:.0e} is allowed"
    )]
    Area {
        /// When (s).
        time: f64,
        /// Speed of the correction over the mean normal speed.
        ratio: f64,
        /// Largest ratio that is allowed.
        allowed: f64,
    },
}

impl GaitError {
    /// The failure to make an outline at a time (s).
    pub(super) fn of_outline(time: f64, error: MeshError) -> Self {
        match error {
            MeshError::SelfIntersection { x, y, .. } => Self::Crossing { time, point: [x, y] },
            reason => Self::Outline { time, reason },
        }
    }
}
