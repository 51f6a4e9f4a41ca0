//! Loads of a facet from its place and velocity, and their transposed derivatives.

use alewife_mesh::Point;
use nalgebra::SVector;

use super::curve::Curve;

/// Sines of the angle between a facet and the flow are kept this far from one, where the angle has no slope.
const STEEPEST: f64 = 1e-6;

/// Slower than this (m/s) there is no load and no direction.
const AT_REST: f64 = 1e-12;

/// A facet in three dimensions, in the plane with a third component of zero: what a load depends on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Attitude<const D: usize> {
    /// Its area times its outer normal (m2; in the plane per length).
    pub area: Point<D>,
    /// Its velocity (m/s).
    pub velocity: Point<D>,
}

/// Laws of drag and thrust, after @du2021: on a facet of area A and outer normal n that moves with the velocity
/// v at the angle of attack alpha, from 0 for a motion along it to pi/2 for one along n,
///
/// ```text
/// f = -1/2 rho A (C_d(alpha) |v| v + C_t(alpha) |v|^2 n)      where n . v > 0,
/// ```
///
/// and nothing on facets that move away from the fluid.
#[derive(Debug, Clone, PartialEq)]
pub struct FacetLaw {
    /// Density of the fluid (kg/m3).
    pub density: f64,
    /// C_d over alpha from 0 to pi/2.
    pub drag: Curve,
    /// C_t over alpha from -pi/2 to pi/2, of which the upper half is used.
    pub thrust: Curve,
}

/// What a load is made of.
struct Parts<const D: usize> {
    size: f64,
    speed: f64,
    /// n . v / |v|.
    cosine: f64,
    /// Where the curve of drag is read.
    drag_at: f64,
    /// Where the curve of thrust is read.
    thrust_at: f64,
}

impl<const D: usize> Parts<D> {
    /// None for a facet that rests or moves away from the fluid.
    fn of(attitude: &Attitude<D>) -> Option<Self> {
        let (size, speed) = (attitude.area.norm(), attitude.velocity.norm());
        if !(speed > AT_REST && size > 0.0) {
            return None;
        }
        let cosine = (attitude.area.dot(&attitude.velocity) / (size * speed)).min(1.0);
        let angle = cosine.asin();
        let (quarter, half) = (std::f64::consts::FRAC_PI_2, std::f64::consts::PI);
        (cosine > 0.0).then_some(Self {
            size,
            speed,
            cosine,
            drag_at: angle / quarter,
            thrust_at: 0.5 + angle / half,
        })
    }
}

/// Derivatives of z . f.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slopes<const D: usize> {
    /// By the area vector.
    pub area: Point<D>,
    /// By the velocity.
    pub velocity: Point<D>,
}

impl FacetLaw {
    /// The load (N).
    pub(super) fn load<const D: usize>(&self, attitude: &Attitude<D>) -> Point<D> {
        let Some(parts) = Parts::of(attitude) else { return Point::zeros() };
        let Parts { size, speed, .. } = parts;
        let drag = self.drag.value(parts.drag_at) * size * speed;
        let thrust = self.thrust.value(parts.thrust_at) * speed * speed;
        (attitude.velocity * drag + attitude.area * thrust) * (-0.5 * self.density)
    }

