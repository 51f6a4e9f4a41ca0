//! `Resistance`: drag along and across a thin rod, proportional to its velocity.

use nalgebra::{DMatrix, DVector, SMatrix, SVector};

use crate::rod::elastic::Rod;
use crate::rod::hermite::{GAUSS, GAUSS_WEIGHTS, Hermite};
use crate::rod::kinematics::Kinematics;
use crate::structure::{Load, Tangents};

/// Resistive force theory: the drag per length of a thin rod depends on the velocity there alone (@gray1955).
#[derive(Debug, Clone)]
pub struct Resistance {
    /// Force per length and velocity along the rod (N s/m²).
    pub along: f64,
    /// The same across.
    pub across: f64,
    /// Distances of the knots along the rod (m).
    knots: Vec<f64>,
    dimension: usize,
    stride: usize,
}

/// Derivatives of the drag of a point by its tangent and by its velocity.
struct PointDrag {
    force: SVector<f64, 3>,
    by_tangent: SMatrix<f64, 3, 3>,
    by_velocity: SMatrix<f64, 3, 3>,
}

impl Resistance {
    /// Of a rod, with coefficients along and across (N s/m²).
    #[must_use]
    pub fn new<K: Kinematics<N, S>, const N: usize, const S: usize>(
        rod: &Rod<K, N, S>,
        along: f64,
        across: f64,
    ) -> Self {
        Self { along, across, knots: rod.knots().to_vec(), dimension: K::DIMENSION, stride: N / 2 }
    }

    /// -(across u + (along - across) t (t . u)) with the unit tangent t.
    fn at_point(&self, tangent: &SVector<f64, 3>, velocity: &SVector<f64, 3>) -> PointDrag {
        let (length, difference) = (tangent.norm(), self.along - self.across);
        let t = tangent / length;
        let speed = t.dot(velocity);
        let by_velocity = -(SMatrix::identity() * self.across + t * t.transpose() * difference);
        let turn = (SMatrix::<f64, 3, 3>::identity() - t * t.transpose()) / length;
        let by_unit = -(SMatrix::identity() * speed + t * velocity.transpose()) * difference;
        PointDrag { force: by_velocity * velocity, by_tangent: by_unit * turn, by_velocity }
    }

    /// A vector of an element at a point, by weights on its knots.
    fn vector(&self, all: &DVector<f64>, element: usize, weights: &[f64; 4]) -> SVector<f64, 3> {
        let mut sum = SVector::zeros();
        for (i, weight) in weights.iter().enumerate() {
            let first = self.first(element, i);
            for axis in 0..self.dimension {
                sum[axis] += weight * all[first + axis];
            }
        }
        sum
    }

    /// First coordinate of what a weight of a cubic belongs to.
    fn first(&self, element: usize, weight: usize) -> usize {
        (element + weight / 2) * self.stride + (weight % 2) * self.dimension
    }

    /// Calls a function with elements, weights of their Gauss points (m), their cubics, and the drag there.
    fn each_point(
        &self,
        coordinates: &DVector<f64>,
        velocities: &DVector<f64>,
        mut call: impl FnMut(usize, f64, &Hermite, &PointDrag),
    ) {
        for (element, ends) in self.knots.windows(2).enumerate() {
            let length = ends[1] - ends[0];
            for (xi, weight) in GAUSS.iter().zip(GAUSS_WEIGHTS) {
                let basis = Hermite::at(*xi, length);
                let tangent = self.vector(coordinates, element, &basis.first);
                let velocity = self.vector(velocities, element, &basis.place);
                call(element, weight * length, &basis, &self.at_point(&tangent, &velocity));
            }
        }
    }
}

impl Load for Resistance {
    fn load(&self, coordinates: &DVector<f64>, velocities: &DVector<f64>, _: f64) -> DVector<f64> {
        let mut load = DVector::zeros(coordinates.len());
        self.each_point(coordinates, velocities, |element, weight, basis, drag| {
            for (i, part) in basis.place.iter().enumerate() {
                for axis in 0..self.dimension {
                    load[self.first(element, i) + axis] += weight * part * drag.force[axis];
                }
            }
        });
        load
    }

    fn tangents(&self, coordinates: &DVector<f64>, velocities: &DVector<f64>, _: f64) -> Tangents {
        let n = coordinates.len();
        let mut tangents =
            Tangents { stiffness: DMatrix::zeros(n, n), damping: DMatrix::zeros(n, n) };
        self.each_point(coordinates, velocities, |element, weight, basis, drag| {
            for (i, part) in basis.place.iter().enumerate() {
                for j in 0..4 {
                    let (row, column) = (self.first(element, i), self.first(element, j));
                    let (first, place) =
                        (weight * part * basis.first[j], weight * part * basis.place[j]);
                    for a in 0..self.dimension {
                        for b in 0..self.dimension {
                            tangents.stiffness[(row + a, column + b)] +=
                                first * drag.by_tangent[(a, b)];
                            tangents.damping[(row + a, column + b)] +=
                                place * drag.by_velocity[(a, b)];
                        }
                    }
                }
            }
        });
        tangents
    }
}
