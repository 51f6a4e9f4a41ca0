//! `Metric`: whether coordinates are Cartesian, or the mesh is a meridian half plane revolved about x.
//!
//! Revolved, x runs along the axis and y = r is the distance from it. A point of the half plane
//! stands for a ring: dV = 2 pi r dx dr, div u = d_x u_x + d_r u_r + u_r / r, and the strain rate has
//! the hoop component u_r / r besides those in the plane. Nothing depends on the angle, so that the
//! forces on a ring sum to one along the axis, and a body can move along the axis only.

use std::f64::consts::TAU;

use alewife_mesh::Point;
use nalgebra::Vector3;

/// How lengths along the mesh's coordinates make volumes, strains and loads.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Metric {
    /// Cartesian coordinates; with two of them, quantities are per unit length across the plane.
    #[default]
    Cartesian,
    /// The half plane y >= 0, revolved about x.
    Revolved,
}

impl Metric {
    /// The coordinate along the axis of revolution.
    pub const AXIAL: usize = 0;
    /// The coordinate that is the distance from the axis of revolution.
    pub const RADIAL: usize = 1;

    /// Whether the mesh is revolved about an axis.
    #[must_use]
    pub fn is_revolved(self) -> bool {
        self == Self::Revolved
    }

    /// Factor by which an integral over the mesh is one over what it stands for: the length of the
    /// ring through a point, 2 pi r (m), or 1.
    #[must_use]
    pub fn ring<const D: usize>(self, position: &Point<D>) -> f64 {
        match self {
            Self::Cartesian => 1.0,
            Self::Revolved => TAU * position[Self::RADIAL],
        }
    }

    /// Polynomial degree of the factor [`Self::ring`].
    #[must_use]
    pub fn ring_degree(self) -> usize {
        match self {
            Self::Cartesian => 0,
            Self::Revolved => 1,
        }
    }

    /// Rate of stretching of the ring through a point, u_r / r (1/s).
    #[must_use]
    pub fn hoop_strain<const D: usize>(self, velocity: &Point<D>, position: &Point<D>) -> f64 {
        match self {
            Self::Cartesian => 0.0,
            Self::Revolved => velocity[Self::RADIAL] / position[Self::RADIAL],
        }
    }

    /// Sum (N) of a force that acts at a point of the mesh: revolved, radial forces cancel.
    #[must_use]
    pub fn total_force<const D: usize>(self, force: &Point<D>) -> Vector3<f64> {
        match self {
            Self::Cartesian => in_space(force),
            Self::Revolved => Vector3::new(force[Self::AXIAL], 0.0, 0.0),
        }
    }

    /// Torque (N m) of a force that acts at a point of the mesh, about the point that is `lever`
    /// behind it; revolved, none remains.
    #[must_use]
    pub fn total_torque<const D: usize>(self, lever: &Point<D>, force: &Point<D>) -> Vector3<f64> {
        match self {
            Self::Cartesian => in_space(lever).cross(&in_space(force)),
            Self::Revolved => Vector3::zeros(),
        }
    }

    /// Whether a body can move along a coordinate: revolved, along the axis only.
    #[must_use]
    pub fn has_translation(self, axis: usize) -> bool {
        match self {
            Self::Cartesian => true,
            Self::Revolved => axis == Self::AXIAL,
        }
    }

    /// Whether a body can turn.
    #[must_use]
    pub fn has_rotation(self) -> bool {
        self == Self::Cartesian
    }

    /// Name of a coordinate, as an adjective of a velocity.
    #[must_use]
    pub fn axis_name(self, axis: usize) -> &'static str {
        match self {
            Self::Cartesian => ["x", "y", "z"][axis],
            Self::Revolved => ["axial", "radial"][axis],
        }
    }
}

/// A vector of the mesh in space: components it lacks are zero.
fn in_space<const D: usize>(vector: &Point<D>) -> Vector3<f64> {
    Vector3::from_fn(|axis, _| if axis < D { vector[axis] } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_radial_velocity_proportional_to_r_stretches_every_ring_at_the_same_rate() {
        let position = Point::<2>::new(0.3, 0.7);
        let velocity = Point::<2>::new(0.0, 2.0 * position[1]);
        assert_eq!(Metric::Revolved.hoop_strain(&velocity, &position), 2.0);
        assert_eq!(Metric::Cartesian.hoop_strain(&velocity, &position), 0.0);
    }

    /// Forces that turn with the angle about the axis, summed over a ring of many points.
    #[test]
    fn forces_and_torques_on_a_ring_sum_to_the_axial_force() {
        let (force, lever) = (Point::<2>::new(1.3, -0.4), Point::<2>::new(0.2, 0.9));
        let (mut sum, mut torque) = (Vector3::zeros(), Vector3::zeros());
        let n = 16;
        for i in 0..n {
            let (sin, cos) = (TAU * f64::from(i) / f64::from(n)).sin_cos();
            let turned = |v: &Point<2>| Vector3::new(v[0], v[1] * cos, v[1] * sin);
            sum += turned(&force) / f64::from(n);
            torque += turned(&lever).cross(&turned(&force)) / f64::from(n);
        }
        assert!((sum - Metric::Revolved.total_force(&force)).norm() < 1e-15);
        assert!((torque - Metric::Revolved.total_torque(&lever, &force)).norm() < 1e-15);
    }

    #[test]
    fn a_planar_force_has_its_torque_about_z() {
        let (force, lever) = (Point::<2>::new(1.5, -0.5), Point::<2>::new(0.25, 2.0));
        let torque = Metric::Cartesian.total_torque(&lever, &force);
        assert_eq!(torque, Vector3::new(0.0, 0.0, 0.25 * -0.5 - 2.0 * 1.5));
        assert_eq!(Metric::Cartesian.total_force(&force), Vector3::new(1.5, -0.5, 0.0));
    }
}
