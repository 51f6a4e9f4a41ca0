//! The cross product of vectors of the plane.

use crate::Point;

/// Third component of the cross product.
pub(crate) fn cross(a: Point<2>, b: Point<2>) -> f64 {
    a.x * b.y - a.y * b.x
}
