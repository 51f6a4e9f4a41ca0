//! `Ellipsoid`: its nearest point, by Newton's method, and its curvature.

use super::Foot;
use crate::Point;

/// Iterations after which the nearest point is taken as it is; far from the middle it needs five.
const MOST_ITERATIONS: usize = 80;

/// An ellipsoid about the origin with its axes along x, y and z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ellipsoid {
    semi_axes: Point<3>,
}

impl Ellipsoid {
    /// An ellipsoid with these semi-axes (m), all positive.
    #[must_use]
    pub fn new(semi_axes: [f64; 3]) -> Self {
        Self { semi_axes: Point::from(semi_axes) }
    }

    /// The longest semi-axis (m).
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.semi_axes.max()
    }

    /// The shortest semi-axis (m).
    #[must_use]
    pub fn inner_radius(&self) -> f64 {
        self.semi_axes.min()
    }

    /// The nearest point to a point (m) of its frame, the normal outward.
    ///
    /// It is x_i = a_i² y_i / (a_i² + t) for the one t above minus the smallest a_i² that puts it on
    /// the ellipsoid; t is a multiple of the distance. Newton's method is applied to
    /// 1 / |x_i / a_i| - 1, which is nearly linear in t, from a t below the root.
    #[must_use]
    pub fn foot(&self, of: Point<3>) -> Foot {
        let a = self.semi_axes;
        let squares = a.component_mul(&a);
        let least = a.min() * a.min();
        let start = a.component_mul(&of.abs()) - squares;
        let mut t = start.max();
        let mut is_found = false;
        for _ in 0..MOST_ITERATIONS {
            let shifted = squares.add_scalar(t);
            if shifted.min() <= 1e-14 * least {
                break;
            }
            // x_i / a_i, whose squares add up to 1 on the ellipsoid
            let unit = a.component_mul(&of).component_div(&shifted);
            let sum = unit.norm_squared();
            if sum < 1e-28 {
                break;
            }
            let slope = -2.0 * unit.component_mul(&unit).component_div(&shifted).sum();
            let step = 2.0 * sum * (1.0 - sum.sqrt()) / slope;
            t += step;
            is_found = true;
            if step.abs() <= 1e-15 * (t.abs() + least) {
                break;
            }
        }
        let mut point = if is_found && t > -least {
            squares.component_mul(&of).component_div(&squares.add_scalar(t))
        } else {
            self.far_foot(of)
        };
        // Onto the surface to the last bit
        let norm = point.component_div(&a).norm();
        if norm > 0.0 {
            point /= norm;
        }
        let normal = point.component_div(&squares).normalize();
        Foot { point, normal, gap: (of - point).dot(&normal) }
    }

    /// The nearest point to one in the plane across the shortest axis, near the middle: there are
    /// two, above and below.
    fn far_foot(&self, of: Point<3>) -> Point<3> {
        let a = self.semi_axes;
        let shortest = a.imin();
        let least = a[shortest] * a[shortest];
        let mut point = Point::<3>::zeros();
        let mut rest = 1.0;
        for i in 0..3 {
            let apart = a[i] * a[i] - least;
            if i != shortest && apart > 1e-12 * least {
                point[i] = a[i] * a[i] * of[i] / apart;
                rest -= (point[i] / a[i]) * (point[i] / a[i]);
            }
        }
        let side = if of[shortest] < 0.0 { -1.0 } else { 1.0 };
        point[shortest] = side * a[shortest] * rest.max(0.0).sqrt();
        point
    }

    /// Radius (m) of the largest ball inside that touches it at one of its points.
    ///
    /// The centre of the ball is where the normal meets the plane across the shortest axis.
    #[must_use]
    pub fn radius_inside(&self, on: Point<3>) -> f64 {
        let a = self.semi_axes;
        let least = a.min();
        least * least * on.component_div(&a.component_mul(&a)).norm()
    }

    /// Smallest radius of curvature (m) at one of its points.
    #[must_use]
    pub fn radius_of_curvature(&self, on: Point<3>) -> f64 {
        let a = self.semi_axes;
        let squares = a.component_mul(&a);
        let product = a.product();
        let slope = on.component_div(&squares).norm();
        let gauss = (product * slope * slope).powi(-2);
        let mean = (squares.sum() - on.norm_squared()) / (2.0 * product * product * slope.powi(3));
        1.0 / (mean + (mean * mean - gauss).max(0.0).sqrt())
    }
}
