//! `LoadedEnd`: a force and a moment that are given at an end of a planar rod.

use std::fmt;

use nalgebra::{DMatrix, DVector, Matrix2, Rotation2, Vector2};

use super::ends::EndLoad;
use super::planar_rod::PlanarRod;
use crate::rod::end::{Axes, End};

/// An end of a rod with a load whose components depend on time alone.
///
/// A force along the axes of the section, such as one along the tangent (a follower force, @bigoni2024), has no potential, and
/// its derivatives by the coordinates are not symmetric.
pub struct LoadedEnd {
    /// Which end.
    pub end: End,
    /// The axes of the force: in those of the section, the tangent and the normal on its left.
    pub axes: Axes,
    /// Force (N, in planar problems N/m) and moment (N m, in planar problems N) at a time (s), by these axes.
    pub load: Box<dyn Fn(f64) -> EndLoad + Send + Sync>,
}

impl fmt::Debug for LoadedEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut all = f.debug_struct("LoadedEnd");
        all.field("end", &self.end).field("axes", &self.axes).finish_non_exhaustive()
    }
}

/// The angle of a tangent: its derivatives by the components of that.
struct TangentAngle {
    first: Vector2<f64>,
    second: Matrix2<f64>,
}

impl TangentAngle {
    fn at(tangent: &Vector2<f64>) -> Self {
        let square = tangent.norm_squared();
        let (x, y) = (tangent.x, tangent.y);
        let [mixed, same] = [y * y - x * x, 2.0 * x * y].map(|entry| entry / (square * square));
        Self {
            first: Vector2::new(-y, x) / square,
            second: Matrix2::new(same, mixed, mixed, -same),
        }
    }
}

impl LoadedEnd {
    fn tangent(first: usize, coordinates: &DVector<f64>) -> Vector2<f64> {
        Vector2::new(coordinates[first + 2], coordinates[first + 3])
    }

    fn angle(first: usize, coordinates: &DVector<f64>) -> TangentAngle {
        TangentAngle::at(&Self::tangent(first, coordinates))
    }

    /// The load at a time (s), by the axes that places are seen in.
    pub(super) fn at(&self, rod: &PlanarRod, coordinates: &DVector<f64>, time: f64) -> EndLoad {
        let EndLoad { force, moment } = (self.load)(time);
        let force = match self.axes {
            Axes::Fixed => force,
            Axes::OfSection => {
                let tangent = Self::tangent(rod.first_coordinate(self.end), coordinates);
                Rotation2::new(tangent.y.atan2(tangent.x)) * force
            }
        };
        EndLoad { force, moment }
    }

    /// Subtracts the load from forces (n) on the coordinates of a rod: the moment M does the work M dtheta in a turn of
    /// the tangent.
    pub(super) fn subtract(
        &self,
        rod: &PlanarRod,
        coordinates: &DVector<f64>,
        time: f64,
        forces: &mut DVector<f64>,
    ) {
        let first = rod.first_coordinate(self.end);
        let EndLoad { force, moment } = self.at(rod, coordinates, time);
        let on_tangent = Self::angle(first, coordinates).first * moment;
        for (axis, part) in force.iter().chain(on_tangent.iter()).enumerate() {
            forces[first + axis] -= part;
        }
    }

    /// Subtracts its derivatives by the coordinates from a stiffness (n x n).
    pub(super) fn subtract_tangent(
        &self,
        rod: &PlanarRod,
        coordinates: &DVector<f64>,
        time: f64,
        stiffness: &mut DMatrix<f64>,
    ) {
        let first = rod.first_coordinate(self.end);
        let EndLoad { force, moment } = self.at(rod, coordinates, time);
        let TangentAngle { first: turn, second } = Self::angle(first, coordinates);
        let mut block = stiffness.fixed_view_mut::<2, 2>(first + 2, first + 2);
        block -= second * moment;
        if self.axes == Axes::OfSection {
            let mut block = stiffness.fixed_view_mut::<2, 2>(first, first + 2);
            block -= Vector2::new(-force.y, force.x) * turn.transpose();
        }
    }

    /// Rate of work on a rod (W).
    pub(super) fn power(
        &self,
        rod: &PlanarRod,
        coordinates: &DVector<f64>,
        velocities: &DVector<f64>,
        time: f64,
    ) -> f64 {
        let first = rod.first_coordinate(self.end);
        let EndLoad { force, moment } = self.at(rod, coordinates, time);
        let at = |offset: usize| {
            Vector2::new(velocities[first + offset], velocities[first + offset + 1])
        };
        force.dot(&at(0)) + moment * Self::angle(first, coordinates).first.dot(&at(2))
    }
}
