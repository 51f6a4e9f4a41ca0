//! How the ends of a rod in space are held, and what their supports carry.

use nalgebra::{DVector, Rotation3, SMatrix, Vector3};

use super::frame::Frame;
use super::spatial_rod::SpatialRod;
use crate::rod::end::{End, Support};
use crate::structure::{BaseMotion, Held};

/// Coordinates of a knot.
const KNOT: usize = 9;

/// Place and frame of an end and how they change: of a support that moves as a function of time, or of a point of a
/// rigid body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpatialEndPose {
    /// Place (m).
    pub place: Vector3<f64>,
    /// Velocity (m/s).
    pub velocity: Vector3<f64>,
    /// Turns x to the tangent, from the base to the tip, y to d1 and z to d2.
    pub rotation: Rotation3<f64>,
    /// Its rate (rad/s).
    pub angular_velocity: Vector3<f64>,
}

impl Default for SpatialEndPose {
    /// At rest in the origin, along x.
    fn default() -> Self {
        Self {
            place: Vector3::zeros(),
            velocity: Vector3::zeros(),
            rotation: Rotation3::identity(),
            angular_velocity: Vector3::zeros(),
        }
    }
}

/// What acts at an end of a rod in space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpatialEndLoad {
    /// Force (N).
    pub force: Vector3<f64>,
    /// Moment about the end (N m).
    pub moment: Vector3<f64>,
}

impl SpatialEndPose {
    /// The pose of an end that is attached to this one, as to a body whose centre this is: at a lever (m) in the axes
    /// of the body and turned from it.
    #[must_use]
    pub fn attached(&self, lever: Vector3<f64>, rotation: Rotation3<f64>) -> Self {
        let arm = self.rotation * lever;
        Self {
            place: self.place + arm,
            velocity: self.velocity + self.angular_velocity.cross(&arm),
            rotation: self.rotation * rotation,
            angular_velocity: self.angular_velocity,
        }
    }

    /// Tangent and vector across.
    fn directions(&self) -> [Vector3<f64>; 2] {
        [self.rotation * Vector3::x(), self.rotation * Vector3::y()]
    }

    /// Weights of the rates of the coordinates of an end (rows) on velocity and angular velocity.
    #[must_use]
    pub fn rows(&self) -> SMatrix<f64, KNOT, 6> {
        let mut rows = SMatrix::<f64, KNOT, 6>::zeros();
        rows.fixed_view_mut::<3, 3>(0, 0).fill_with_identity();
        for (i, direction) in self.directions().iter().enumerate() {
            let block = -direction.cross_matrix();
            rows.fixed_view_mut::<3, 3>(3 * (i + 1), 3).copy_from(&block);
        }
        rows
    }
}

impl SpatialRod {
    /// The coordinates that a support gives.
    #[must_use]
    pub fn held(&self, end: End, support: Support, pose: &SpatialEndPose) -> Vec<Held> {
        let first = self.first_coordinate(end);
        let [tangent, across] = pose.directions();
        let values = [pose.place, tangent, across];
        let turning = |direction: &Vector3<f64>| pose.angular_velocity.cross(direction);
        let rates = [pose.velocity, turning(&tangent), turning(&across)];
        let n_held = support.n_held(3);
        let held = |i: usize| Held {
            coordinate: first + i,
            value: values[i / 3][i % 3],
            rate: rates[i / 3][i % 3],
        };
        (0..n_held).map(held).collect()
    }

    /// What a support does to the rod, by the loads (n) that its equations of motion leave open, M dv/dt + f - Q.
    #[must_use]
    pub fn end_load(
        &self,
        end: End,
        coordinates: &DVector<f64>,
        residual: &DVector<f64>,
    ) -> SpatialEndLoad {
        let first = self.first_coordinate(end);
        let part = |of: &DVector<f64>, i: usize| of.fixed_rows::<3>(first + 3 * i).into_owned();
        let moment = |i: usize| part(coordinates, i).cross(&part(residual, i));
        SpatialEndLoad { force: part(residual, 0), moment: moment(1) + moment(2) }
    }

    /// Where the base is, and how it moves: as the frame of the section there.
    pub(super) fn base_motion(
        &self,
        coordinates: &DVector<f64>,
        velocities: &DVector<f64>,
    ) -> BaseMotion {
        let part = |of: &DVector<f64>, first: usize| of.fixed_rows::<3>(first).into_owned();
        let across = part(coordinates, 6);
        let frame = Frame::new(&part(coordinates, 3).into(), &across.into());
        let [tangent, second] = [frame.tangent, frame.second].map(Vector3::from);
        let rate = part(velocities, 3);
        let bending = tangent.cross(&rate) / frame.stretch;
        let twisting = part(velocities, 6).dot(&second)
            - across.dot(&tangent) * rate.dot(&second) / frame.stretch;
        BaseMotion {
            place: part(coordinates, 0),
            velocity: part(velocities, 0),
            angular_velocity: bending + tangent * (twisting / frame.width),
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
        for first in (0..coordinates.len()).step_by(3) {
            let vector = coordinates.fixed_rows::<3>(first).into_owned();
            let rate = if first % KNOT == 0 {
                velocity + angular_velocity.cross(&(vector - place))
            } else {
                angular_velocity.cross(&vector)
            };
            rates.fixed_rows_mut::<3>(first).copy_from(&rate);
        }
        rates
    }
}
