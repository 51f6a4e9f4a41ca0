//! `ContactSurface`: what contact asks of the surface of one body, and of a wall it may meet.

use std::fmt::Debug;

use alewife_mesh::Point;
use nalgebra::Vector3;

use super::Curvatures;
use crate::body::Pose;

/// A point of a body and the point of what it faces, where their distance is smallest nearby.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FacingPoints {
    /// The point on the body (m).
    pub first: Vector3<f64>,
    /// The point on what it faces (m).
    pub second: Vector3<f64>,
    /// Unit normal from the second to the first.
    pub normal: Vector3<f64>,
    /// Distance along the normal (m); where the surfaces overlap, minus the depth.
    pub gap: f64,
    /// Curvatures there.
    pub curvatures: Curvatures,
}

/// The surface of a body where it is.
pub trait ContactSurface<const D: usize>: Debug + Clone + Send + Sync {
    /// A side of the domain that is a wall.
    type Wall: Debug + Clone + Send + Sync;

    /// Centre of a ball that holds the surface (m).
    fn center(&self) -> Point<D>;

    /// Radius of that ball (m).
    fn reach(&self) -> f64;

    /// Whether it is a circle or a sphere about the origin of its frame.
    fn is_round(&self) -> bool;

    /// Width (m) of the body where it is thinnest.
    fn thickness(&self) -> f64;

    /// The surface with the body in a pose, `centroid` (m) its centre of mass in the frame of the surface, and
    /// moved away by a vector (m).
    #[must_use]
    fn placed(&self, pose: &Pose, centroid: &Point<D>, away: &Point<D>) -> Self;

    /// All close pairs of points with another body whose gaps are below `range` (m); surfaces that
    /// overlap always have one.
    fn facing(&self, other: &Self, range: f64) -> Vec<FacingPoints>;

    /// The smallest gap to another body (m).
    fn gap(&self, other: &Self) -> f64;

    /// All close pairs of points with a wall whose gaps are below `range` (m).
    fn facing_wall(&self, wall: &Self::Wall, range: f64) -> Vec<FacingPoints>;

    /// The smallest gap to a wall (m).
    fn gap_to_wall(&self, wall: &Self::Wall) -> f64;

    /// A lower bound of the gap to a wall (m), at little cost.
    fn least_gap_to_wall(&self, wall: &Self::Wall) -> f64;

    /// A lower bound of the gap to another body (m), at little cost.
    fn least_gap(&self, other: &Self) -> f64 {
        (self.center() - other.center()).norm() - self.reach() - other.reach()
    }
}
