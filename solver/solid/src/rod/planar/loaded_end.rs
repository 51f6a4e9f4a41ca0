//! `LoadedEnd`: a force and a moment that are given at an end of a planar rod.

use std::fmt;

use nalgebra::{DMatrix, DVector, Matrix2, Vector2};

use super::ends::EndLoad;
use super::planar_rod::PlanarRod;
use crate::rod::end::End;

/// An end of a rod with a load that depends on time alone: it keeps its axes as the end turns.
pub struct LoadedEnd {
    /// Which end.
    pub end: End,
    /// Force (N, in planar problems N/m) and moment (N m, in planar problems N) at a time (s), by the axes that places are
    /// seen in.
    pub load: Box<dyn Fn(f64) -> EndLoad + Send + Sync>,
}

impl fmt::Debug for LoadedEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("LoadedEnd").field("end", &self.end).finish_non_exhaustive()
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
    fn angle(first: usize, coordinates: &DVector<f64>) -> TangentAngle {
        TangentAngle::at(&Vector2::new(coordinates[first + 2], coordinates[first + 3]))
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
        let (first, EndLoad { force, moment }) =
            (rod.first_coordinate(self.end), (self.load)(time));
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
        let (first, EndLoad { moment, .. }) = (rod.first_coordinate(self.end), (self.load)(time));
        let mut block = stiffness.fixed_view_mut::<2, 2>(first + 2, first + 2);
        block -= Self::angle(first, coordinates).second * moment;
    }

    /// Rate of work on a rod (W).
    pub(super) fn power(
        &self,
        rod: &PlanarRod,
        coordinates: &DVector<f64>,
        velocities: &DVector<f64>,
        time: f64,
    ) -> f64 {
        let (first, EndLoad { force, moment }) =
            (rod.first_coordinate(self.end), (self.load)(time));
        let at = |offset: usize| {
            Vector2::new(velocities[first + offset], velocities[first + offset + 1])
        };
        force.dot(&at(0)) + moment * Self::angle(first, coordinates).first.dot(&at(2))
    }
}
