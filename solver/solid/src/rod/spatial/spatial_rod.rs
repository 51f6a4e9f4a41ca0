//! `SpatialRod`: a rod that bends in two directions and twists (Kirchhoff's theory).

use nalgebra::{DVector, Rotation3, Vector3};

use super::frame::{Frame, dot};
use crate::rod::along::Along;
use crate::rod::elastic::{Parts, Rod};
use crate::rod::error::RodError;
use crate::rod::hermite::{GAUSS, GAUSS_INTEGRALS, GAUSS_WEIGHTS, Hermite};
use crate::rod::kinematics::{Kinematics, Number, StrainKind, StrainPoint};
use crate::rod::mass::mass;
use crate::rod::properties::SpatialProperties;

/// Coordinates of an element.
pub(super) const COORDINATES: usize = 18;

/// Strains of an element: bending in two directions and twist at Gauss points; stretch as in the plane; and at both
/// ends the length of the vector across and its part along the tangent.
pub(super) const STRAINS: usize = 19;

/// A rod in space. Its coordinates are, knot by knot, the place (m), the tangent dr/ds, and a vector across, which the
/// section turns with; each by x, y and z.
///
/// The frame of a section is the unit tangent t, d1 along the vector across less its part along t, and d2 = t x d1.
/// Between two knots it is transported in parallel along the centreline, and turned evenly about it by the angle that
/// is left at the second one. Strains are the components of the vector W of d' = W x d about d1, d2 and t.
pub type SpatialRod = Rod<Space, COORDINATES, STRAINS>;

/// How an element of a rod in space deforms.
#[derive(Debug, Clone, Copy)]
pub struct Space;

/// A vector along an element, by weights on its knots.
pub(super) fn vector<D: Number>(weights: &[f64; 4], coordinates: &[D; 18]) -> [D; 3] {
    std::array::from_fn(|axis| {
        let [a, b, c, d] = [0, 3, 9, 12].map(|first| coordinates[first + axis]);
        a * weights[0] + b * weights[1] + c * weights[2] + d * weights[3]
    })
}

/// The vector across at a part of an element.
pub(super) fn across<D: Number>(xi: f64, coordinates: &[D; 18]) -> [D; 3] {
    std::array::from_fn(|axis| coordinates[6 + axis] * (1.0 - xi) + coordinates[15 + axis] * xi)
}

/// Rates of turning per length at rest about d1, d2 and t (1/m), of the frame whose d1 is along a vector that is
/// linear between the knots.
fn turning<D: Number>(xi: f64, length: f64, coordinates: &[D; 18]) -> [D; 3] {
    let basis = Hermite::at(xi, length);
    let tangent = vector(&basis.first, coordinates);
    let bend = vector(&basis.second, coordinates);
    let across_here = across(xi, coordinates);
    let rate: [D; 3] =
        std::array::from_fn(|axis| (coordinates[15 + axis] - coordinates[6 + axis]) / length);
    let frame = Frame::new(&tangent, &across_here);
    let about_first = -dot(&bend, &frame.second) / frame.stretch;
    let about_second = dot(&bend, &frame.first) / frame.stretch;
    let slant = dot(&across_here, &frame.tangent);
    let twist = (dot(&rate, &frame.second) + slant * about_first) / frame.width;
    [about_first, about_second, twist]
}

/// Rates of turning at the Gauss points, of the frame that is turned evenly.
fn even_turning<D: Number>(length: f64, coordinates: &[D; 18]) -> [[D; 3]; 4] {
    let raw = GAUSS.map(|xi| turning(xi, length, coordinates));
    let integral = |weights: &[f64; 4]| {
        raw[0][2] * weights[0]
            + raw[1][2] * weights[1]
            + raw[2][2] * weights[2]
            + raw[3][2] * weights[3]
    };
    let twist = integral(&GAUSS_WEIGHTS);
    std::array::from_fn(|i| {
        let angle = (twist * GAUSS[i] - integral(&GAUSS_INTEGRALS[i])) * length;
        let (sin, cos) = angle.sin_cos();
        let [first, second, _] = raw[i];
        [first * cos + second * sin, second * cos - first * sin, twist]
    })
}

impl Kinematics<COORDINATES, STRAINS> for Space {
    const DIMENSION: usize = 3;

    fn points(&self) -> [StrainPoint; STRAINS] {
        std::array::from_fn(|i| match i {
            0..12 => {
                let (xi, weight) = (GAUSS[i / 3], GAUSS_WEIGHTS[i / 3]);
                StrainPoint { kind: StrainKind::Flexure(i % 3), xi, weight }
            }
            12..15 => {
                let (xi, weight) = [(0.0, 1.0 / 6.0), (0.5, 2.0 / 3.0), (1.0, 1.0 / 6.0)][i - 12];
                StrainPoint { kind: StrainKind::Stretch, xi, weight }
            }
            _ => {
                let xi = if i < 17 { 0.0 } else { 1.0 };
                StrainPoint { kind: StrainKind::Gauge, xi, weight: 0.5 }
            }
        })
    }

