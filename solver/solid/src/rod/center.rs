//! The centre of a rod, as weights on its coordinates.

use nalgebra::{DVector, Vector3};

use super::elastic::Rod;
use super::kinematics::Kinematics;
use crate::structure::{Structure, Weight};

/// Weights of the centre of mass on the coordinates; of a rod without mass those of the middle of its length.
pub fn center_weights<K: Kinematics<N, S>, const N: usize, const S: usize>(
    rod: &Rod<K, N, S>,
) -> Vec<Weight> {
    let mass = rod.mass();
    let mut shift = DVector::zeros(rod.n_coordinates());
    for place in shift.iter_mut().step_by(N / 2) {
        *place = 1.0;
    }
    // Momentum along x of a motion along x
    let momentum = &mass * &shift;
    let total = shift.dot(&momentum);
    let weights = if total > 0.0 { momentum / total } else { middle(rod) };
    let mut all = Vec::new();
    for (first, weight) in weights.iter().enumerate().filter(|(_, weight)| **weight != 0.0) {
        for axis in 0..K::DIMENSION {
            let mut vector = Vector3::zeros();
            vector[axis] = *weight;
            all.push(Weight { coordinate: first + axis, weight: vector });
        }
    }
    all.sort_by_key(|at| at.coordinate);
    all
}

/// Weights of the mean of the centreline over its length on the first components.
fn middle<K: Kinematics<N, S>, const N: usize, const S: usize>(rod: &Rod<K, N, S>) -> DVector<f64> {
    let mut weights = DVector::zeros(rod.n_coordinates());
    let knots = rod.knots();
    let length = knots[knots.len() - 1] - knots[0];
    for (element, ends) in knots.windows(2).enumerate() {
        let part = ends[1] - ends[0];
        let (place, tangent) = (0.5 * part / length, part * part / (12.0 * length));
        let first = element * N / 2;
        let second = (first + N / 2) % weights.len();
        weights[first] += place;
        weights[first + K::DIMENSION] += tangent;
        weights[second] += place;
        weights[second + K::DIMENSION] -= tangent;
    }
    weights
}
