//! `Domain`: the region the fluid and the bodies share, with its named sides.

use crate::Point;

/// The region of the problem before bodies are cut out of it.
#[derive(Debug, Clone, PartialEq)]
pub enum Domain {
    /// Rectangle; sides `left`, `right`, `bottom`, `top` (planar).
    Box {
        /// Lower left corner (m).
        min: Point<2>,
        /// Upper right corner (m).
        max: Point<2>,
        /// Whether left and right are a periodic pair.
        periodic_x: bool,
        /// Whether bottom and top are a periodic pair.
        periodic_y: bool,
    },
    /// Disc; side `wall` (planar).
    Disc {
        /// Centre (m).
        center: Point<2>,
        /// Radius (m).
        radius: f64,
    },
    /// Half disc y >= 0, a ball in three dimensions; sides `wall`, `axis` (axisymmetric).
    HalfDisc {
        /// Centre on the axis (m).
        center: f64,
        /// Radius (m).
        radius: f64,
    },
    /// Rectangle y >= 0, a cylinder in three dimensions; sides `left`, `right`, `wall`, `axis`
    /// (axisymmetric).
    Cylinder {
        /// Both ends on the axis (m).
        x: [f64; 2],
        /// Radius (m).
        radius: f64,
        /// Whether left and right are a periodic pair.
        periodic_x: bool,
    },
}

impl Domain {
    /// Whether the domain is the half plane of an axisymmetric problem.
    #[must_use]
    pub fn is_axisymmetric(&self) -> bool {
        matches!(self, Self::HalfDisc { .. } | Self::Cylinder { .. })
    }

    /// Names of the sides, in the order in which they are numbered in a mesh.
    #[must_use]
    pub fn sides(&self) -> &'static [&'static str] {
        match self {
            Self::Box { .. } => &["left", "right", "bottom", "top"],
            Self::Disc { .. } => &["wall"],
            Self::HalfDisc { .. } => &["wall", "axis"],
            Self::Cylinder { .. } => &["left", "right", "wall", "axis"],
        }
    }
}
