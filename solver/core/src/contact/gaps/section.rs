//! `Section`: the piece of a body with coordinates that a point of its surface moves with.

use std::fmt::Debug;

use nalgebra::{SMatrix, Vector3};

use crate::body::{Pose, RigidVector};

/// Coordinates that a section moves with at most: those of the two knots of an element in the plane.
pub const COORDINATES_OF_SECTION: usize = 8;

/// A section of a body with coordinates: a rigid motion that follows from some of their rates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    /// Its centre, from the centre of mass of the body (m).
    pub center: Vector3<f64>,
    /// The coordinates that it moves with, the first of which is this one of the body.
    pub first: usize,
    /// Rigid velocities (rows) by the rates of these coordinates.
    pub weights: SMatrix<f64, 6, COORDINATES_OF_SECTION>,
}

/// The sections of a body with coordinates in one shape.
pub trait Sections: Debug + Send + Sync {
    /// The section that a point of the surface is on, both seen from the body, from its centre of mass (m).
    fn at(&self, point: &Vector3<f64>) -> Option<Section>;
}

impl Section {
    /// The same, seen as a body in this pose is.
    #[must_use]
    pub fn seen_from(&self, pose: &Pose) -> Self {
        let mut weights = self.weights;
        for mut column in weights.column_iter_mut() {
            for first in [0, 3] {
                let turned = pose.to_world(&column.fixed_rows::<3>(first).into_owned());
                column.fixed_rows_mut::<3>(first).copy_from(&turned);
            }
        }
        Self { center: pose.to_world(&self.center), weights, ..*self }
    }

    /// What a load on the section does on its coordinates, as a pair of coordinate and load each.
    pub fn on_coordinates(&self, load: &RigidVector) -> impl Iterator<Item = Weighted> {
        let loads = self.weights.transpose() * load;
        let first = self.first;
        (0..COORDINATES_OF_SECTION)
            .map(move |i| Weighted { coordinate: first + i, value: loads[i] })
    }
}

/// A number that belongs to a coordinate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weighted {
    /// Which coordinate of the body.
    pub coordinate: usize,
    /// The number.
    pub value: f64,
}
