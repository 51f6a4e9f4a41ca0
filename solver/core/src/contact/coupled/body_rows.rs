//! `BodyRows`: velocities and loads of the bodies that may be in contact as one stacked vector.

use nalgebra::DVector;

use crate::body::{Modes, RigidVector, Twist};

/// Bodies and their motions: a row for each motion, body by body.
#[derive(Debug, Clone, Copy)]
pub(super) struct BodyRows<'a> {
    /// The bodies.
    pub bodies: &'a [usize],
    /// The motions of each.
    pub modes: Modes,
}

impl BodyRows<'_> {
    /// Vectors of bodies by row.
    pub fn of(&self, of_body: impl Fn(usize) -> RigidVector) -> DVector<f64> {
        self.of_each(self.bodies.iter().map(|&body| of_body(body)))
    }

    /// Vectors of these bodies, one each, by row.
    pub fn of_each(&self, vectors: impl Iterator<Item = RigidVector>) -> DVector<f64> {
        let numbers = vectors.flat_map(|vector| self.modes.iter().map(move |mode| vector[mode]));
        DVector::from_vec(numbers.collect())
    }

    /// Velocities, of which there is one for each body of the problem, by row.
    pub fn of_twists(&self, twists: &[Twist]) -> DVector<f64> {
        self.of(|body| twists[body].to_vector())
    }

    /// Velocities of the bodies by rows.
    pub fn twists(&self, rows: &DVector<f64>) -> Vec<Twist> {
        let of_body = |index: usize| {
            let mut velocity = RigidVector::zeros();
            for (position, mode) in self.modes.iter().enumerate() {
                velocity[mode] = rows[self.modes.len() * index + position];
            }
            Twist::from_vector(&velocity)
        };
        (0..self.bodies.len()).map(of_body).collect()
    }
}
