//! `Frame`: position, tangent, stretch and curvature at a point of a midline.

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
