//! `PlanarRod`: a rod that bends in its plane.

use nalgebra::{DVector, Vector2};

use crate::rod::along::Along;
use crate::rod::elastic::{Parts, Rod};
use crate::rod::error::RodError;
use crate::rod::hermite::{GAUSS, GAUSS_WEIGHTS, Hermite};
use crate::rod::kinematics::{Kinematics, Number, StrainKind, StrainPoint};
use crate::rod::mass::mass;
use crate::rod::properties::PlanarProperties;
use crate::structure::Structure;

/// Coordinates of an element.
pub(super) const COORDINATES: usize = 8;

/// Strains of an element: curvature at Gauss points; stretch at both ends and in the middle, where a cubic can
/// keep its length without becoming stiff in bending (@meier2015).
pub(super) const STRAINS: usize = 7;

/// Points of the Gauss rule with two points, from 0 to 1.
pub(super) const TWO_POINTS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];

/// A rod in the plane. Its coordinates are, knot by knot, x and y (m), dx/ds and dy/ds; forces are per length.
pub type PlanarRod = Rod<Plane, COORDINATES, STRAINS>;

/// How an element of a planar rod deforms.
#[derive(Debug, Clone, Copy)]
pub struct Plane;

/// A component of a vector along an element, by weights on its knots.
pub(super) fn component<D: Number>(weights: &[f64; 4], coordinates: &[D; 8], axis: usize) -> D {
    let [a, b, c, d] = [0, 2, 4, 6].map(|first| coordinates[first + axis]);
    a * weights[0] + b * weights[1] + c * weights[2] + d * weights[3]
}

fn vector<D: Number>(weights: &[f64; 4], coordinates: &[D; 8]) -> [D; 2] {
    [0, 1].map(|axis| component(weights, coordinates, axis))
}

/// Angle by which the tangent turns per length at rest (1/m).
fn curvature<D: Number>(xi: f64, length: f64, coordinates: &[D; 8]) -> D {
    let basis = Hermite::at(xi, length);
    let [ax, ay] = vector(&basis.first, coordinates);
    let [bx, by] = vector(&basis.second, coordinates);
    (ax * by - ay * bx) / (ax * ax + ay * ay)
}

fn stretch<D: Number>(xi: f64, length: f64, coordinates: &[D; 8]) -> D {
    let [ax, ay] = vector(&Hermite::at(xi, length).first, coordinates);
    (ax * ax + ay * ay).sqrt() - 1.0
}

impl Kinematics<COORDINATES, STRAINS> for Plane {
    const DIMENSION: usize = 2;

    fn points(&self) -> [StrainPoint; STRAINS] {
        std::array::from_fn(|i| {
            if i < 4 {
                let (xi, weight) = (GAUSS[i], GAUSS_WEIGHTS[i]);
                return StrainPoint { kind: StrainKind::Flexure(0), xi, weight };
            }
            let (xi, weight) = [(0.0, 1.0 / 6.0), (0.5, 2.0 / 3.0), (1.0, 1.0 / 6.0)][i - 4];
            StrainPoint { kind: StrainKind::Stretch, xi, weight }
        })
    }

    fn strains<D: Number>(&self, length: f64, coordinates: &[D; COORDINATES]) -> [D; STRAINS] {
        let at = self.points().map(|point| point.xi);
        std::array::from_fn(|i| {
            if i < 4 {
                curvature(at[i], length, coordinates)
            } else {
                stretch(at[i], length, coordinates)
            }
        })
    }
}

impl PlanarRod {
    /// A rod with given properties.
    ///
    /// # Errors
    /// [`RodError`] where its size or a property is not positive.
    pub fn new(properties: PlanarProperties) -> Result<Self, RodError> {
        let PlanarProperties { rod, bending } = properties;
        rod.validate()?;
        let mass = mass(&rod, 2, 4);
        Self::of_parts(Parts { kinematics: Plane, rod, flexures: vec![bending], mass })
    }

    /// A rod that is closed across a periodic domain: its last knot is its first one a period (m) further.
    ///
    /// # Errors
    /// As of [`PlanarRod::new`].
    pub fn periodic(properties: PlanarProperties, period: Vector2<f64>) -> Result<Self, RodError> {
        Ok(Self::new(properties)?.closed(period.push(0.0)))
    }

    /// Coordinates of a straight rod from a place (m) in a direction (rad).
    #[must_use]
    pub fn straight(&self, place: Vector2<f64>, angle: f64) -> DVector<f64> {
        self.curved(place, angle, &Along::Constant(0.0))
    }

    /// Coordinates of a rod with a curvature (1/m), from a place (m) in a direction (rad).
    #[must_use]
    pub fn curved(&self, place: Vector2<f64>, angle: f64, curvature: &Along) -> DVector<f64> {
        /// Steps of an element in which the curve is followed, by the Gauss rule in each.
        const STEPS: u32 = 8;
        let (mut place, mut angle) = (place, angle);
        let mut coordinates = DVector::zeros(self.n_coordinates());
        let n_free = coordinates.len() / 4;
        for (knot, along) in self.knots().iter().enumerate().take(n_free) {
            if knot > 0 {
                let from = self.knots()[knot - 1];
                let step = (along - from) / f64::from(STEPS);
                for i in 0..STEPS {
                    let start = from + f64::from(i) * step;
                    let turned = |to: f64| turning(curvature, start, to);
                    for (xi, weight) in GAUSS.iter().zip(GAUSS_WEIGHTS) {
                        let (sin, cos) = (angle + turned(xi * step)).sin_cos();
                        place += Vector2::new(cos, sin) * (step * weight);
                    }
                    angle += turned(step);
                }
            }
            let (sin, cos) = angle.sin_cos();
            let values = [place.x, place.y, cos, sin];
            coordinates.rows_mut(4 * knot, 4).copy_from_slice(&values);
        }
        coordinates
    }

    /// Place of the centreline (m) at a distance along it (m).
    #[must_use]
    pub fn place(&self, coordinates: &DVector<f64>, along: f64) -> Vector2<f64> {
        let at = self.locate(along);
        let basis = Hermite::at(at.xi, at.length);
        Vector2::from(vector(&basis.place, &self.shaped(coordinates, at.element)))
    }

    /// Curvature (1/m), positive where the rod turns counter-clockwise, at a distance along it (m).
    #[must_use]
    pub fn curvature(&self, coordinates: &DVector<f64>, along: f64) -> f64 {
        let at = self.locate(along);
        let of_element = self.shaped(coordinates, at.element);
        // At the two Gauss points the curvature of a cubic is right to one order more than elsewhere
        let [first, second] = TWO_POINTS.map(|xi| curvature(xi, at.length, &of_element));
        let [from, to] = TWO_POINTS;
        first + (second - first) * (at.xi - from) / (to - from)
    }
}

/// Angle (rad) by which a curve of a curvature (1/m) turns from a distance on, over another (m).
fn turning(curvature: &Along, from: f64, over: f64) -> f64 {
    let at = |(xi, weight): (&f64, f64)| curvature.at(from + xi * over) * weight * over;
    GAUSS.iter().zip(GAUSS_WEIGHTS).map(at).sum()
}
