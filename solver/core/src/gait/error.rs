//! `GaitError`: why a gait moves no body, with the numbers.

/// A gait that cannot be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GaitError {
    /// The outline at rest could not be made.
    #[error("the lengths of the shape make no body")]
    Shape,
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
        "at t = {time:.6} the body bends so far that its outline crosses itself{what}: make \
         amplitude, curvature or bending smaller"
    )]
    Crossing {
        /// When (s).
        time: f64,
        /// Where, or nothing.
        what: String,
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
