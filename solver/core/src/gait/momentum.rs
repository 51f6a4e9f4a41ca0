//! `Interior`: centre, moment of inertia and angular momentum of a body about its midline.
//!
//! The interior is mapped by X(s, t) + y(s, m, t) n(s, t), m in [-1, 1], with y + k y² / 2 =
//! (w/g) m + k (w/g)² / 2, curvature k and stretch g of the midline. Then dA = w dm ds at all times:
//! the interior is incompressible, so its linear momentum is area times velocity of the centre.
//!
//! In space widths and heights change like g^(-1/2). With z = h g^(-1/2) sin(a) and the chord of the
//! section there, w g^(-1/2) cos(a), in place of w/g above, dV = w h cos(a)² dm da ds: incompressible, too.

use std::f64::consts::PI;

use alewife_mesh::GaussRule;
use num_dual::Dual64;

use super::grid::Node;
use super::midline::Frame;
use super::number::{Number, cross};

/// Gauss points across the width.
const POINTS: usize = 4;

/// Chords of a section in space, of each half: midpoints of angles, exact for their trigonometric polynomials.
const CHORDS: usize = 4;

/// Integrals over the interior.
#[derive(Debug, Clone, Copy)]
pub struct Interior {
    /// Centre of area or volume (m), and its velocity (m/s).
    pub center: [Dual64; 2],
    /// Second moment about the axis through the centre across the plane (m⁴; m⁵ in space).
    pub inertia: f64,
    /// Angular momentum about it, per density (m⁴/s; m⁵/s).
    pub angular_momentum: f64,
}

/// What a body is about its midline.
#[derive(Debug, Clone, Copy)]
pub enum Across<'a> {
    /// Widths in the plane.
    Plane,
    /// Elliptic sections with these half heights (m) at the nodes of the grid.
    Space(&'a [f64]),
}

/// Lines of the interior along the normal, a part of the half width long.
#[derive(Debug, Clone, Copy)]
struct Chord {
    part: f64,
    weight: f64,
}

impl Across<'_> {
    /// Factor of widths and heights where the midline is stretched.
    pub fn narrowing<D: Number>(&self, frame: &Frame<D>) -> D {
        match self {
            Self::Plane => frame.stretch.recip(),
            Self::Space(_) => frame.stretch.sqrt().recip(),
        }
    }

    /// The chords of a section at a node, weighted by its height.
    fn chords(&self, node: usize) -> Vec<Chord> {
        match self {
            Self::Plane => vec![Chord { part: 1.0, weight: 1.0 }],
            Self::Space(heights) => {
                let step = 0.5 * PI / CHORDS as f64;
                let chord = |i: usize| {
                    let part = (step * (i as f64 + 0.5)).cos();
                    Chord { part, weight: 2.0 * step * heights[node] * part }
                };
                (0..CHORDS).map(chord).collect()
            }
        }
    }
}

/// Distance of a point of the interior from the midline along its normal (m).
pub fn offset<D: Number>(frame: &Frame<D>, width: D, across: f64) -> D {
    let k = frame.curvature;
    let reach = width * across + k * width * width * 0.5;
    reach * 2.0 / ((k * reach * 2.0 + 1.0).sqrt() + 1.0)
}

impl Interior {
    /// Of a midline at the nodes of a grid.
    pub fn of(nodes: &[Node], frames: &[Frame<Dual64>], body: Across<'_>) -> Self {
        let rule = GaussRule::new(POINTS);
        let (mut area, mut turning) = (0.0, 0.0);
        let zero = Dual64::from(0.0);
        let (mut first, mut second) = ([zero; 2], 0.0);
        // About a point inside, so that no digits are lost
        let middle = frames[frames.len() / 2].position.map(|part| Dual64::from(part.re));
        for (index, (node, frame)) in nodes.iter().zip(frames).enumerate() {
            let normal = frame.normal();
            let narrowing = body.narrowing(frame);
            let chords = body.chords(index);
            let points = rule.points.iter().zip(&rule.weights);
            for (chord, (x, weight)) in
                chords.iter().flat_map(|c| points.clone().map(move |p| (c, p)))
            {
                let half_width = node.half_width * chord.part;
                let part = 2.0 * weight * node.weight * half_width * chord.weight;
                let y = offset(frame, narrowing * half_width, 2.0 * x - 1.0);
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
