//! Bodies that hang on others: their places and velocities by those of what they hang on.
//!
//! With a the lever from the centre of the parent to the joint and b that from the centre of the
//! child, both in the world, U_child = U_parent + omega_parent x a + Q da/dt - omega_child x b. The
//! velocities of a tree are so made of those of its root and of its free pivots: reduced coordinates,
//! in which Newton's and Euler's equations of all bodies are those of each body, tested with these
//! combinations (Kane's equations).

use nalgebra::{Rotation2, Vector2};

use super::problem::{Problem, TimeValue};

/// A number and its rate as a function of time (s).
pub type MovingValue = Box<dyn Fn(f64) -> [f64; 2] + Send + Sync>;

/// How a body hangs on another.
pub struct Link {
    /// The body it hangs on.
    pub parent: usize,
    /// The joint in the frame of the parent, from its centre of mass (m).
    pub on_parent: Vector2<f64>,
    /// What is between the joints of parent and child; nothing at a pivot.
    pub arm: Option<Arm>,
    /// The joint in the frame of the child, from its centre of mass (m).
    pub on_child: Vector2<f64>,
    /// The angle of the child less that of the parent.
    pub turn: Turn,
}

/// A bar of given length that turns with the parent.
pub struct Arm {
    /// Its direction in the frame of the parent, a unit vector.
    pub along: Vector2<f64>,
    /// Its length (m, m/s).
    pub length: MovingValue,
}

impl Link {
    /// Where the joint of the child is in the frame of the parent, from its centre of mass, and the rate
    /// of that (m, m/s).
    fn ahead(&self, time: f64) -> [Vector2<f64>; 2] {
        let Some(arm) = &self.arm else { return [self.on_parent, Vector2::zeros()] };
        let [length, rate] = (arm.length)(time);
        [self.on_parent + arm.along * length, arm.along * rate]
    }
}

/// The angle of a child less that of its parent.
pub enum Turn {
    /// Given (rad, rad/s).
    Given(MovingValue),
    /// Free, with a load.
    Free(Pivot),
}

/// Torque on the child: -stiffness (angle - rest) - damping rate + motor; the opposite on the parent.
pub struct Pivot {
    /// Torque per angle (N m).
    pub stiffness: f64,
    /// Torque per angular velocity (N m s).
    pub damping: f64,
    /// Angle at rest (rad).
    pub rest: f64,
    /// Torque of a motor (N m).
    pub motor: Option<TimeValue>,
}

/// A rigid velocity as a sum of weight times a rigid velocity (body, mode) that hangs on nothing, and
/// a value.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct RigidRow {
    pub entries: Vec<((usize, usize), f64)>,
    pub value: f64,
}

impl RigidRow {
    fn master(body: usize, mode: usize) -> Self {
        Self { entries: vec![((body, mode), 1.0)], value: 0.0 }
    }

    /// This plus `weight` times another.
    fn plus(mut self, other: &Self, weight: f64) -> Self {
        for (master, entry) in &other.entries {
            match self.entries.iter_mut().find(|(known, _)| known == master) {
                Some((_, sum)) => *sum += weight * entry,
                None => self.entries.push((*master, weight * entry)),
            }
        }
        self.value += weight * other.value;
        self
    }
}

impl Problem {
    /// The bodies, each after the one it hangs on.
    pub(super) fn outwards(&self) -> Vec<usize> {
        let mut order = Vec::with_capacity(self.bodies.len());
        let mut is_done = vec![false; self.bodies.len()];
        while order.len() < self.bodies.len() {
            let before = order.len();
            for (body, rigid) in self.bodies.iter().enumerate() {
                let is_next = rigid.link.as_ref().is_none_or(|link| is_done[link.parent]);
                if !is_done[body] && is_next {
                    is_done[body] = true;
                    order.push(body);
                }
            }
            // Circles are refused with the case.
            if order.len() == before {
                break;
            }
        }
        order
    }

    /// Whether any body hangs on another.
    #[must_use]
    pub fn has_links(&self) -> bool {
        self.bodies.iter().any(|body| body.link.is_some())
    }

    /// Puts the bodies that hang where those they hang on want them at a time (s); angles of free
    /// pivots are those there are.
    pub fn hang(&self, places: &mut [[f64; 3]], time: f64) {
        if !self.has_links() {
            return;
        }
        for body in self.outwards() {
            let Some(link) = &self.bodies[body].link else { continue };
            let parent = places[link.parent];
            if let Turn::Given(angle) = &link.turn {
                places[body][2] = parent[2] + angle(time)[0];
            }
            let [ahead, back] = self.levers(body, link, places, time);
            places[body][0] = parent[0] + ahead.x - back.x;
            places[body][1] = parent[1] + ahead.y - back.y;
        }
    }

    /// Levers in the world from the centres of parent and child to their joint (m).
    fn levers(
        &self,
        body: usize,
        link: &Link,
        places: &[[f64; 3]],
        time: f64,
    ) -> [Vector2<f64>; 2] {
        let ahead = Rotation2::new(places[link.parent][2]) * link.ahead(time)[0];
        [ahead, Rotation2::new(places[body][2]) * link.on_child]
    }

    /// The rigid velocities of all bodies by those that hang on nothing.
    pub(super) fn rigid_rows(&self, places: &[[f64; 3]], time: f64) -> Vec<[RigidRow; 3]> {
        let mut rows: Vec<[RigidRow; 3]> = (0..self.bodies.len())
            .map(|body| [0, 1, 2].map(|mode| RigidRow::master(body, mode)))
            .collect();
        for body in self.outwards() {
            let Some(link) = &self.bodies[body].link else { continue };
            if let Turn::Given(angle) = &link.turn {
                rows[body][2] = rows[link.parent][2].clone();
                rows[body][2].value += angle(time)[1];
            }
            let [ahead, back] = self.levers(body, link, places, time);
            let rate = Rotation2::new(places[link.parent][2]) * link.ahead(time)[1];
            let along = |mode: usize, ahead: f64, back: f64, rate: f64| {
                let mut row = rows[link.parent][mode].clone();
                if self.metric.has_rotation() {
                    row = row.plus(&rows[link.parent][2], ahead).plus(&rows[body][2], back);
                }
                row.value += rate;
                row
            };
            let x = along(0, -ahead.y, back.y, rate.x);
            let y = along(1, ahead.x, -back.x, rate.y);
            let turn = std::mem::take(&mut rows[body][2]);
            rows[body] = [x, y, turn];
        }
        rows
    }
}
