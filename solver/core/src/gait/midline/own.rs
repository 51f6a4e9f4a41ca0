//! `Own`: a midline by an expression or a table of the case.

use num_dual::Dual2;

use super::frame::{Frames, by_curvature, by_displacement, smooth_ramp};
use crate::case::{MidlineGait, MidlineLaw, MidlineValues};
use crate::gait::grid::Grid;
use crate::gait::number::Number;

/// Curvature, or displacement across the straight body, ramped by x² (3 - 2x), x = t / ramp.
#[derive(Debug, Clone, PartialEq)]
pub struct Own {
    /// Length L (m).
    pub length: f64,
    /// Period, ramp and kind.
    pub gait: MidlineGait,
    /// Values by position and time.
    pub law: MidlineLaw,
}

impl Own {
    pub(super) fn frames<D: Number>(&self, grid: &Grid, time: D) -> Frames<D> {
        let ramp = smooth_ramp(time, self.gait.ramp());
        match self.gait.kind() {
            MidlineValues::Curvature => by_curvature(grid, |along| {
                let position = D::from(along / self.length);
                ramp * self.law.value(position, time) / self.length
            }),
            MidlineValues::Lateral => by_displacement(grid, |along: Dual2<D>| {
                let value = self.law.value(along / self.length, Dual2::from_re(time));
                value * Dual2::from_re(ramp) * self.length
            }),
        }
    }
}
