//! `Domain`: the region in space that fluid and bodies share, with its named sides.

use super::imported::Imported;
use crate::Point;

/// The region of a problem in space before bodies are cut out of it.
#[derive(Debug, Clone, PartialEq)]
pub enum Domain {
    /// Box; sides `left`, `right` (across x), `bottom`, `top` (across y), `back`, `front` (across z).
    Box {
        /// Corner with the smallest coordinates (m).
        min: Point<3>,
        /// Corner with the largest coordinates (m).
        max: Point<3>,
        /// Whether the two sides across x, y and z are periodic pairs.
        periodic: [bool; 3],
        /// Whether each side is a plane of symmetry, which bodies may cross.
        symmetric: [bool; 6],
    },
    /// Cylinder about the x axis; sides `left`, `right`, `wall`.
    Cylinder {
        /// Both ends on the axis (m).
        x: [f64; 2],
        /// Radius (m).
        radius: f64,
    },
    /// Ball; side `wall`.
    Ball {
        /// Centre (m).
        center: Point<3>,
        /// Radius (m).
        radius: f64,
    },
    /// Region of a given mesh; sides as its boundaries are named.
    Imported(Imported),
}

impl Domain {
    /// A box with walls on all sides, between two corners (m).
    #[must_use]
    pub fn walls(min: Point<3>, max: Point<3>) -> Self {
        Self::Box { min, max, periodic: [false; 3], symmetric: [false; 6] }
    }

    /// Names of the sides, in the order in which they are numbered in a mesh.
    #[must_use]
    pub fn sides(&self) -> Vec<&str> {
        match self {
            Self::Box { .. } => vec!["left", "right", "bottom", "top", "back", "front"],
            Self::Cylinder { .. } => vec!["left", "right", "wall"],
            Self::Ball { .. } => vec!["wall"],
            Self::Imported(imported) => {
                imported.mesh().boundaries.iter().map(|side| side.name.as_str()).collect()
            }
        }
    }

    /// Corners of the smallest box around it (m).
    #[must_use]
    pub fn corners(&self) -> [Point<3>; 2] {
        match *self {
            Self::Box { min, max, .. } => [min, max],
            Self::Cylinder { x: [left, right], radius } => {
                [Point::<3>::new(left, -radius, -radius), Point::<3>::new(right, radius, radius)]
            }
            Self::Ball { center, radius } => {
                [center - Point::<3>::repeat(radius), center + Point::<3>::repeat(radius)]
            }
            Self::Imported(ref imported) => imported.corners(),
        }
    }

    /// Signed distance from a point to one side (m), positive towards the fluid.
    #[must_use]
    pub fn side_gap(&self, side: usize, point: Point<3>) -> f64 {
        match self {
            Self::Box { min, max, .. } => {
                let axis = side / 2;
                if side.is_multiple_of(2) {
                    point[axis] - min[axis]
                } else {
                    max[axis] - point[axis]
                }
            }
            Self::Cylinder { x, radius } => {
                [point.x - x[0], x[1] - point.x, radius - point.y.hypot(point.z)][side]
            }
            Self::Ball { center, radius } => radius - (point - center).norm(),
            Self::Imported(imported) => imported.side(side).foot(point).gap,
        }
    }

    /// Distance between a side and the side facing it across the fluid (m).
    #[must_use]
    pub fn facing(&self, side: usize) -> f64 {
        match self {
            Self::Box { min, max, .. } => (max - min)[side / 2],
            Self::Cylinder { x, radius } => [x[1] - x[0], x[1] - x[0], 2.0 * radius][side],
            Self::Ball { radius, .. } => 2.0 * radius,
            Self::Imported(_) => f64::INFINITY,
        }
    }

    /// Whether a side belongs to a periodic pair.
    #[must_use]
    pub fn is_periodic(&self, side: usize) -> bool {
        matches!(self, Self::Box { periodic, .. } if periodic[side / 2])
    }

    /// The other side of the periodic pair of a side.
    #[must_use]
    pub fn twin(&self, side: usize) -> Option<&str> {
        self.is_periodic(side).then(|| self.sides()[side ^ 1])
    }

    /// Lengths along which the domain repeats (m), zero along the other axes.
    #[must_use]
    pub fn periods(&self) -> Point<3> {
        let [min, max] = self.corners();
        Point::<3>::from_fn(|axis, _| {
            let is_periodic = self.is_periodic(2 * axis);
            if is_periodic { max[axis] - min[axis] } else { 0.0 }
        })
    }

    /// The vectors by which the domain repeats around itself (m), zero first.
    #[must_use]
    pub fn images(&self) -> Vec<Point<3>> {
        let periods = self.periods();
        let mut images = vec![Point::<3>::zeros()];
        for axis in (0..3).filter(|&axis| periods[axis] > 0.0) {
            let shift = Point::<3>::ith(axis, periods[axis]);
            let beside = images.iter().flat_map(|image| [image + shift, image - shift]);
            images.extend(beside.collect::<Vec<_>>());
        }
        images
    }

    /// Whether a side is a plane of symmetry.
    #[must_use]
    pub fn is_symmetric(&self, side: usize) -> bool {
        matches!(self, Self::Box { symmetric, .. } if symmetric[side])
    }
}
