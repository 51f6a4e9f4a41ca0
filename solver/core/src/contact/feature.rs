//! `Feature`: a close pair of places, and how its gap changes as the bodies move.

use alewife_mesh::{Closest, Point};
use nalgebra::{Matrix6, Vector3, Vector6};

use crate::body::Wrench;

/// What a body faces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Partner {
    /// Another body, or an image of one across a periodic side.
    Body(usize),
    /// A side of the domain, by its number.
    Wall(usize),
}

/// A place where a body is near another body or a wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Feature {
    /// The body.
    pub body: usize,
    /// What it faces.
    pub partner: Partner,
    /// Points, normal out of the partner, gap and curvatures.
    pub at: Closest,
    /// From the centres of mass of body and partner to their points (m).
    pub levers: [Point<2>; 2],
    /// Share of the law's force, from 0 to 1.
    pub weight: f64,
    /// Whether only the motion along the axis counts.
    pub is_axisymmetric: bool,
}

/// Regularity of a feature times the reach of the smaller body above which it counts in full.
const REGULAR: f64 = 0.5;

/// Gives the features of one pair of surfaces their weights.
///
/// A feature ends where it meets a maximum of the distance, as a hollow fills up that a body rolls
/// through. Its force must have faded before, or there may be no balance of forces at all. The
/// weight goes to zero there with the square of the regularity; what is nearest of a pair, and what
/// is as regular as that, has the weight one whatever its own.
pub(super) fn weigh(features: &mut [Feature], size: f64, range: f64) {
    let raw = |feature: &Feature| {
        let s = (feature.at.regularity() * size / REGULAR).clamp(0.0, 1.0);
        s * s * (3.0 - 2.0 * s)
    };
    let nearest = features.iter().map(|feature| feature.at.gap).fold(f64::INFINITY, f64::min);
    // A feature at the range has no force, and no say
    let say = |feature: &Feature| (range - feature.at.gap) / (range - nearest);
    let most = features.iter().map(|feature| raw(feature) * say(feature)).fold(0.0, f64::max);
    for feature in features {
        feature.weight = if most > 0.0 { (raw(feature) / most).min(1.0) } else { 1.0 };
    }
}

/// Third component of the cross product.
fn cross(a: Point<2>, b: Point<2>) -> f64 {
    a.x * b.y - a.y * b.x
}

impl Feature {
    /// Derivative of the gap by x, y, angle of the body, then of the partner.
    ///
    /// It is also the direction of the load: the force times this is what acts on both.
    #[must_use]
    pub fn gradient(&self) -> Vector6<f64> {
        let n = self.at.normal;
        if self.is_axisymmetric {
            return Vector6::new(n.x, 0.0, 0.0, -n.x, 0.0, 0.0);
        }
        let turn = self.levers.map(|lever| cross(lever, n));
        Vector6::new(n.x, n.y, turn[0], -n.x, -n.y, -turn[1])
    }

    /// Second derivative of the gap by the same coordinates.
    ///
    /// Both contact points slide along their curves, by s and r along the tangent t, as the normal
    /// n turns by f: f = w_a - k_a s = w_b + k_b r (w the turns of the bodies, k the curvatures)
    /// and t . (v_a - v_b) + s - r = g f. From g' = n . (v_a - v_b) follows, with levers l,
    /// g'' = f t . (v_a - v_b) - w_a^2 n . l_a - w_a s + w_b^2 n . l_b + w_b r.
    #[must_use]
    pub fn hessian(&self) -> Matrix6<f64> {
        let (n, gap, [ka, kb]) = (self.at.normal, self.at.gap, self.at.curvatures);
        let t = Point::<2>::new(-n.y, n.x);
        let regularity = ka + kb + gap * ka * kb;
        // Parallel sides have no definite contact points
        if regularity.abs() <= 1e-9 * (ka.abs() + kb.abs()) {
            return Matrix6::zeros();
        }
        let [on_a, on_b] = self.levers.map(|lever| cross(lever, t));
        let across = Vector6::new(t.x, t.y, on_a, -t.x, -t.y, -on_b);
        let (turn_a, turn_b) = (Vector6::ith(2, 1.0), Vector6::ith(5, 1.0));
        let swing = (across * (ka * kb) + turn_a * kb + turn_b * ka) / regularity;
        let slide_a = (turn_a * (1.0 + gap * kb) - across * kb - turn_b) / regularity;
        let slide_b = (across * ka + turn_a - turn_b * (1.0 + gap * ka)) / regularity;
        let form = swing * across.transpose()
            + turn_a * (turn_a * -n.dot(&self.levers[0]) - slide_a).transpose()
            + turn_b * (turn_b * n.dot(&self.levers[1]) + slide_b).transpose();
        let mut hessian = 0.5 * (form + form.transpose());
        if self.is_axisymmetric {
            let along = hessian.clone_owned();
            hessian = Matrix6::zeros();
            for (i, j) in [(0, 0), (0, 3), (3, 0), (3, 3)] {
                hessian[(i, j)] = along[(i, j)];
            }
        }
        hessian
    }

    /// Loads on the body and on its partner by a repulsive force (N; N/m planar).
    #[must_use]
    pub fn loads(&self, force: f64) -> [Wrench; 2] {
        let load = self.gradient() * force;
        [0, 3].map(|i| Wrench {
            force: Vector3::new(load[i], load[i + 1], 0.0),
            torque: Vector3::new(0.0, 0.0, load[i + 2]),
        })
    }
}
