//! `Stretch`: part of the boundary of a domain that is cut open, straight or along a `Path`.

use std::sync::Arc;

use super::path::Path;
use crate::{BoundaryId, Point};

/// A stretch of the boundary of a cut domain.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Stretch {
    pub line: Line,
    /// Index of the side it is part of.
    pub side: BoundaryId,
    /// The stretch it copies backwards.
    pub copy_of: Option<CopyOf>,
}

/// What a periodic part of a boundary copies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CopyOf {
    /// Index of the original.
    pub original: usize,
    /// Whole periods from it to the copy (m).
    pub shift: Point<2>,
}

/// The line of a stretch.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Line {
    Straight(Point<2>, Point<2>),
    Along(Arc<Path>),
}
