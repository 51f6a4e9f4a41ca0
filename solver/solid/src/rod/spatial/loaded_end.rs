//! `SpatialLoadedEnd`: a force and a moment that are given at an end of a rod in space.

use std::array::from_fn;
use std::fmt;

use nalgebra::{DMatrix, DVector, Vector3};
use num_dual::Dual64;

use super::ends::SpatialEndLoad;
use super::frame::{Frame, cross, dot, scaled, sum};
use super::spatial_rod::SpatialRod;
use crate::rod::end::{Axes, End};
use crate::rod::kinematics::Number;

/// An end of a rod in space with a load whose components depend on time alone.
///
/// A moment that keeps its axis and a force that turns with the section have no potential: what they do on the way to a frame
/// depends on the way, and their derivatives by the coordinates are not symmetric.
pub struct SpatialLoadedEnd {
    /// Which end.
    pub end: End,
    /// The axes of both: in those of the section, the tangent, d1 and d2.
    pub axes: Axes,
    /// Force (N) and moment about the end (N m) at a time (s), by these axes.
    pub load: Box<dyn Fn(f64) -> SpatialEndLoad + Send + Sync>,
}

impl fmt::Debug for SpatialLoadedEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut all = f.debug_struct("SpatialLoadedEnd");
        all.field("end", &self.end).field("axes", &self.axes).finish_non_exhaustive()
    }
}

/// What a load does on the place, the tangent and the vector across at an end, nine numbers: the moment M does the work
/// M . omega in a turn of the frame there, whose omega is linear in the rates of both directions.
fn on_end<D: Number>(load: &SpatialEndLoad, axes: Axes, directions: &[D; 6]) -> [D; 9] {
    let [tangent, across] = [0, 3].map(|first| from_fn(|axis| directions[first + axis]));
    let frame = Frame::new(&tangent, &across);
    let [force, moment] = [&load.force, &load.moment].map(|of| seen(of, axes, &frame));
    let twist = dot(&moment, &frame.tangent) / frame.width;
    let slant = dot(&across, &frame.tangent) / frame.stretch;
    let bending = scaled(&cross(&moment, &frame.tangent), frame.stretch.recip());
    let on_tangent = sum(&bending, &scaled(&frame.second, -twist * slant));
    let on_across = scaled(&frame.second, twist);
    from_fn(|i| [force, on_tangent, on_across][i / 3][i % 3])
}

/// A vector with components along these axes, as places are seen.
fn seen<D: Number>(of: &Vector3<f64>, axes: Axes, frame: &Frame<D>) -> [D; 3] {
    let [x, y, z] = from_fn(|axis| D::from(of[axis]));
    match axes {
        Axes::Fixed => [x, y, z],
        Axes::OfSection => {
            let across = sum(&scaled(&frame.first, y), &scaled(&frame.second, z));
            sum(&scaled(&frame.tangent, x), &across)
        }
    }
}

impl SpatialLoadedEnd {
    /// The tangent and the vector across.
    fn directions(first: usize, coordinates: &DVector<f64>) -> [f64; 6] {
        coordinates.fixed_rows::<6>(first + 3).into_owned().into()
    }

    /// The load at a time (s), by the axes that places are seen in.
    pub(super) fn at(
        &self,
        rod: &SpatialRod,
        coordinates: &DVector<f64>,
        time: f64,
    ) -> SpatialEndLoad {
        let SpatialEndLoad { force, moment } = (self.load)(time);
        let directions = Self::directions(rod.first_coordinate(self.end), coordinates);
        let [tangent, across] = [0, 3].map(|first| from_fn(|axis| directions[first + axis]));
        let frame = Frame::new(&tangent, &across);
        let [force, moment] = [force, moment].map(|of| Vector3::from(seen(&of, self.axes, &frame)));
        SpatialEndLoad { force, moment }
    }

    fn on_end_at(&self, first: usize, coordinates: &DVector<f64>, time: f64) -> [f64; 9] {
        on_end(&(self.load)(time), self.axes, &Self::directions(first, coordinates))
    }

    /// Subtracts the load from forces (n) on the coordinates of a rod.
    pub(super) fn subtract(
        &self,
        rod: &SpatialRod,
        coordinates: &DVector<f64>,
        time: f64,
        forces: &mut DVector<f64>,
    ) {
        let first = rod.first_coordinate(self.end);
        for (axis, part) in self.on_end_at(first, coordinates, time).iter().enumerate() {
            forces[first + axis] -= part;
        }
    }

    /// Subtracts its derivatives by the coordinates from a stiffness (n x n).
    pub(super) fn subtract_tangent(
        &self,
        rod: &SpatialRod,
        coordinates: &DVector<f64>,
        time: f64,
        stiffness: &mut DMatrix<f64>,
    ) {
        let first = rod.first_coordinate(self.end);
        let load = (self.load)(time);
        let at = Self::directions(first, coordinates);
        for column in 0..6 {
            let along = |i: usize| f64::from(u8::from(i == column));
            let at = from_fn(|i| Dual64::new(at[i], along(i)));
            for (row, part) in on_end(&load, self.axes, &at).iter().enumerate() {
                stiffness[(first + row, first + 3 + column)] -= part.eps;
            }
        }
    }

    /// Rate of work on a rod (W).
    pub(super) fn power(
        &self,
        rod: &SpatialRod,
        coordinates: &DVector<f64>,
        velocities: &DVector<f64>,
        time: f64,
    ) -> f64 {
        let first = rod.first_coordinate(self.end);
        let load = self.on_end_at(first, coordinates, time);
        load.iter().zip(velocities.iter().skip(first)).map(|(load, rate)| load * rate).sum()
    }
}
