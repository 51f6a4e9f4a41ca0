//! `SpatialLoadedEnd`: a force that is given at an end of a rod in space.

use std::fmt;

use nalgebra::{DVector, Vector3};

use super::spatial_rod::SpatialRod;
use crate::rod::end::End;

/// An end of a rod in space with a force that depends on time alone.
pub struct SpatialLoadedEnd {
    /// Which end.
    pub end: End,
    /// Force (N) at a time (s), by the axes that places are seen in.
    pub force: Box<dyn Fn(f64) -> Vector3<f64> + Send + Sync>,
}

impl fmt::Debug for SpatialLoadedEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SpatialLoadedEnd").field("end", &self.end).finish_non_exhaustive()
    }
}

impl SpatialLoadedEnd {
    /// Subtracts the force from forces (n) on the coordinates of a rod.
    pub(super) fn subtract(&self, rod: &SpatialRod, time: f64, forces: &mut DVector<f64>) {
        let mut place = forces.fixed_rows_mut::<3>(rod.first_coordinate(self.end));
        place -= (self.force)(time);
    }

    /// Rate of work on a rod (W).
    pub(super) fn power(&self, rod: &SpatialRod, velocities: &DVector<f64>, time: f64) -> f64 {
        (self.force)(time).dot(&velocities.fixed_rows::<3>(rod.first_coordinate(self.end)))
    }
}
