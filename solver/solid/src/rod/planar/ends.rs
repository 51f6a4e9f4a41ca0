//! How the ends of a planar rod are held, and what their supports carry.

use nalgebra::{DVector, SMatrix, Vector2, Vector3};

use super::planar_rod::PlanarRod;
use crate::rod::end::{End, Support};
use crate::structure::{BaseMotion, Held};

/// Place and direction of an end and how they change: of a support that moves as a function of time, or of a point
/// of a rigid body.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct EndPose {
    /// Place (m).
    pub place: Vector2<f64>,
    /// Velocity (m/s).
    pub velocity: Vector2<f64>,
    /// Direction of the centreline (rad), from the base to the tip.
    pub angle: f64,
    /// Its rate (rad/s).
    pub angular_velocity: f64,
}

/// What a support does to a rod: its work per displacement and per angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EndLoad {
    /// Force (N, in planar problems N/m).
    pub force: Vector2<f64>,
    /// Moment about the end (N m, in planar problems N).
    pub moment: f64,
}

impl EndPose {
    /// The pose of an end that is attached to this one, as to a body whose centre this is: at a lever (m) in the axes
    /// of the body and turned from it by an angle (rad).
    #[must_use]
    pub fn attached(&self, lever: Vector2<f64>, angle: f64) -> Self {
        let (sin, cos) = self.angle.sin_cos();
        let arm = Vector2::new(cos * lever.x - sin * lever.y, sin * lever.x + cos * lever.y);
        Self {
            place: self.place + arm,
            velocity: self.velocity + Vector2::new(-arm.y, arm.x) * self.angular_velocity,
            angle: self.angle + angle,
            angular_velocity: self.angular_velocity,
        }
    }

    /// Coordinates of an end, place before direction, and their rates.
    fn coordinates(&self) -> [[f64; 2]; 4] {
        let (sin, cos) = self.angle.sin_cos();
        let rate = self.angular_velocity;
        [
            [self.place.x, self.velocity.x],
            [self.place.y, self.velocity.y],
            [cos, -sin * rate],
            [sin, cos * rate],
        ]
    }

    /// Weights of the rates of the coordinates of an end (rows) on velocity along x and y and angular velocity.
    #[must_use]
    pub fn rows(&self) -> SMatrix<f64, 4, 3> {
        let (sin, cos) = self.angle.sin_cos();
        SMatrix::<f64, 4, 3>::from_row_slice(&[
            1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, -sin, 0.0, 0.0, cos,
        ])
    }
}

impl PlanarRod {
    /// The coordinates that a support gives.
    #[must_use]
    pub fn held(&self, end: End, support: Support, pose: &EndPose) -> Vec<Held> {
        let first = self.first_coordinate(end);
        let given = pose.coordinates().into_iter().enumerate().take(support.n_held(2));
        let held =
            |(i, [value, rate]): (usize, [f64; 2])| Held { coordinate: first + i, value, rate };
        given.map(held).collect()
    }

    /// What a support does to the rod, by the loads (n) that its equations of motion leave open, M dv/dt + f - Q.
    #[must_use]
    pub fn end_load(
        &self,
        end: End,
        coordinates: &DVector<f64>,
        residual: &DVector<f64>,
    ) -> EndLoad {
        let first = self.first_coordinate(end);
        let tangent = Vector2::new(coordinates[first + 2], coordinates[first + 3]);
        EndLoad {
            force: Vector2::new(residual[first], residual[first + 1]),
            moment: tangent.x * residual[first + 3] - tangent.y * residual[first + 2],
        }
    }

    /// Where the base is, and how it moves.
    pub(super) fn base_motion(
        &self,
        coordinates: &DVector<f64>,
        velocities: &DVector<f64>,
    ) -> BaseMotion {
        let [tangent, rate] = [coordinates, velocities].map(|of| Vector2::new(of[2], of[3]));
        BaseMotion {
            place: Vector3::new(coordinates[0], coordinates[1], 0.0),
            velocity: Vector3::new(velocities[0], velocities[1], 0.0),
            angular_velocity: Vector3::z() * (tangent.perp(&rate) / tangent.norm_squared()),
        }
    }

    /// Velocities in a rigid motion.
    pub(super) fn rigid_velocities(
        &self,
        coordinates: &DVector<f64>,
        motion: &BaseMotion,
    ) -> DVector<f64> {
        let BaseMotion { place, velocity, angular_velocity } = motion;
        let mut rates = DVector::zeros(coordinates.len());
        for knot in (0..coordinates.len()).step_by(Self::STRIDE) {
            let arm = Vector2::new(coordinates[knot], coordinates[knot + 1]) - place.xy();
            let tangent = Vector2::new(coordinates[knot + 2], coordinates[knot + 3]);
            let turning =
                |vector: Vector2<f64>| Vector2::new(-vector.y, vector.x) * angular_velocity.z;
            rates.fixed_rows_mut::<2>(knot).copy_from(&(velocity.xy() + turning(arm)));
            rates.fixed_rows_mut::<2>(knot + 2).copy_from(&turning(tangent));
        }
        rates
    }
}
