//! The cell sizes a case asks for, and when it asks for other cells.

use alewife_mesh::Sizing;

use crate::case::Case;
use crate::motion::Limits;

/// The wanted cell sizes of a case.
#[must_use]
pub fn sizing<const D: usize>(case: &Case) -> Sizing<D> {
    case.sizing()
}

/// When a case has its mesh replaced.
pub(in crate::run) fn limits(case: &Case) -> Limits {
    let mesh = &case.mesh;
    // A given mesh is not made again, and what is around its holes is known by its cells only
    let layers = if case.bodies_are_holes() { 0.0 } else { mesh.fewest_layers() };
    Limits { quality: mesh.moving.quality, layers }
}
