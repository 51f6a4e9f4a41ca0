//! `Part`: where a body of a case is in its tree, and what the fluid does to it.

use alewife_reduced::tree::{Number, PlacedLoad, Pose, real};
use nalgebra::{Matrix3, Vector3};

use super::law::Law;

/// Where a body is in the tree, and what the fluid does to it.
#[derive(Debug, Clone)]
pub(super) struct Part {
    /// Number of its link.
    pub link: usize,
    /// Its centre of mass and axes in the frame of the link.
    pub inside: Pose<f64>,
    /// Mass (kg), or volume (m3) where there is no inertia.
    pub mass: f64,
    /// Inertia about its centre of mass in its axes, of the same density.
    pub inertia: Matrix3<f64>,
    pub law: Law,
    pub coefficients: Vec<f64>,
    /// Where the law is from the centre of mass, in the axes of the body.
    pub place: Vector3<f64>,
    /// Ellipsoids whose loads it has in place of that of its shape.
    pub pieces: Vec<Piece>,
}

/// An ellipsoid on a body.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece {
    pub law: Law,
    /// Its centre from the centre of mass, in the axes of the body.
    pub place: Vector3<f64>,
}

impl Part {
    /// All loads on the body by coefficients, in the frame of its link.
    pub fn loads<T: Number>(&self, coefficients: &[T]) -> Vec<PlacedLoad<T>> {
        let placed = |law: &Law, place: Vector3<f64>| {
            let load = law.load(coefficients)?;
            let met = pose(&self.inside.then(&Pose::at(place)));
            Some(PlacedLoad { pose: Some(met), load })
        };
        if self.pieces.is_empty() {
            return placed(&self.law, self.place).into_iter().collect();
        }
        self.pieces.iter().filter_map(|piece| placed(&piece.law, piece.place)).collect()
    }
}

/// A pose as one of numbers.
pub(super) fn pose<T: Number>(pose: &Pose<f64>) -> Pose<T> {
    Pose { rotation: pose.rotation.map(real), position: pose.position.map(real) }
}
