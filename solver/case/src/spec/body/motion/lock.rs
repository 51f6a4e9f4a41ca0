//! `Lock`: a motion that a body may make, or may not.

use serde::{Deserialize, Serialize};

use crate::spec::domain::Geometry;

/// A motion a free body may not make.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Lock {
    /// Along x.
    X,
    /// Along y.
    Y,
    /// Along z.
    Z,
    /// Turning, about any axis.
    Rotation,
}

impl Lock {
    /// Its key.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
            Self::Rotation => "rotation",
        }
    }
}

impl Geometry {
    /// Motions of a free body, each of which may be locked.
    #[must_use]
    pub fn motions(self) -> &'static [Lock] {
        match self {
            Self::Planar => &[Lock::X, Lock::Y, Lock::Rotation],
            Self::Axisymmetric => &[Lock::X],
            Self::Spatial => &[Lock::X, Lock::Y, Lock::Z, Lock::Rotation],
        }
    }
}
