//! `Path`: the ball about a body on a straight way, and when it gets to sides of the domain and to other balls.

use crate::model::speed::norm;
use crate::spec::extent::Extent;
use crate::{Body, Model};

/// Part of a velocity below which one of its components is rounding.
pub(super) const ROUNDING: f64 = 1e-6;

/// Where a body is going.
pub(super) struct Path {
    pub center: [f64; 3],
    pub velocity: [f64; 3],
    pub reach: f64,
}

impl Path {
    /// That of a body with a velocity (m/s).
    pub fn of(body: &Body, velocity: [f64; 3]) -> Self {
        let center = [0, 1, 2].map(|axis| body.center.get(axis).copied().unwrap_or(0.0));
        Self { center, velocity, reach: body.shape.reach() }
    }

    /// When it gets to the corners of the domain along those coordinates that have sides there (s).
    pub fn time_to_sides(&self, extent: &Extent, has_sides: impl Fn(usize) -> bool) -> Option<f64> {
        let times = (0..3).filter(|axis| has_sides(*axis)).filter_map(|axis| {
            let velocity = self.velocity[axis];
            let distance = if velocity > 0.0 {
                extent.max[axis] - self.center[axis] - self.reach
            } else {
                self.center[axis] - self.reach - extent.min[axis]
            };
            let is_on_its_way = velocity.abs() > ROUNDING * norm(&self.velocity);
            is_on_its_way.then(|| (distance / velocity.abs()).max(0.0))
        });
        times.min_by(f64::total_cmp)
    }

    /// When it touches another one (s). Of thousands of bodies all pairs are looked at: plain sums.
    pub fn time_to(&self, other: &Self) -> Option<f64> {
        let (mut approach, mut speed, mut distance) = (0.0, 0.0, 0.0);
        for axis in 0..3 {
            let apart = other.center[axis] - self.center[axis];
            let velocity = other.velocity[axis] - self.velocity[axis];
            approach -= apart * velocity;
            speed += velocity * velocity;
            distance += apart * apart;
        }
        if approach <= 0.0 {
            return None;
        }
        let touching = (self.reach + other.reach).powi(2);
        let discriminant = approach * approach - speed * (distance - touching);
        (discriminant >= 0.0).then(|| ((approach - discriminant.sqrt()) / speed).max(0.0))
    }
}

impl Model {
    /// Whether a body is attached to nothing.
    pub(super) fn is_single(&self, index: usize) -> bool {
        let name = &self.bodies[index].name;
        self.joint_above(index).is_none() && !self.joints.iter().any(|joint| joint.parent == *name)
    }
}
