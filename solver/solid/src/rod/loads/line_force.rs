//! `LineForce`: a force per length of a rod, such as weight, with a force at the tip.

use nalgebra::{DMatrix, DVector};

use crate::rod::elastic::Rod;
use crate::rod::hermite::{GAUSS, GAUSS_WEIGHTS, Hermite};
use crate::rod::kinematics::Kinematics;
use crate::structure::{Load, Structure, Tangents};

/// A dead load: forces that do not follow the rod.
#[derive(Debug, Clone)]
pub struct LineForce {
    load: DVector<f64>,
}

impl LineForce {
    /// A force per length at rest (N/m) and a force at the tip (N), by components.
    #[must_use]
    pub fn new<K: Kinematics<N, S>, const N: usize, const S: usize>(
        rod: &Rod<K, N, S>,
        per_length: &[f64],
        at_tip: &[f64],
    ) -> Self {
        let mut load = DVector::zeros(rod.n_coordinates());
        let (stride, knots) = (N / 2, rod.knots());
        for (element, ends) in knots.windows(2).enumerate() {
            let length = ends[1] - ends[0];
            for (xi, weight) in GAUSS.iter().zip(GAUSS_WEIGHTS) {
                let basis = Hermite::at(*xi, length);
                for (i, of_place) in basis.place.iter().enumerate() {
                    let first = (element + i / 2) * stride + (i % 2) * K::DIMENSION;
                    for (axis, force) in per_length.iter().enumerate().take(K::DIMENSION) {
                        load[first + axis] += weight * length * of_place * force;
                    }
                }
            }
        }
        let last = stride * (knots.len() - 1);
        for (axis, force) in at_tip.iter().enumerate().take(K::DIMENSION) {
            load[last + axis] += force;
        }
        Self { load }
    }
}

impl Load for LineForce {
    fn load(&self, _: &DVector<f64>, _: &DVector<f64>, _: f64) -> DVector<f64> {
        self.load.clone()
    }

    fn tangents(&self, _: &DVector<f64>, _: &DVector<f64>, _: f64) -> Tangents {
        let n = self.load.len();
        Tangents { stiffness: DMatrix::zeros(n, n), damping: DMatrix::zeros(n, n) }
    }
}
