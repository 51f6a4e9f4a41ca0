//! `Carangiform`: a midline whose curvature is a travelling wave.

use std::f64::consts::TAU;

use super::frame::{Frame, Frames, smooth_ramp};
use super::natural_spline::NaturalSpline;
use crate::case::CarangiformGait;
use crate::gait::grid::Grid;
use crate::gait::number::Number;

/// Curvature K(s) (sin(2 pi (t/T + phase - s/L)) + bending), ramped by x² (3 - 2x), x = t / ramp
/// (@novati2017).
#[derive(Debug, Clone, PartialEq)]
pub struct Carangiform {
    /// Length L (m).
    pub length: f64,
    /// The wave.
    pub gait: CarangiformGait,
}

impl Carangiform {
    pub(super) fn frames<D: Number>(&self, grid: &Grid, time: D) -> Frames<D> {
        let spline = NaturalSpline::new(&self.gait.curvature);
        let ramp = smooth_ramp(time, self.gait.ramp());
        let curvature = |along: f64| {
            let s = along / self.length;
            let phase = (time / self.gait.period + (self.gait.phase - s)) * TAU;
            ramp * (phase.sin() + self.gait.bending) * (spline.at(s) / self.length)
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