    /// Derivatives of z . f by attitude, and by the points of the curves, which are added to `drag` and `thrust`.
    pub(super) fn slopes<const D: usize>(
        &self,
        attitude: &Attitude<D>,
        z: &Point<D>,
        drag: &mut [f64],
        thrust: &mut [f64],
    ) -> Slopes<D> {
        let none = Slopes { area: Point::zeros(), velocity: Point::zeros() };
        let Some(parts) = Parts::of(attitude) else { return none };
        let Parts { size, speed, cosine, drag_at, thrust_at } = parts;
        let factor = -0.5 * self.density;
        let (along, across) = (attitude.velocity.dot(z), attitude.area.dot(z));
        let by_drag = factor * size * speed * along;
        let by_thrust = factor * speed * speed * across;
        self.drag.weights(drag_at, |k, share| drag[k] += by_drag * share);
        self.thrust.weights(thrust_at, |k, share| thrust[k] += by_thrust * share);
        let (c_d, c_t) = (self.drag.value(drag_at), self.thrust.value(thrust_at));
        let by_angle = by_drag * self.drag.slope(drag_at) / std::f64::consts::FRAC_PI_2
            + by_thrust * self.thrust.slope(thrust_at) / std::f64::consts::PI;
        let sine = (1.0 - cosine * cosine).sqrt();
        let by_cosine = if sine > STEEPEST { by_angle / sine } else { 0.0 };
        let (n, v) = (attitude.area / size, attitude.velocity / speed);
        let area = n * (factor * c_d * speed * along)
            + z * (factor * c_t * speed * speed)
            + (v - n * cosine) * (by_cosine / size);
        let velocity = (v * along + z * speed) * (factor * c_d * size)
            + v * (2.0 * factor * c_t * speed * across)
            + (n - v * cosine) * (by_cosine / speed);
        Slopes { area, velocity }
    }
}

/// The outer area vector of a facet with corners at these places; around an axis that of its whole ring.
pub(super) fn area<const D: usize>(corners: &[Point<D>], is_axis: bool) -> Point<D> {
    let mut area = Point::zeros();
    if D == 2 {
        let along = corners[1] - corners[0];
        let ring = if is_axis { ring(corners) } else { 1.0 };
        area[0] = along[1] * ring;
        area[1] = -along[0] * ring;
    } else {
        let (a, b) = (corners[1] - corners[0], corners[2] - corners[0]);
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            area[i] = 0.5 * (a[j] * b[k] - a[k] * b[j]);
        }
    }
    area
}

/// Length (m) of the circle around the axis through the middle of a side.
fn ring<const D: usize>(corners: &[Point<D>]) -> f64 {
    std::f64::consts::PI * (corners[0][1] + corners[1][1])
}

