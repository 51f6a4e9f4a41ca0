//! `Carangiform`: a midline whose curvature is a travelling wave.

use std::f64::consts::TAU;

use super::frame::{Frame, Frames, smooth_ramp};
use super::natural_spline::NaturalSpline;
use crate::gait::grid::Grid;
use crate::gait::number::Number;

/// Curvature K(s) (sin(2 pi (t/T + phase - s/L)) + bending), ramped (@novati2017).
#[derive(Debug, Clone, PartialEq)]
pub struct Carangiform {
    /// Length L (m).
    pub length: f64,
    /// Positions s/L, ascending, and K L there, joined by a natural cubic spline.
    pub curvature: Vec<[f64; 2]>,
    /// Constant part of the bracket, which steers.
    pub bending: f64,
    /// Period T (s).
    pub period: f64,
    /// Start in the period (periods).
    pub phase: f64,
    /// Duration of the ramp x² (3 - 2x), x = t / ramp (s).
    pub ramp: f64,
}

impl Carangiform {
    pub(super) fn frames<D: Number>(&self, grid: &Grid, time: D) -> Frames<D> {
        let spline = NaturalSpline::new(&self.curvature);
        let ramp = smooth_ramp(time, self.ramp);
        let curvature = |along: f64| {
            let s = along / self.length;
            let phase = (time / self.period + (self.phase - s)) * TAU;
            ramp * (phase.sin() + self.bending) * (spline.at(s) / self.length)
        };
        let curvatures: Vec<D> = grid.nodes.iter().map(|node| curvature(node.along)).collect();
        let zero = D::from(0.0);
        let angles = grid.integrate(&curvatures, zero);
        // From head to tail the straight midline runs along -x
        let tangent = |angle: &D| {
            let (sin, cos) = angle.sin_cos();
            [-cos, -sin]
        };
        let tangents: Vec<[D; 2]> = angles.nodes.iter().map(tangent).collect();
        let part = |axis: usize| -> Vec<D> { tangents.iter().map(|t| t[axis]).collect() };
        let x = grid.integrate(&part(0), zero);
        let y = grid.integrate(&part(1), zero);
        let one = D::from(1.0);
        let nodes = (0..x.nodes.len()).map(|i| Frame {
            position: [x.nodes[i], y.nodes[i]],
            tangent: tangents[i],
            stretch: one,
            curvature: curvatures[i],
        });
        let stations = (0..x.stations.len()).map(|i| Frame {
            position: [x.stations[i], y.stations[i]],
            tangent: tangent(&angles.stations[i]),
            stretch: one,
            curvature: curvature(grid.stations[i].along),
        });
        Frames { nodes: nodes.collect(), stations: stations.collect() }
    }
}
