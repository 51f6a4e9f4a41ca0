//! `Frame`: the frame of a section in space, and vectors of numbers with derivatives.

use crate::rod::kinematics::Number;

/// Three vectors of length one: along the centreline and across.
#[derive(Debug, Clone, Copy)]
pub struct Frame<D> {
    pub tangent: [D; 3],
    pub first: [D; 3],
    pub second: [D; 3],
    /// Length of dr/ds.
    pub stretch: D,
    /// Length of the vector across, less its part along the tangent.
    pub width: D,
}

impl<D: Number> Frame<D> {
    /// From the tangent dr/ds and a vector across.
    pub fn new(tangent: &[D; 3], across: &[D; 3]) -> Self {
        let stretch = dot(tangent, tangent).sqrt();
        let unit = scaled(tangent, stretch.recip());
        let first = sum(across, &scaled(&unit, -dot(across, &unit)));
        let width = dot(&first, &first).sqrt();
        let first = scaled(&first, width.recip());
        Self { tangent: unit, first, second: cross(&unit, &first), stretch, width }
    }
}

pub fn dot<D: Number>(a: &[D; 3], b: &[D; 3]) -> D {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross<D: Number>(a: &[D; 3], b: &[D; 3]) -> [D; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn scaled<D: Number>(a: &[D; 3], by: D) -> [D; 3] {
    a.map(|component| component * by)
}

pub fn sum<D: Number>(a: &[D; 3], b: &[D; 3]) -> [D; 3] {
    std::array::from_fn(|axis| a[axis] + b[axis])
}
