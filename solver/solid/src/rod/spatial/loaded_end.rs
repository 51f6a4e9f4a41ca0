//! `SpatialLoadedEnd`: a force and a moment that are given at an end of a rod in space.

use std::array::from_fn;
use std::fmt;

use nalgebra::{DMatrix, DVector, Vector3};
use num_dual::Dual64;

use super::ends::SpatialEndLoad;
use super::frame::{Frame, cross, dot, scaled, sum};
use super::spatial_rod::SpatialRod;
use crate::rod::end::End;
use crate::rod::kinematics::Number;

/// An end of a rod in space with a load that depends on time alone: it keeps its axes as the end turns.
///
/// Such a moment has no potential: what it does on the way to a frame depends on the way, and its derivatives by the
/// coordinates are not symmetric.
pub struct SpatialLoadedEnd {
    /// Which end.
    pub end: End,
    /// Force (N) and moment about the end (N m) at a time (s), by the axes that places are seen in.
    pub load: Box<dyn Fn(f64) -> SpatialEndLoad + Send + Sync>,
}

impl fmt::Debug for SpatialLoadedEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SpatialLoadedEnd").field("end", &self.end).finish_non_exhaustive()
    }
}

/// Forces of a moment M on the tangent and the vector across at an end, six numbers: the moment does the work M . omega in a
/// turn of the frame there, whose omega is linear in the rates of both.
fn of_moment<D: Number>(moment: &Vector3<f64>, directions: &[D; 6]) -> [D; 6] {
    let [tangent, across] = [0, 3].map(|first| from_fn(|axis| directions[first + axis]));
    let moment = from_fn(|axis| D::from(moment[axis]));
    let frame = Frame::new(&tangent, &across);
    let twist = dot(&moment, &frame.tangent) / frame.width;
    let slant = dot(&across, &frame.tangent) / frame.stretch;
    let bending = scaled(&cross(&moment, &frame.tangent), frame.stretch.recip());
    let on_tangent = sum(&bending, &scaled(&frame.second, -twist * slant));
    let on_across = scaled(&frame.second, twist);
    from_fn(|i| if i < 3 { on_tangent[i] } else { on_across[i - 3] })
}

impl SpatialLoadedEnd {
    /// The tangent and the vector across.
    fn directions(first: usize, coordinates: &DVector<f64>) -> [f64; 6] {
        coordinates.fixed_rows::<6>(first + 3).into_owned().into()
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
        let SpatialEndLoad { force, moment } = (self.load)(time);
        let on_directions = of_moment(&moment, &Self::directions(first, coordinates));
        for (axis, part) in force.iter().chain(&on_directions).enumerate() {
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
        let SpatialEndLoad { moment, .. } = (self.load)(time);
        let at = Self::directions(first, coordinates);
        for column in 0..6 {
            let along = |i: usize| f64::from(u8::from(i == column));
            let at = from_fn(|i| Dual64::new(at[i], along(i)));
            for (row, part) in of_moment(&moment, &at).iter().enumerate() {
                stiffness[(first + 3 + row, first + 3 + column)] -= part.eps;
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
        let SpatialEndLoad { force, moment } = (self.load)(time);
        let on_directions = of_moment(&moment, &Self::directions(first, coordinates));
        let load = force.iter().chain(&on_directions);
        load.zip(velocities.iter().skip(first)).map(|(load, rate)| load * rate).sum()
    }
}
