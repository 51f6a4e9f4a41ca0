//! Points of an axis-parallel ellipse: by quarter and eccentric angle, and nearest to a point.

use std::f64::consts::FRAC_PI_2;

use super::foot::Foot;
use crate::Point;

/// Cosine and sine of (quarter + parameter) π/2, exact at the ends of the quarter.
pub fn cosine_and_sine(quarter: usize, parameter: f64) -> [f64; 2] {
    let (c, s) = if parameter >= 1.0 {
        (0.0, 1.0)
    } else {
        ((parameter * FRAC_PI_2).cos(), (parameter * FRAC_PI_2).sin())
    };
    match quarter % 4 {
        0 => [c, s],
        1 => [-s, c],
        2 => [-c, -s],
        _ => [s, -c],
    }
}

/// Nearest point of an axis-parallel ellipse, normal and curvature there.
///
/// With x, y >= 0 the foot is (a² x / (t + a²), b² y / (t + b²)) for the largest root t of
/// (a x / (t + a²))² + (b y / (t + b²))² = 1, which is bracketed and found by bisected Newton.
///
/// # Source
/// @eberly2013, distance from a point to an ellipse.
pub fn nearest([a, b]: [f64; 2], point: Point<2>) -> Foot {
    let (x, y) = (point.x.abs(), point.y.abs());
    let foot = if a == b {
        let r = x.hypot(y);
        if r > 0.0 { Point::<2>::new(a * x / r, a * y / r) } else { Point::<2>::new(a, 0.0) }
    } else if a > b {
        foot_on_ellipse(a, b, x, y)
    } else {
        let foot = foot_on_ellipse(b, a, y, x);
        Point::<2>::new(foot.y, foot.x)
    };
    let foot = Point::<2>::new(foot.x.copysign(point.x), foot.y.copysign(point.y));
    let gradient = Point::<2>::new(foot.x / (a * a), foot.y / (b * b));
    let steepness = gradient.norm();
    let curvature = 1.0 / (a * a * b * b * steepness.powi(3));
    Foot { point: foot, normal: gradient / steepness, curvature }
}

/// Foot of the perpendicular on an ellipse with a > b, in the first quadrant.
pub fn foot_on_ellipse(a: f64, b: f64, x: f64, y: f64) -> Point<2> {
    if y <= 0.0 {
        let reach = (a * a - b * b) / a;
        return if x < reach {
            let cos = a * x / (a * a - b * b);
            Point::<2>::new(a * cos, b * (1.0 - cos * cos).max(0.0).sqrt())
        } else {
            Point::<2>::new(a, 0.0)
        };
    }
    // With s = t + b^2, which keeps its digits where the point is next to the long axis
    let c = a * a - b * b;
    let excess = |s: f64| {
        let (p, q) = (a * x / (s + c), b * y / s);
        let slope = -2.0 * (p * p / (s + c) + q * q / s);
        (p * p + q * q - 1.0, slope)
    };
    // Each term alone is at most one, both together at least
    let (mut low, mut high) = ((b * y).max(a * x - c), (a * x).hypot(b * y));
    let mut s = low;
    for _ in 0..200 {
        let (value, slope) = excess(s);
        if value > 0.0 {
            low = low.max(s);
        } else {
            high = high.min(s);
        }
        let newton = s - value / slope;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        let has_settled = (next - s).abs() <= 1e-16 * s;
        s = next;
        if has_settled {
            break;
        }
    }
    let foot = Point::<2>::new(a * a * x / (s + c), b * b * y / s);
    // Rounding leaves the foot a little off the curve: push it back along its ray
    foot / (foot.x / a).hypot(foot.y / b)
}
