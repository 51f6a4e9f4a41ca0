//! `Anguilliform`: an inextensible midline whose displacement is a travelling wave of arc length.

use std::f64::consts::TAU;

use num_dual::{Dual2, DualNum, second_derivative};

use super::frame::{Frame, Frames, smooth_ramp};
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
        // Displacement, slope and second derivative along the midline
        let lateral = |along: f64| {
            let wave = |s: Dual2<D>| {
                let phase =
                    s / self.length - Dual2::from_re(time / self.gait.period + self.gait.phase);
                let envelope = (s + self.gait.offset * self.length) * self.gait.amplitude;
                (phase * TAU).sin() * envelope * Dual2::from_re(ramp)
            };
            second_derivative(wave, D::from(along))
        };
        let advance = |slope: D| -(-slope * slope + 1.0).sqrt();
        let at_nodes: Vec<_> = grid.nodes.iter().map(|node| lateral(node.along)).collect();
        let rates: Vec<D> = at_nodes.iter().map(|(_, slope, _)| advance(*slope)).collect();
        let x = grid.integrate(&rates, D::from(0.0));
        let frame = |x: D, (y, slope, bend): (D, D, D)| {
            let advance = advance(slope);
            Frame {
                position: [x, y],
                tangent: [advance, slope],
                stretch: D::from(1.0),
                curvature: bend / advance,
            }
        };
        let nodes = x.nodes.iter().zip(at_nodes).map(|(x, lateral)| frame(*x, lateral));
        let stations = x.stations.iter().zip(&grid.stations);
        let stations = stations.map(|(x, at)| frame(*x, lateral(at.along)));
        Frames { nodes: nodes.collect(), stations: stations.collect() }
    }
}
