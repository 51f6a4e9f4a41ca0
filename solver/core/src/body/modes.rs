//! `Mode` and `Modes`: the rigid motions a body has, and the vectors they are components of.

use std::ops::{Index, IndexMut};

use nalgebra::SVector;

/// Linear components x, y, z, then angular components about x, y, z, all in the world.
///
/// Of a velocity (m/s, rad/s), a displacement (m, rad) or a load (N, N m; per length in planar
/// problems).
pub type RigidVector = SVector<f64, 6>;

/// One rigid motion of a body.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Mode {
    /// Translation along x.
    X,
    /// Translation along y.
    Y,
    /// Translation along z.
    Z,
    /// Rotation about x.
    AboutX,
    /// Rotation about y.
    AboutY,
    /// Rotation about z.
    AboutZ,
}

impl Mode {
    /// All motions, in the order of the components of a [`RigidVector`].
    pub const ALL: [Self; 6] =
        [Self::X, Self::Y, Self::Z, Self::AboutX, Self::AboutY, Self::AboutZ];

    /// The translation along an axis (0, 1, 2).
    ///
    /// # Panics
    /// For an axis above 2.
    #[must_use]
    pub const fn along(axis: usize) -> Self {
        [Self::X, Self::Y, Self::Z][axis]
    }

    /// The rotation about an axis (0, 1, 2).
    ///
    /// # Panics
    /// For an axis above 2.
    #[must_use]
    pub const fn about(axis: usize) -> Self {
        [Self::AboutX, Self::AboutY, Self::AboutZ][axis]
    }

    /// Its component of a [`RigidVector`].
    #[must_use]
    pub const fn index(self) -> usize {
        self as usize
    }

    /// Whether it is a rotation.
    #[must_use]
    pub const fn is_rotation(self) -> bool {
        self.index() >= 3
    }

    /// The axis it goes along or turns about: 0, 1, 2 for x, y, z.
    #[must_use]
    pub const fn axis(self) -> usize {
        self.index() % 3
    }
}

impl Index<Mode> for RigidVector {
    type Output = f64;

    fn index(&self, mode: Mode) -> &f64 {
        &self[mode.index()]
    }
}

impl IndexMut<Mode> for RigidVector {
    fn index_mut(&mut self, mode: Mode) -> &mut f64 {
        &mut self[mode.index()]
    }
}

impl<T> Index<Mode> for [T; 6] {
    type Output = T;

    fn index(&self, mode: Mode) -> &T {
        &self[mode.index()]
    }
}

impl<T> IndexMut<Mode> for [T; 6] {
    fn index_mut(&mut self, mode: Mode) -> &mut T {
        &mut self[mode.index()]
    }
}

/// The rigid motions that bodies have in a geometry, ascending.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Modes(&'static [Mode]);

impl Modes {
    /// In the plane: along x and y, about z.
    pub const PLANAR: Self = Self(&[Mode::X, Mode::Y, Mode::AboutZ]);
    /// On the axis of an axisymmetric flow: along it.
    pub const AXISYMMETRIC: Self = Self(&[Mode::X]);
    /// In space: all.
    pub const SPATIAL: Self = Self(&Mode::ALL);

    /// How many there are.
    #[must_use]
    pub const fn len(self) -> usize {
        self.0.len()
    }

    /// Never: every geometry lets bodies move along x.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.0.is_empty()
    }

    /// The motions.
    pub fn iter(self) -> impl DoubleEndedIterator<Item = Mode> + ExactSizeIterator + Clone {
        self.0.iter().copied()
    }

    /// The rotations among them.
    pub fn rotations(self) -> impl Iterator<Item = Mode> + Clone {
        self.iter().filter(|mode| mode.is_rotation())
    }

    /// The position of a motion among them.
    #[must_use]
    pub fn position(self, mode: Mode) -> Option<usize> {
        self.0.iter().position(|known| *known == mode)
    }

    /// The vector with the components of these motions only.
    #[must_use]
    pub fn project(self, vector: &RigidVector) -> RigidVector {
        let mut kept = RigidVector::zeros();
        for mode in self.iter() {
            kept[mode] = vector[mode];
        }
        kept
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_geometry_has_its_motions() {
        assert_eq!(Modes::PLANAR.iter().map(Mode::index).collect::<Vec<_>>(), [0, 1, 5]);
        assert_eq!(Modes::AXISYMMETRIC.rotations().count(), 0);
        assert_eq!(Modes::SPATIAL.len(), 6);
        assert_eq!(Modes::PLANAR.position(Mode::AboutZ), Some(2));
        assert_eq!(Modes::PLANAR.position(Mode::Z), None);
        for (index, mode) in Mode::ALL.into_iter().enumerate() {
            assert_eq!((mode.index(), mode.axis()), (index, index % 3));
            assert_eq!(mode.is_rotation(), index > 2);
        }
        let projected = Modes::PLANAR.project(&RigidVector::from_fn(|i, _| 1.0 + i as f64));
        assert_eq!(projected.as_slice(), [1.0, 2.0, 0.0, 0.0, 0.0, 6.0]);
    }
}