    fn strains<D: Number>(&self, length: f64, coordinates: &[D; COORDINATES]) -> [D; STRAINS] {
        let turning = even_turning(length, coordinates);
        let tangent = |xi: f64| vector(&Hermite::at(xi, length).first, coordinates);
        let stretch = |xi: f64| {
            let along = tangent(xi);
            dot(&along, &along).sqrt() - 1.0
        };
        let gauge = |xi: f64| {
            let (along, vector) = (tangent(xi), across(xi, coordinates));
            [(dot(&vector, &vector) - 1.0) * 0.5, dot(&vector, &along)]
        };
        let [start, end] = [0.0, 1.0].map(gauge);
        std::array::from_fn(|i| match i {
            0..12 => turning[i / 3][i % 3],
            12 => stretch(0.0),
            13 => stretch(0.5),
            14 => stretch(1.0),
            15 | 16 => start[i - 15],
            _ => end[i - 17],
        })
    }
}

impl SpatialRod {
    /// A rod with given properties.
    ///
    /// # Errors
    /// [`RodError`] where its size or a property is not positive.
    pub fn new(properties: SpatialProperties) -> Result<Self, RodError> {
        let SpatialProperties { rod, bending: [first, second], twisting } = properties;
        rod.validate()?;
        let mass = mass(&rod, 3, 9);
        let flexures = vec![first, second, twisting];
        Self::of_parts(Parts { kinematics: Space, rod, flexures, mass })
    }

    /// Coordinates of a straight rod from a place (m), with t, d1 and d2 along the turned x, y and z.
    #[must_use]
    pub fn straight(&self, place: Vector3<f64>, rotation: Rotation3<f64>) -> DVector<f64> {
        self.curved(place, rotation, &[0.0; 3].map(Along::Constant))
    }

    /// Coordinates of a rod whose sections turn about d1, d2 and t at these rates (1/m), from a place (m) with t, d1 and
    /// d2 along the turned x, y and z.
    #[must_use]
    pub fn curved(
        &self,
        place: Vector3<f64>,
        rotation: Rotation3<f64>,
        turning: &[Along; 3],
    ) -> DVector<f64> {
        /// Steps of an element, in each of which the rates are those in its middle.
        const STEPS: u32 = 32;
        let (mut place, mut rotation) = (place, rotation);
        let mut coordinates = DVector::zeros(Self::STRIDE * self.knots().len());
        for (knot, along) in self.knots().iter().enumerate() {
            if knot > 0 {
                let from = self.knots()[knot - 1];
                let step = (along - from) / f64::from(STEPS);
                for i in 0..STEPS {
                    let middle = from + (f64::from(i) + 0.5) * step;
                    let [first, second, twist] = [0, 1, 2].map(|i| turning[i].at(middle));
                    let rate = Vector3::new(twist, first, second);
                    let turned = |over: f64| rotation * Rotation3::new(rate * over);
                    for (xi, weight) in GAUSS.iter().zip(GAUSS_WEIGHTS) {
                        place += turned(xi * step) * Vector3::x() * (step * weight);
                    }
                    rotation = turned(step);
                }
            }
            let mut rows = coordinates.fixed_rows_mut::<9>(Self::STRIDE * knot);
            rows.fixed_rows_mut::<3>(0).copy_from(&place);
            rows.fixed_rows_mut::<3>(3).copy_from(&(rotation * Vector3::x()));
            rows.fixed_rows_mut::<3>(6).copy_from(&(rotation * Vector3::y()));
        }
        coordinates
    }

    /// Place of the centreline (m) at a distance along it (m).
    #[must_use]
    pub fn place(&self, coordinates: &DVector<f64>, along: f64) -> Vector3<f64> {
        let at = self.locate(along);
        let basis = Hermite::at(at.xi, at.length);
        Vector3::from(vector(&basis.place, &self.shaped(coordinates, at.element)))
    }

    /// Rates of turning per length about d1, d2 and t (1/m) at a distance along the rod (m): the linear functions of
    /// each element that are nearest.
    #[must_use]
    pub fn turning(&self, coordinates: &DVector<f64>, along: f64) -> Vector3<f64> {
        let at = self.locate(along);
        let points = even_turning(at.length, &self.shaped(coordinates, at.element));
        let mut value = Vector3::zeros();
        for ((xi, weight), here) in GAUSS.iter().zip(GAUSS_WEIGHTS).zip(points) {
            // Mean, and 12 times the first moment
            let factor = 1.0 + 12.0 * (xi - 0.5) * (at.xi - 0.5);
            value += Vector3::from(here) * (weight * factor);
        }
        value
    }
}
