//! `MovingSurface`: the velocity of the surface of a body by those the body has.

use std::collections::BTreeMap;

use alewife_mesh::{NodeId, Outline};
use nalgebra::Vector3;

use super::kinematics::turned_component;
use crate::body::{Mode, Modes, Pose, Twist};
use crate::gait::{DeformedOutline, Gait};
use crate::structure::Weight;

/// Where the nodes of a mesh on bodies with coordinates are at rest (m).
pub type RestPlaces = BTreeMap<NodeId, Vector3<f64>>;

/// The surface of a body at one time.
pub struct MovingSurface<'a> {
    pub(super) gait: Option<&'a dyn Gait>,
    /// The shape in the frame of the body, and where the outline of one in the plane is in the world.
    pub(super) shape: Option<(&'a DeformedOutline, Option<Outline>)>,
    /// Whether it follows coordinates.
    pub(super) is_flexible: bool,
    /// The first coordinate of the body.
    pub(super) first: usize,
    pub(super) pose: Pose,
    pub(super) time: f64,
}

/// A velocity of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum BodyVelocity {
    /// In a rigid motion.
    Rigid(Mode),
    /// The rate of a coordinate, numbered through all bodies.
    Rate(usize),
}

/// A velocity of the surface: weights times velocities of the body, plus a remainder (m/s).
pub(super) struct SurfaceRow {
    pub weights: Vec<(BodyVelocity, f64)>,
    pub remainder: f64,
}

impl MovingSurface<'_> {
    /// The velocity along an axis at a point of the surface (m), which is at rest elsewhere where the body has coordinates.
    pub(super) fn rows<const D: usize>(
        &self,
        point: &Vector3<f64>,
        rest: Option<&Vector3<f64>>,
        modes: Modes,
    ) -> [SurfaceRow; D] {
        if self.is_flexible {
            let weights = rest.map(|rest| self.weights(rest)).unwrap_or_default();
            let first = self.first;
            return std::array::from_fn(|axis| {
                let weight =
                    |at: &Weight| (BodyVelocity::Rate(first + at.coordinate), at.weight[axis]);
                SurfaceRow { weights: weights.iter().map(weight).collect(), remainder: 0.0 }
            });
        }
        let slip = self.velocity(point);
        let lever = point - self.pose.center;
        std::array::from_fn(|axis| {
            let weights = modes.iter().filter_map(|mode| {
                let weight = match (mode.is_rotation(), mode.axis() == axis) {
                    (false, true) => 1.0,
                    (true, false) => turned_component(mode, &lever, axis),
                    (false, false) | (true, true) => return None,
                };
                Some((BodyVelocity::Rigid(mode), weight))
            });
            SurfaceRow { weights: weights.collect(), remainder: slip[axis] }
        })
    }

    /// The velocity (m/s) with which these rigid velocities and rates of the coordinates of all bodies carry a point
    /// of the surface (m).
    pub(super) fn carried(
        &self,
        twist: &Twist,
        rates: &[f64],
        point: &Vector3<f64>,
        rest: Option<&Vector3<f64>>,
    ) -> Vector3<f64> {
        if self.is_flexible {
            let weights = rest.map(|rest| self.weights(rest)).unwrap_or_default();
            return weights.iter().map(|at| at.weight * rates[self.first + at.coordinate]).sum();
        }
        let lever = point - self.pose.center;
        twist.velocity_at(&lever) + self.velocity(point)
    }

    /// What coordinates count at the point that is at rest at a place (m), in the world.
    fn weights(&self, rest: &Vector3<f64>) -> Vec<Weight> {
        let rotation = self.pose.rotation();
        let weights = self.shape.as_ref().map(|(deformed, _)| deformed.weights(rest));
        let turned = |at: Weight| Weight { weight: rotation * at.weight, ..at };
        weights.unwrap_or_default().into_iter().map(turned).collect()
    }

    /// Velocity of the surface relative to the rigid motion, in the world (m/s), at a point of it
    /// (m), without what coordinates give of it.
    fn velocity(&self, point: &Vector3<f64>) -> Vector3<f64> {
        let rotation = self.pose.rotation();
        let mut velocity = Vector3::zeros();
        if let Some(gait) = self.gait {
            let lever = point - self.pose.center;
            velocity += gait.velocity(&(rotation.inverse() * lever), self.time);
        }
        if let Some((deformed, outline)) = &self.shape {
            velocity += match outline {
                Some(outline) => {
                    let rate = deformed.rate(outline.parameter_of(point.xy()));
                    Vector3::new(rate.x, rate.y, 0.0)
                }
                None => {
                    let place = rotation.inverse() * (point - self.pose.center);
                    deformed.velocity(deformed.material_at(&place))
                }
            };
        }
        rotation * velocity
    }
}
