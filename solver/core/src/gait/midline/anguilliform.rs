//! `Anguilliform`: an inextensible midline whose displacement is a travelling wave of arc length.

use std::f64::consts::TAU;

use num_dual::{Dual2, DualNum};

use super::frame::{Frames, by_displacement, smooth_ramp};
use crate::case::AnguilliformGait;
use crate::gait::grid::Grid;
use crate::gait::number::Number;

/// Displacement y = amplitude (s + offset L) sin(2 pi (s/L - t/T - phase)), ramped by x² (3 - 2x),
/// x = t / ramp; material points keep their arc length (@kern2006).
#[derive(Debug, Clone, PartialEq)]
pub struct Anguilliform {
    /// Length L (m).
    pub length: f64,
    /// The wave.
    pub gait: AnguilliformGait,
}

impl Anguilliform {
    pub(super) fn frames<D: Number>(&self, grid: &Grid, time: D) -> Frames<D> {
        let ramp = smooth_ramp(time, self.gait.ramp());
        by_displacement(grid, |s: Dual2<D>| {
            let phase = s / self.length - Dual2::from_re(time / self.gait.period + self.gait.phase);
            let envelope = (s + self.gait.offset * self.length) * self.gait.amplitude;
            (phase * TAU).sin() * envelope * Dual2::from_re(ramp)
        })
    }
}
