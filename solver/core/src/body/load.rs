//! `BodyLoad` and `LoadedBody`: loads on single bodies, and which of their motions count for them.

use super::modes::RigidVector;

/// A load on a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyLoad {
    /// The body.
    pub body: usize,
    /// The load (N, N m).
    pub load: RigidVector,
}

/// A body that loads may act on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LoadedBody {
    /// The body.
    pub body: usize,
    /// Whether there may be torques on it, or its turns make a difference.
    pub turns: bool,
}
