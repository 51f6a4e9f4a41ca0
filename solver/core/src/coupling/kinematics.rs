//! Forward kinematics of bodies that hang on others: their poses and velocities by those of their parents.
//!
//! With a the lever from the centre of the parent to the joint and b that from the centre of the
//! child, both in the world, U_child = U_parent + omega_parent x a + R da/dt - omega_child x b. The
//! velocities of a tree are so made of those of its root, of its free pivots and of its arms of free
//! length: reduced coordinates, in which Newton's and Euler's equations of all bodies are those of each body, tested with these
//! combinations (Kane's equations).

use nalgebra::Vector3;

use super::problem::{FreeArm, Joint, Pivot, Problem, Turn};
use crate::body::{Mode, Modes, Pose, RigidVector, Twist};

/// A rigid velocity of a body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct RigidUnknown {
    pub body: usize,
    pub mode: Mode,
}

/// A rigid velocity as a sum of weight times a rigid velocity that is independent, and a value.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct RigidRow {
    pub entries: Vec<(RigidUnknown, f64)>,
    pub value: f64,
}

impl RigidRow {
    fn independent(body: usize, mode: Mode) -> Self {
        Self { entries: vec![(RigidUnknown { body, mode }, 1.0)], value: 0.0 }
    }

    /// Whether it is independent itself.
    pub fn is(&self, body: usize, mode: Mode) -> bool {
        self.value == 0.0 && self.entries == [(RigidUnknown { body, mode }, 1.0)]
    }

    /// This plus `weight` times another.
    fn plus(mut self, other: &Self, weight: f64) -> Self {
        for (unknown, entry) in &other.entries {
            match self.entries.iter_mut().find(|(known, _)| known == unknown) {
                Some((_, sum)) => *sum += weight * entry,
                None => self.entries.push((*unknown, weight * entry)),
            }
        }
        self.value += weight * other.value;
        self
    }
}

/// The rigid velocities of one body, by [`Mode`].
pub(super) type RigidRows = [RigidRow; 6];

/// Levers from the centres of parent and child to their joint, and the given rate of the first one at
/// rest, all in the world.
pub(super) struct Levers {
    pub parent: Vector3<f64>,
    pub child: Vector3<f64>,
    rate: Vector3<f64>,
}

impl Levers {
    pub fn new(joint: &Joint, [parent, child]: [&Pose; 2], time: f64) -> Self {
        let [lever, rate] = joint.lever_on_parent([parent, child], time);
        Self {
            parent: parent.to_world(&lever),
            child: child.to_world(&joint.on_child),
            rate: parent.to_world(&rate),
        }
    }
}

impl<const D: usize> Problem<D> {
    /// The bodies, each after the one it hangs on. Circles of joints are refused with the case.
    pub(super) fn parents_first(&self) -> Vec<usize> {
        let depth = |body: usize| {
            let parent =
                |body: &usize| self.bodies[*body].joint.as_ref().and_then(|joint| joint.parent);
            std::iter::successors(Some(body), parent).take(self.bodies.len()).count()
        };
        let mut order: Vec<usize> = (0..self.bodies.len()).collect();
        order.sort_by_cached_key(|body| depth(*body));
        order
    }

    /// Puts the bodies that hang on others where those want them at a time (s); rotations in free pivots
    /// and lengths that are free are those there are.
    pub fn apply_joints(&self, poses: &mut [Pose], time: f64) {
        if !self.has_joints() {
            return;
        }
        for body in self.parents_first() {
            let Some(joint) = &self.bodies[body].joint else { continue };
            let parent = joint.parent_pose(poses, body);
            let known = match &joint.turn {
                Turn::Given { axis, angle } => Some((axis, angle(time)[0])),
                // In the plane there is but one axis
                Turn::Free(Pivot { axis: Some(axis), .. }) if D == 3 => {
                    Some((axis, joint.angle_about(axis, [&parent, &poses[body]])))
                }
                Turn::Free(_) => None,
            };
            if let Some((axis, angle)) = known {
                let turned = parent.turned(axis, angle);
                poses[body].orientation = turned.composed(&joint.rest).orientation;
            }
            let levers = Levers::new(joint, [&parent, &poses[body]], time);
            poses[body].center = parent.center + levers.parent - levers.child;
        }
    }

    /// The velocities of the bodies at time zero, at these poses: those that are free as they start, others as they
    /// are given or follow. `None` where all that is free starts at rest.
    #[must_use]
    pub fn initial_twists(&self, poses: &[Pose]) -> Option<Vec<Twist>> {
        if self.bodies.iter().all(|body| body.initial == Twist::default()) {
            return None;
        }
        let independent = |of: &RigidUnknown| {
            let body = &self.bodies[of.body];
            body.drive(of.mode).given(0.0).unwrap_or_else(|| body.initial.component(of.mode))
        };
        let velocity = |row: &RigidRow| {
            let entries = row.entries.iter();
            row.value + entries.map(|(of, weight)| weight * independent(of)).sum::<f64>()
        };
        let twist = |rows: &RigidRows| {
            Twist::from_vector(&RigidVector::from_fn(|index, _| velocity(&rows[index])))
        };
        Some(self.rigid_rows(poses, 0.0).iter().map(twist).collect())
    }

