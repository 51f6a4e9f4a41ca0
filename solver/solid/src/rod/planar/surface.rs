//! The surface about a planar rod: places of its points, and velocities as rows of weights on those of the rod.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{DVector, SMatrix, SVector, Vector2};

use num_dual::Dual64;

use super::planar_rod::{COORDINATES, PlanarRod};
use crate::rod::hermite::Hermite;

/// A point of a section: sections stay plane and normal to the centreline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionPoint {
    /// Distance of the section along the rod (m).
    pub along: f64,
    /// Distance from the centreline (m), positive on the left of who looks from the base to the tip.
    pub offset: f64,
}

/// Place of a point of a rod, and how its velocity follows from those of the rod.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceRows {
    /// Place (m).
    pub place: Vector2<f64>,
    /// First of the coordinates the point depends on, the others behind it; of a rod that is closed the first of
    /// all comes behind the last.
    pub first: usize,
    /// Weights on their velocities, which are also the derivatives of the place by the coordinates.
    pub weights: SMatrix<f64, 2, COORDINATES>,
}

impl SurfaceRows {
    /// Velocity of the point (m/s).
    #[must_use]
    pub fn velocity(&self, velocities: &DVector<f64>) -> Vector2<f64> {
        let n = velocities.len();
        let of_point = std::array::from_fn(|i| velocities[(self.first + i) % n]);
        self.weights * SVector::<f64, COORDINATES>::from(of_point)
    }
}

/// Place of a section of a rod, and how its velocities follow from those of the rod.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionRows {
    /// Where the centreline is (m).
    pub place: Vector2<f64>,
    /// First of the coordinates that it depends on, as of [`SurfaceRows`].
    pub first: usize,
    /// Weights on their velocities, of velocity along x and y and of angular velocity.
    pub weights: SMatrix<f64, 3, COORDINATES>,
}

impl PlanarRod {
    /// A section at a distance along the rod (m): its points move with it as those of a rigid body.
    #[must_use]
    pub fn section(&self, coordinates: &DVector<f64>, along: f64) -> SectionRows {
        let at = self.locate(along);
        let basis = Hermite::at(at.xi, at.length);
        let of_element = SVector::from(self.shaped(coordinates, at.element));
        let (mut place, mut tangent) = (Vector2::zeros(), Vector2::zeros());
        for knot in 0..4 {
            let of_knot = of_element.fixed_rows::<2>(2 * knot);
            place += of_knot * basis.place[knot];
            tangent += of_knot * basis.first[knot];
        }
        let [nx, ny] = (Vector2::new(-tangent.y, tangent.x) / tangent.norm_squared()).into();
        let mut weights = SMatrix::zeros();
        for knot in 0..4 {
            weights[(0, 2 * knot)] = basis.place[knot];
            weights[(1, 2 * knot + 1)] = basis.place[knot];
            weights[(2, 2 * knot)] = basis.first[knot] * nx;
            weights[(2, 2 * knot + 1)] = basis.first[knot] * ny;
        }
        let weights = self.by_coordinates(coordinates, at.element, weights);
        SectionRows { place, first: at.element * Self::STRIDE, weights }
    }

    /// A point of a section, r + offset n with the unit normal n.
    #[must_use]
    pub fn surface(&self, coordinates: &DVector<f64>, point: SectionPoint) -> SurfaceRows {
        let at = self.locate(point.along);
        let basis = Hermite::at(at.xi, at.length);
        let of_element = SVector::from(self.shaped(coordinates, at.element));
        let along = |weights: &[f64; 4]| {
            let mut sum = Vector2::zeros();
            for (knot, weight) in weights.iter().enumerate() {
                sum += of_element.fixed_rows::<2>(2 * knot) * *weight;
            }
            sum
        };
        let tangent = along(&basis.first);
        let length = tangent.norm();
        let [tx, ty] = (tangent / length).into();
        // dn/dt = -t (n . d(dr/ds)/dt) / |dr/ds|
        let turning = -point.offset / length;
        let mut weights = SMatrix::zeros();
        for knot in 0..4 {
            let (place, first) = (basis.place[knot], basis.first[knot] * turning);
            weights[(0, 2 * knot)] = place - first * tx * ty;
            weights[(0, 2 * knot + 1)] = first * tx * tx;
            weights[(1, 2 * knot)] = -first * ty * ty;
            weights[(1, 2 * knot + 1)] = place + first * ty * tx;
        }
        SurfaceRows {
            place: along(&basis.place) + Vector2::new(-ty, tx) * point.offset,
            first: at.element * Self::STRIDE,
            weights: self.by_coordinates(coordinates, at.element, weights),
        }
    }

    /// Weights on the rates of the coordinates of an element, from those with tangents of the length that they have at clamps.
    fn by_coordinates<const R: usize>(
        &self,
        coordinates: &DVector<f64>,
        element: usize,
        weights: SMatrix<f64, R, COORDINATES>,
    ) -> SMatrix<f64, R, COORDINATES> {
        let (element, values) = (self.element(element), self.of_element(coordinates, element));
        if !element.is_clamped() {
            return weights;
        }
        let mut derivatives = SMatrix::<f64, COORDINATES, COORDINATES>::zeros();
        for j in 0..COORDINATES {
            let dual = std::array::from_fn(|i| Dual64::new(values[i], f64::from(u8::from(i == j))));
            for (i, value) in element.shaped::<_, COORDINATES>(&dual).iter().enumerate() {
                derivatives[(i, j)] = value.eps;
            }
        }
        weights * derivatives
    }
}

/// A strip whose ends are half circles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoundedStrip {
    /// Length with the ends (m).
    pub length: f64,
    /// Half of its thickness (m), at most half of its length.
    pub half_width: f64,
}

impl RoundedStrip {
    /// Half of the thickness at a distance along it (m).
    #[must_use]
    pub fn half_width_at(&self, along: f64) -> f64 {
        let Self { length, half_width: a } = *self;
        let from_center = a - along.min(length - along);
        if from_center <= 0.0 { a } else { (a * a - from_center * from_center).max(0.0).sqrt() }
    }

    /// Length of the outline at rest (m).
    #[must_use]
    pub fn perimeter(&self) -> f64 {
        let Self { length, half_width: a } = *self;
        2.0 * (length - 2.0 * a) + 4.0 * FRAC_PI_2 * a
    }

    /// The point of the outline at a distance (m) along it at rest, counter-clockwise from the base: along the right
    /// side to the tip, and back along the left one.
    #[must_use]
    pub fn outline(&self, distance: f64) -> SectionPoint {
        let Self { length, half_width: a } = *self;
        let half = 0.5 * self.perimeter();
        let distance = distance.rem_euclid(2.0 * half);
        let is_right = distance < half;
        let from_base = if is_right { distance } else { 2.0 * half - distance };
        let (quarter, sign) = (FRAC_PI_2 * a, if is_right { -1.0 } else { 1.0 });
        let (along, width) = if from_base < quarter {
            let (sin, cos) = (from_base / a).sin_cos();
            (a * (1.0 - cos), a * sin)
        } else if from_base > half - quarter {
            let (sin, cos) = ((half - from_base) / a).sin_cos();
            (length - a * (1.0 - cos), a * sin)
        } else {
            (a + from_base - quarter, a)
        };
        SectionPoint { along, offset: sign * width }
    }
}
