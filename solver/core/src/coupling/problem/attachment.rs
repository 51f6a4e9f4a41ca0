//! `Attachment`: coordinates of a body that are places or directions on another, rigid one.

use nalgebra::Vector3;

use crate::body::{Pose, Twist};

/// What of a body with coordinates is fixed to another body.
#[derive(Debug, Clone, PartialEq)]
pub struct Attachment {
    /// The body it is fixed to, a rigid one.
    pub to: usize,
    /// The coordinates that are given by it, ascending.
    pub coordinates: Vec<OnBody>,
}

/// A coordinate that is a component of a vector of another body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OnBody {
    /// Which coordinate.
    pub coordinate: usize,
    /// Along which axis of the frame in which coordinates are seen: 0, 1, 2.
    pub axis: usize,
    /// The vector, in the frame of the other body.
    pub vector: BodyVector,
}

/// A vector in the frame of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BodyVector {
    /// A point (m).
    Place(Vector3<f64>),
    /// A direction (1).
    Direction(Vector3<f64>),
}

impl OnBody {
    /// Its value with the other body at a pose, coordinates being seen from another one.
    #[must_use]
    pub fn value(&self, seen_from: &Pose, body: &Pose) -> f64 {
        let vector = match &self.vector {
            BodyVector::Place(at) => body.center + body.to_world(at) - seen_from.center,
            BodyVector::Direction(along) => body.to_world(along),
        };
        seen_from.to_body(&vector)[self.axis]
    }

    /// Its rate by velocities of the other body at a pose: weights on linear and angular ones.
    #[must_use]
    pub fn row(&self, seen_from: &Pose, body: &Pose) -> [Vector3<f64>; 2] {
        let axis = seen_from.to_world(&Vector3::ith(self.axis, 1.0));
        let (linear, arm) = match &self.vector {
            BodyVector::Place(at) => (axis, body.to_world(at)),
            BodyVector::Direction(along) => (Vector3::zeros(), body.to_world(along)),
        };
        // axis . (omega x arm)
        [linear, arm.cross(&axis)]
    }

    /// Its rate with the other body at a pose, at these velocities.
    #[must_use]
    pub fn rate(&self, seen_from: &Pose, body: &Pose, twist: &Twist) -> f64 {
        let [linear, angular] = self.row(seen_from, body);
        linear.dot(&twist.linear) + angular.dot(&twist.angular)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The rate is that of the value, for places and directions in the plane.
    #[test]
    fn rates_are_those_of_values() {
        let seen_from = Pose::planar(0.4, -0.3, 0.7);
        let at = |time: f64| Pose::planar(0.1 + 0.3 * time, 0.2 - 0.5 * time, 0.4 + 1.7 * time);
        let twist =
            Twist { linear: Vector3::new(0.3, -0.5, 0.0), angular: Vector3::new(0.0, 0.0, 1.7) };
        let own = Vector3::new(0.6, -0.2, 0.0);
        for vector in [BodyVector::Place(own), BodyVector::Direction(own)] {
            for axis in 0..2 {
                let given = OnBody { coordinate: 0, axis, vector };
                let values = [-1e-5, 1e-5].map(|time| given.value(&seen_from, &at(time)));
                let exact = (values[1] - values[0]) / 2e-5;
                let found = given.rate(&seen_from, &at(0.0), &twist);
                assert!((found - exact).abs() < 1e-9, "{vector:?} {axis}: {found} {exact}");
            }
        }
    }
}