    /// The rigid velocities of all bodies by those that are independent.
    pub(super) fn rigid_rows(&self, poses: &[Pose], time: f64) -> Vec<RigidRows> {
        let modes = self.modes();
        let mut rows: Vec<RigidRows> = (0..self.bodies.len())
            .map(|body| Mode::ALL.map(|mode| RigidRow::independent(body, mode)))
            .collect();
        for body in self.parents_first() {
            let Some(joint) = &self.bodies[body].joint else { continue };
            let parent = &joint.parent_pose(poses, body);
            let of_parent = match joint.parent {
                Some(above) => rows[above].clone(),
                None => std::array::from_fn(|_| RigidRow::default()),
            };
            match &joint.turn {
                Turn::Given { axis, angle } => {
                    let axis = parent.to_world(axis);
                    for mode in modes.rotations() {
                        rows[body][mode] = of_parent[mode].clone();
                        rows[body][mode].value += angle(time)[1] * axis[mode.axis()];
                    }
                }
                Turn::Free(Pivot { axis: Some(axis), .. }) if D == 3 => {
                    let axis = parent.to_world(axis);
                    turn_about(&axis, &mut rows, &of_parent, body);
                }
                Turn::Free(_) => {}
            }
            let levers = Levers::new(joint, [parent, &poses[body]], time);
            let mut translations: [RigidRow; D] = std::array::from_fn(|axis| {
                joined_row([&of_parent, &rows[body]], &levers, modes, axis)
            });
            if let Some(FreeArm { arm, .. }) = joint.free_arm() {
                slide_along(&parent.to_world(&arm.along), &mut translations, body);
            }
            for (axis, row) in translations.into_iter().enumerate() {
                rows[body][Mode::along(axis)] = row;
            }
        }
        rows
    }
}

/// The angular velocity of a child that turns freely about an axis fixed to its parent (in the world):
/// omega_child = omega_parent + q axis, q from the component of omega_child where the axis is longest.
fn turn_about(axis: &Vector3<f64>, rows: &mut [RigidRows], parent: &RigidRows, child: usize) {
    let longest = axis.iamax();
    let free = Mode::about(longest);
    let rate = RigidRow::independent(child, free).plus(&parent[free], -1.0);
    for mode in Modes::SPATIAL.rotations().filter(|mode| *mode != free) {
        let weight = axis[mode.axis()] / axis[longest];
        rows[child][mode] = parent[mode].clone().plus(&rate, weight);
    }
}

/// The velocity of a child that slides freely along an arm (in the world), from that without a rate of its
/// length: the component along which the arm is longest is an unknown.
fn slide_along<const D: usize>(arm: &Vector3<f64>, rows: &mut [RigidRow; D], child: usize) {
    let longest = arm.iamax();
    let free = RigidRow::independent(child, Mode::along(longest));
    let rate = free.clone().plus(&rows[longest], -1.0);
    for (axis, row) in rows.iter_mut().enumerate() {
        *row = if axis == longest {
            free.clone()
        } else {
            std::mem::take(row).plus(&rate, arm[axis] / arm[longest])
        };
    }
}

/// The velocity along an axis of a child by the rows of parent and child.
fn joined_row(
    [parent, child]: [&RigidRows; 2],
    levers: &Levers,
    modes: Modes,
    axis: usize,
) -> RigidRow {
    let mut row = parent[Mode::along(axis)].clone();
    for mode in modes.rotations().filter(|mode| mode.axis() != axis) {
        row = row.plus(&parent[mode], turned_component(mode, &levers.parent, axis));
        row = row.plus(&child[mode], -turned_component(mode, &levers.child, axis));
    }
    row.value += levers.rate[axis];
    row
}

/// The velocity along an axis at a lever (m) by a unit angular velocity: (e x lever) . e_axis.
pub(super) fn turned_component(rotation: Mode, lever: &Vector3<f64>, axis: usize) -> f64 {
    let about = rotation.axis();
    // The cyclic order x, y, z
    if (about + 1) % 3 == axis {
        -lever[(about + 2) % 3]
    } else if (about + 2) % 3 == axis {
        lever[(about + 1) % 3]
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turned_components_are_those_of_the_cross_product() {
        let lever = Vector3::new(0.3, -1.2, 2.5);
        for mode in Modes::SPATIAL.rotations() {
            let exact = Vector3::ith(mode.axis(), 1.0).cross(&lever);
            for axis in 0..3 {
                assert_eq!(turned_component(mode, &lever, axis), exact[axis]);
            }
        }
    }
}
