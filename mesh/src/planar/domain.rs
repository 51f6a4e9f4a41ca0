//! `Domain`: the region the fluid and the bodies share, with its named sides.

use crate::number::whole;
use crate::planar::lattice::lattice;
use crate::{PlacedShape, Point};

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

    /// Lower left and upper right corner of the smallest rectangle around it (m).
    #[must_use]
    pub fn corners(&self) -> [Point<2>; 2] {
        match *self {
            Self::Box { min, max, .. } => [min, max],
            Self::Disc { center, radius } => {
                [center - Point::<2>::repeat(radius), center + Point::<2>::repeat(radius)]
            }
            Self::HalfDisc { center, radius } => {
                [Point::<2>::new(center - radius, 0.0), Point::<2>::new(center + radius, radius)]
            }
            Self::Cylinder { x, radius, .. } => {
                [Point::<2>::new(x[0], 0.0), Point::<2>::new(x[1], radius)]
            }
        }
    }

    /// Distance from a point to the nearest side, the axis left out (m); negative outside.
    #[must_use]
    pub fn clearance(&self, point: Point<2>) -> f64 {
        (0..self.sides().len()).map(|side| self.side_gap(side, point)).fold(f64::INFINITY, f64::min)
    }

    /// Signed distance from a point to one side (m), positive towards the fluid; infinite for the
    /// axis, which is not a surface.
    #[must_use]
    pub fn side_gap(&self, side: usize, point: Point<2>) -> f64 {
        match self {
            Self::Box { min, max, .. } => {
                [point.x - min.x, max.x - point.x, point.y - min.y, max.y - point.y][side]
            }
            Self::Disc { center, radius } => radius - (point - center).norm(),
            Self::HalfDisc { center, radius } => {
                [radius - (point - Point::<2>::new(*center, 0.0)).norm(), f64::INFINITY][side]
            }
            Self::Cylinder { x, radius, .. } => {
                [point.x - x[0], x[1] - point.x, radius - point.y, f64::INFINITY][side]
            }
        }
    }

    /// Whether a side belongs to a periodic pair.
    #[must_use]
    pub fn is_periodic(&self, side: usize) -> bool {
        match self {
            Self::Box { periodic_x, periodic_y, .. } => {
                if side < 2 {
                    *periodic_x
                } else {
                    *periodic_y
                }
            }
            Self::Cylinder { periodic_x, .. } => side < 2 && *periodic_x,
            Self::Disc { .. } | Self::HalfDisc { .. } => false,
        }
    }

    /// Distance between a side and the side facing it across the fluid (m), infinite without one.
    #[must_use]
    pub fn facing(&self, side: usize) -> f64 {
        match self {
            Self::Box { min, max, .. } => {
                if side < 2 {
                    max.x - min.x
                } else {
                    max.y - min.y
                }
            }
            Self::Disc { radius, .. } => 2.0 * radius,
            Self::HalfDisc { radius, .. } => [2.0 * radius, f64::INFINITY][side],
            Self::Cylinder { x, radius, .. } => {
                [x[1] - x[0], x[1] - x[0], 2.0 * radius, f64::INFINITY][side]
            }
        }
    }

    /// Lengths after which the domain repeats along x and y, where it does (m).
    #[must_use]
    pub fn periods(&self) -> [Option<f64>; 2] {
        match self {
            Self::Box { min, max, periodic_x, periodic_y } => {
                [periodic_x.then_some(max.x - min.x), periodic_y.then_some(max.y - min.y)]
            }
            Self::Cylinder { x, periodic_x, .. } => [periodic_x.then_some(x[1] - x[0]), None],
            Self::Disc { .. } | Self::HalfDisc { .. } => [None, None],
        }
    }

    /// The whole periods that bring a point into the domain (m).
    #[must_use]
    pub fn shift_into(&self, point: Point<2>) -> Point<2> {
        let ([min, _], periods) = (self.corners(), self.periods());
        Point::<2>::from_fn(|axis, _| {
            periods[axis]
                .map_or(0.0, |length| -((point[axis] - min[axis]) / length).floor() * length)
        })
    }

    /// The vectors by which a periodic domain repeats next to itself, zero first (m).
    #[must_use]
    pub fn images(&self) -> Vec<Point<2>> {
        lattice(self.periods(), 1)
    }

    /// The same, far enough that every body meets its neighbours when bodies lie periods apart.
    #[must_use]
    pub fn images_of(&self, bodies: &[PlacedShape]) -> Vec<Point<2>> {
        self.images_around(bodies.iter().map(|body| body.center))
    }

    /// The same for points (m) that lie periods apart.
    #[must_use]
    pub fn images_around(&self, points: impl Iterator<Item = Point<2>> + Clone) -> Vec<Point<2>> {
        let periods = self.periods();
        let most = (0..2).map(|axis| {
            let places = points.clone().map(|point| point[axis]);
            let [low, high] = places.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
                [low.min(x), high.max(x)]
            });
            periods[axis].map_or(1.0, |length| 1.0 + ((high - low) / length).floor())
        });
        lattice(periods, whole(most.fold(1.0, f64::max).min(8.0)))
    }
}
