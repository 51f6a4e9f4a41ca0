//! `Extent`: the smallest box around a region.

/// The smallest box around a region, flat in planar and axisymmetric cases.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extent {
    /// Least coordinates (m).
    pub min: [f64; 3],
    /// Largest coordinates (m).
    pub max: [f64; 3],
}

impl Extent {
    /// That of a centre and half lengths.
    pub(crate) fn around([x, y, z]: [f64; 3], [a, b, c]: [f64; 3]) -> Self {
        Self { min: [x - a, y - b, z - c], max: [x + a, y + b, z + c] }
    }

    /// That of two corners with any number of coordinates; those that are not given are zero.
    #[must_use]
    pub fn between(min: &[f64], max: &[f64]) -> Self {
        let corner = |given: &[f64]| {
            std::array::from_fn(|axis| given.get(axis).copied().unwrap_or_default())
        };
        Self { min: corner(min), max: corner(max) }
    }

    /// Lengths along the axes (m).
    #[must_use]
    pub fn lengths(&self) -> [f64; 3] {
        std::array::from_fn(|axis| self.max[axis] - self.min[axis])
    }

    /// Lower left and upper right corner in the plane (m).
    #[must_use]
    pub fn in_plane(&self) -> [[f64; 2]; 2] {
        [self.min, self.max].map(|[x, y, _]| [x, y])
    }
}