/// What places of the corners contribute to a derivative by the area vector.
pub(super) fn add_area_slope<const D: usize>(
    corners: &[Point<D>],
    is_axis: bool,
    slope: &Point<D>,
    corners_slope: &mut [Point<D>],
) {
    if D == 2 {
        let ring_length = if is_axis { ring(corners) } else { 1.0 };
        let mut turned = Point::<D>::zeros();
        turned[0] = -slope[1] * ring_length;
        turned[1] = slope[0] * ring_length;
        corners_slope[1] += turned;
        corners_slope[0] -= turned;
        if is_axis {
            let along = corners[1] - corners[0];
            let by_radius = std::f64::consts::PI * (slope[0] * along[1] - slope[1] * along[0]);
            corners_slope[0][1] += by_radius;
            corners_slope[1][1] += by_radius;
        }
        return;
    }
    let (a, b) = (corners[1] - corners[0], corners[2] - corners[0]);
    let cross = |x: &SVector<f64, D>, y: &SVector<f64, D>| -> Point<D> {
        Point::from_fn(|i, _| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            x[j] * y[k] - x[k] * y[j]
        })
    };
    let (by_a, by_b) = (cross(&b, slope) * 0.5, cross(slope, &a) * 0.5);
    corners_slope[1] += by_a;
    corners_slope[2] += by_b;
    corners_slope[0] -= by_a + by_b;
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law() -> FacetLaw {
        FacetLaw {
            density: 1e3,
            drag: Curve::Bezier([0.05, 0.4, 1.85, 2.05]),
            thrust: Curve::Bezier([-0.8, -0.5, 0.1, 2.5]),
        }
    }

    /// z . f by places of the corners and velocity.
    fn product<const D: usize>(
        law: &FacetLaw,
        corners: &[Point<D>],
        velocity: Point<D>,
        z: Point<D>,
        is_axis: bool,
    ) -> f64 {
        law.load(&Attitude { area: area(corners, is_axis), velocity }).dot(&z)
    }

    fn check<const D: usize>(corners: &[Point<D>], velocity: Point<D>, z: Point<D>, is_axis: bool) {
        let law = law();
        let attitude = Attitude { area: area(corners, is_axis), velocity };
        let (mut drag, mut thrust) = (vec![0.0; 4], vec![0.0; 4]);
        let slopes = law.slopes(&attitude, &z, &mut drag, &mut thrust);
        let mut by_corners = vec![Point::zeros(); corners.len()];
        add_area_slope(corners, is_axis, &slopes.area, &mut by_corners);
        let h = 1e-6;
        let close = |found: f64, above: f64, below: f64| {
            let expected = (above - below) / (2.0 * h);
            assert!((found - expected).abs() < 1e-6 * (1.0 + expected.abs()), "{found} {expected}");
        };
        for i in 0..D {
            let at = |by: f64| {
                let mut moved = velocity;
                moved[i] += by;
                product(&law, corners, moved, z, is_axis)
            };
            close(slopes.velocity[i], at(h), at(-h));
            for k in 0..corners.len() {
                let at = |by: f64| {
                    let mut moved = corners.to_vec();
                    moved[k][i] += by;
                    product(&law, &moved, velocity, z, is_axis)
                };
                close(by_corners[k][i], at(h), at(-h));
            }
        }
        for k in 0..4 {
            let at = |by: f64| {
                let mut moved = [law.clone(), law.clone()];
                moved[0].drag.points_mut()[k] += by;
                moved[1].thrust.points_mut()[k] += by;
                moved.map(|law| product(&law, corners, velocity, z, is_axis))
            };
            close(drag[k], at(h)[0], at(-h)[0]);
            close(thrust[k], at(h)[1], at(-h)[1]);
        }
    }

    #[test]
    fn slopes_are_derivatives_of_the_load() {
        let corners = [
            Point::from([0.0, 0.1, 0.0]),
            Point::from([1.0, 0.0, 0.2]),
            Point::from([0.1, 0.9, -0.1]),
        ];
        check(&corners, Point::from([0.3, 0.2, 0.4]), Point::from([1.0, -0.5, 0.7]), false);
        let side = [Point::from([0.0, 1.2]), Point::from([-0.8, 1.0])];
        check(&side, Point::from([0.3, 0.4]), Point::from([1.0, -0.5]), false);
        check(&side, Point::from([0.3, 0.4]), Point::from([1.0, -0.5]), true);
    }

    #[test]
    fn loads_are_those_of_the_formula() {
        let corners = [
            Point::from([0.0, 0.0, 0.0]),
            Point::from([2.0, 0.0, 0.0]),
            Point::from([0.0, 1.0, 0.0]),
        ];
        let at = |velocity: [f64; 3]| {
            law().load(&Attitude { area: area(&corners, false), velocity: Point::from(velocity) })
        };
        // Along the normal: C_d = 2.05 and C_t = 2.5 at the ends of the curves, A = 1
        assert!((at([0.0, 0.0, 2.0])[2] + 0.5e3 * 4.0 * (2.05 + 2.5)).abs() < 1e-9);
        assert_eq!(at([0.0, 0.0, -2.0]), Point::<3>::zeros());
        assert_eq!(at([0.0, 0.0, 0.0]), Point::<3>::zeros());
        let slant = at([1.0, 0.0, 1.0]);
        let drag = law().drag.value(0.5) * 2f64.sqrt();
        let thrust = law().thrust.value(0.75) * 2.0;
        assert!((slant[0] + 0.5e3 * drag).abs() < 1e-9);
        assert!((slant[2] + 0.5e3 * (drag + thrust)).abs() < 1e-9);
    }
}
