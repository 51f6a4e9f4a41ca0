//! `Part`: where a body of a case is in its tree, and what the fluid does to it.

use alewife_reduced::tree::{Number, PlacedLoad, Pose, real};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use super::law::Law;
use crate::case::EllipsoidSpec;

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
    /// Its centre and axes from the centre of mass, in the axes of the body.
    pub place: Pose<f64>,
}

impl Piece {
    /// An ellipsoid of a case on a body with the law of this one, and with a centre of mass in its frame (m).
    pub fn new(spec: &EllipsoidSpec, law: &Law, center: &Vector3<f64>) -> Self {
        let turn =
            spec.orientation.as_ref().map_or_else(UnitQuaternion::identity, |own| own.rotation());
        let position = Vector3::from(spec.position) - center;
        let place = Pose { rotation: *turn.to_rotation_matrix().matrix(), position };
        Self { law: law.of(spec.semi_axes), place }
    }
}

impl Part {
    /// What has the loads on the body: its shape, or ellipsoids.
    pub fn laws(&self) -> Vec<Piece> {
        if self.pieces.is_empty() {
            return vec![Piece { law: self.law, place: Pose::at(self.place) }];
        }
        self.pieces.clone()
    }

    /// All loads on the body by coefficients, in the frame of its link.
    pub fn loads<T: Number>(&self, coefficients: &[T]) -> Vec<PlacedLoad<T>> {
        let placed = |piece: Piece| {
            let load = piece.law.load(coefficients)?;
            let met = pose(&self.inside.then(&piece.place));
            Some(PlacedLoad { pose: Some(met), load })
        };
        self.laws().into_iter().filter_map(placed).collect()
    }
}

/// A pose as one of numbers.
pub(super) fn pose<T: Number>(pose: &Pose<f64>) -> Pose<T> {
    Pose { rotation: pose.rotation.map(real), position: pose.position.map(real) }
}
