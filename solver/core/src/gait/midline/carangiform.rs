//! `Carangiform`: a midline whose curvature is a travelling wave.

use std::f64::consts::TAU;

use super::frame::{Frames, by_curvature, smooth_ramp};
use super::natural_spline::NaturalSpline;
use super::open::{Open, stroke_at};
use crate::case::{CarangiformGait, Stroke};
use crate::gait::grid::Grid;
use crate::gait::number::Number;

/// Curvature K(s) (r (beat sin(2 pi (t/T + phase - s/L)) + bending) + bend) with the ramp r = x² (3 - 2x), x = t / ramp
/// (@novati2017), and strokes for beat and bend.
#[derive(Debug, Clone, PartialEq)]
pub struct Carangiform {
    /// Length L (m).
    pub length: f64,
    /// The wave.
    pub gait: CarangiformGait,
}

impl Carangiform {
    pub(super) fn open(&self) -> Option<Open> {
        let CarangiformGait { beat, bend, period, .. } = &self.gait;
        let strokes: Vec<Stroke> = beat.iter().chain(bend).cloned().collect();
        (!strokes.is_empty()).then(|| Open::new(strokes, *period))
    }

    pub(super) fn frames<D: Number>(&self, grid: &Grid, time: D) -> Frames<D> {
        let spline = NaturalSpline::new(&self.gait.curvature);
        let ramp = smooth_ramp(time, self.gait.ramp());
        let stroke = |stroke: &Option<Stroke>, absent: f64| {
            stroke.as_ref().map_or(D::from(absent), |stroke| stroke_at(stroke, time))
        };
        let (beat, bend) = (stroke(&self.gait.beat, 1.0), stroke(&self.gait.bend, 0.0));
        let (has_beat, has_bend) = (self.gait.beat.is_some(), self.gait.bend.is_some());
        by_curvature(grid, |along: f64| {
            let s = along / self.length;
            let phase = (time / self.gait.period + (self.gait.phase - s)) * TAU;
            // Without strokes to the last bit as without their keys
            let wave = if has_beat { phase.sin() * beat } else { phase.sin() };
            let bracket = ramp * (wave + self.gait.bending);
            let bracket = if has_bend { bracket + bend } else { bracket };
            bracket * (spline.at(s) / self.length)
        })
    }
}
