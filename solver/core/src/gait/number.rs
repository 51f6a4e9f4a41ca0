//! `Number`: a real number, or a dual number that carries derivatives along.

use num_dual::DualNum;

/// Reals and dual numbers over them: what midlines and outlines are computed with, so that
/// velocities are the exact derivatives of positions.
pub trait Number: DualNum<Primitive = f64> + Copy {}

impl<D: DualNum<Primitive = f64> + Copy> Number for D {}

/// Third component of the cross product.
pub fn cross<D: Number>(a: [D; 2], b: [D; 2]) -> D {
    a[0] * b[1] - a[1] * b[0]
}
