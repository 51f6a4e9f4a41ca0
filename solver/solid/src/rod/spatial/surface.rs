//! The surface about a rod in space: places of its points, and velocities as rows of weights on those of the rod.

use nalgebra::{DVector, SMatrix, Vector3};
use num_dual::Dual64;

use super::frame::Frame;
use super::spatial_rod::{COORDINATES, SpatialRod, across, vector};
use crate::rod::hermite::Hermite;
use crate::rod::kinematics::Number;

/// A point of a section in space: sections stay plane and normal to the centreline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpatialSectionPoint {
    /// Distance of the section along the rod (m).
    pub along: f64,
    /// Distances from the centreline along d1 and d2 (m).
    pub offset: [f64; 2],
}

/// Place of a point of a rod in space, and how its velocity follows from those of the rod.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpatialSurfaceRows {
    /// Place (m).
    pub place: Vector3<f64>,
    /// First of the coordinates the point depends on.
    pub first: usize,
    /// Weights on their velocities, which are also the derivatives of the place by the coordinates.
    pub weights: SMatrix<f64, 3, COORDINATES>,
}

impl SpatialSurfaceRows {
    /// Velocity of the point (m/s).
    #[must_use]
    pub fn velocity(&self, velocities: &DVector<f64>) -> Vector3<f64> {
        self.weights * velocities.fixed_rows::<COORDINATES>(self.first)
    }
}

impl SpatialRod {
    /// A point of a section, r + offset . (d1, d2).
    #[must_use]
    pub fn surface(
        &self,
        coordinates: &DVector<f64>,
        point: SpatialSectionPoint,
    ) -> SpatialSurfaceRows {
        let at = self.locate(point.along);
        let basis = Hermite::at(at.xi, at.length);
        let (element, values) =
            (self.element(at.element), self.of_element(coordinates, at.element));
        let (mut place, mut weights) = (Vector3::zeros(), SMatrix::zeros());
        for j in 0..COORDINATES {
            let dual =
                std::array::from_fn(|i| Dual64::new(values[i], if i == j { 1.0 } else { 0.0 }));
            let dual = element.shaped(&dual);
            for (axis, value) in material(&basis, at.xi, &dual, point.offset).iter().enumerate() {
                place[axis] = value.re;
                weights[(axis, j)] = value.eps;
            }
        }
        SpatialSurfaceRows { place, first: at.element * Self::STRIDE, weights }
    }

    /// The place of such a point (m).
    #[must_use]
    pub fn surface_place(
        &self,
        coordinates: &DVector<f64>,
        point: SpatialSectionPoint,
    ) -> Vector3<f64> {
        let at = self.locate(point.along);
        let basis = Hermite::at(at.xi, at.length);
        let values = self.shaped(coordinates, at.element);
        Vector3::from(material(&basis, at.xi, &values, point.offset))
    }
}

/// Place of a point of a section.
fn material<D: Number>(
    basis: &Hermite,
    xi: f64,
    coordinates: &[D; COORDINATES],
    offset: [f64; 2],
) -> [D; 3] {
    let line = vector(&basis.place, coordinates);
    let frame = Frame::new(&vector(&basis.first, coordinates), &across(xi, coordinates));
    std::array::from_fn(|axis| {
        line[axis] + frame.first[axis] * offset[0] + frame.second[axis] * offset[1]
    })
}
