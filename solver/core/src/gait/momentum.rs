//! `Interior`: centre, moment of inertia and angular momentum of a body about its midline.
//!
//! The interior is mapped by X(s, t) + y(s, m, t) n(s, t), m in [-1, 1], with y + k y² / 2 =
//! (w/g) m + k (w/g)² / 2, curvature k and stretch g of the midline. Then dA = w dm ds at all times:
//! the interior is incompressible, so its linear momentum is area times velocity of the centre.

use alewife_mesh::GaussRule;
use num_dual::Dual64;

use super::grid::Node;
use super::midline::Frame;
use super::number::{Number, cross};

/// Gauss points across the width.
const POINTS: usize = 4;

/// Integrals over the interior.
#[derive(Debug, Clone, Copy)]
pub struct Interior {
    /// Centre of area (m), and its velocity (m/s).
    pub center: [Dual64; 2],
    /// Second moment about the centre (m⁴).
    pub inertia: f64,
    /// Angular momentum about the centre, per density (m⁴/s).
    pub angular_momentum: f64,
}

/// Distance of a point of the interior from the midline along its normal (m).
pub fn offset<D: Number>(frame: &Frame<D>, half_width: f64, across: f64) -> D {
    let width = frame.stretch.recip() * half_width;
    let k = frame.curvature;
    let reach = width * across + k * width * width * 0.5;
    reach * 2.0 / ((k * reach * 2.0 + 1.0).sqrt() + 1.0)
}

impl Interior {
    /// Of a midline at the nodes of a grid.
    pub fn of(nodes: &[Node], frames: &[Frame<Dual64>]) -> Self {
        let rule = GaussRule::new(POINTS);
        let (mut area, mut turning) = (0.0, 0.0);
        let zero = Dual64::from(0.0);
        let (mut first, mut second) = ([zero; 2], 0.0);
        // About a point inside, so that no digits are lost
        let middle = frames[frames.len() / 2].position.map(|part| Dual64::from(part.re));
        for (node, frame) in nodes.iter().zip(frames) {
            let normal = frame.normal();
            for (x, weight) in rule.points.iter().zip(&rule.weights) {
                let part = 2.0 * weight * node.weight * node.half_width;
                let y = offset(frame, node.half_width, 2.0 * x - 1.0);
                let position = [0, 1].map(|i| frame.position[i] + normal[i] * y - middle[i]);
                let [at, rate] = [position.map(|p| p.re), position.map(|p| p.eps)];
                area += part;
                first = [0, 1].map(|i| first[i] + position[i] * part);
                second += part * (at[0] * at[0] + at[1] * at[1]);
                turning += part * cross(at, rate);
            }
        }
        let center = first.map(|moment| moment / area);
        let [at, rate] = [center.map(|p| p.re), center.map(|p| p.eps)];
        Self {
            center: [0, 1].map(|i| center[i] + middle[i]),
            inertia: second - area * (at[0] * at[0] + at[1] * at[1]),
            angular_momentum: turning - area * cross(at, rate),
        }
    }
}
