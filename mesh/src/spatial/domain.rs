//! `Domain`: the region in space that fluid and bodies share, with its named sides.

use super::imported::Imported;
use crate::number::whole;
use crate::{Bounds, Point};

/// Most periods by which points lie apart whose images are looked at: a mesh is replaced long before.
const MOST_PERIODS: f64 = 8.0;

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

    /// The vectors by which the domain repeats (m), zero first, so many that points that lie periods apart
    /// have all images around each other.
    #[must_use]
    pub fn images_around<'a>(
        &self,
        points: impl IntoIterator<Item = &'a Point<3>>,
    ) -> Vec<Point<3>> {
        let periods = self.periods();
        let bounds = Bounds::around(points);
        let mut images = vec![Point::<3>::zeros()];
        for axis in (0..3).filter(|&axis| periods[axis] > 0.0) {
            let extent = (bounds.max[axis] - bounds.min[axis]) / periods[axis];
            let most = extent.floor().clamp(1.0, MOST_PERIODS);
            let steps = (1..=whole(most)).flat_map(|k| [k as f64, -(k as f64)]);
            let shifts = steps.map(|step| Point::<3>::ith(axis, step * periods[axis]));
            let beside = shifts.flat_map(|shift| images.iter().map(move |image| image + shift));
            let beside: Vec<_> = beside.collect();
            images.extend(beside);
        }
        images
    }

    /// The whole periods that bring a point into the box (m).
    #[must_use]
    pub fn shift_into(&self, point: Point<3>) -> Point<3> {
        let ([min, _], periods) = (self.corners(), self.periods());
        Point::<3>::from_fn(|axis, _| {
            if periods[axis] > 0.0 {
                -((point[axis] - min[axis]) / periods[axis]).floor() * periods[axis]
            } else {
                0.0
            }
        })
    }

    /// Whether a side is a plane of symmetry.
    #[must_use]
    pub fn is_symmetric(&self, side: usize) -> bool {
        matches!(self, Self::Box { symmetric, .. } if symmetric[side])
    }
}
