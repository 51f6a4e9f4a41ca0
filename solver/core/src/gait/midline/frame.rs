//! `Frame`: position, tangent, stretch and curvature at a point of a midline.

use num_dual::{Dual2, second_derivative};

use crate::gait::grid::Grid;
use crate::gait::number::Number;

/// A midline at one of its points.
#[derive(Debug, Clone, Copy)]
pub struct Frame<D> {
    /// Its position (m).
    pub position: [D; 2],
    /// Unit tangent, from head to tail.
    pub tangent: [D; 2],
    /// Length over that at rest.
    pub stretch: D,
    /// Curvature, counter-clockwise from head to tail (1/m).
    pub curvature: D,
}

impl<D: Number> Frame<D> {
    /// Of a straight midline.
    pub fn straight(along: f64) -> Self {
        let (zero, one) = (D::from(0.0), D::from(1.0));
        Self {
            position: [D::from(-along), zero],
            tangent: [-one, zero],
            stretch: one,
            curvature: zero,
        }
    }

    /// Unit normal: upwards, with the head towards +x.
    pub fn normal(&self) -> [D; 2] {
        [self.tangent[1], -self.tangent[0]]
    }
}

/// A midline at the nodes and at the stations of a grid.
#[derive(Debug, Clone)]
pub struct Frames<D> {
    pub nodes: Vec<Frame<D>>,
    pub stations: Vec<Frame<D>>,
}

/// x² (3 - 2x) from zero to one, with x = t / duration: its rate is continuous.
pub fn smooth_ramp<D: Number>(time: D, duration: f64) -> D {
    if time < D::from(0.0) {
        return D::from(0.0);
    }
    if time >= D::from(duration) {
        return D::from(1.0);
    }
    let x = time / duration;
    x * x * (-x * 2.0 + 3.0)
}

/// The midline that keeps its length, with a curvature (1/m) by the distance from the head (m).
pub fn by_curvature<D: Number>(grid: &Grid, curvature: impl Fn(f64) -> D) -> Frames<D> {
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

/// The midline that keeps its length, with a displacement across the straight one (m) by the distance from the head
/// along it (m).
pub fn by_displacement<D: Number>(
    grid: &Grid,
    displacement: impl Fn(Dual2<D>) -> Dual2<D>,
) -> Frames<D> {
    // Displacement, slope and second derivative along the midline
    let lateral = |along: f64| second_derivative(&displacement, D::from(along));
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
