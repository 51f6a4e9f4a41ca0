//! `RigidBodyEquations`: Newton's and Euler's equations of the bodies at one time.
//!
//! With V the rigid velocities of a body, M its mass matrix in the world and h the older part of the
//! difference of its momentum divided by M: M (rate V + h) + resistance V = fluid + external.

use nalgebra::{Matrix6, Vector3};

use super::problem::{Problem, RigidBody, Turn};
use super::shapes::BodyShapes;
use crate::body::{Inertia, Mode, Modes, Pose, RigidVector, Twist, carried_velocity};

/// The equations of all bodies.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RigidBodyEquations {
    /// Factor of the new velocity in its time derivative (1/s), 0 when steady.
    pub rate: f64,
    /// One for each body.
    pub bodies: Vec<RigidBodyEquation>,
    /// Loads in free pivots.
    pub pivots: Vec<PivotLoad>,
}

/// The equations of one body.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct RigidBodyEquation {
    /// Mass matrix in the world (kg, kg m2).
    pub inertia: Matrix6<f64>,
    /// Older part of the time derivative (m/s2, rad/s2).
    pub history: RigidVector,
    /// Load per velocity (N s/m, N m s/rad).
    pub resistance: RigidVector,
    /// Load from outside (N, N m).
    pub external: RigidVector,
}

/// Torque torque - resistance (omega_child - omega_parent) on a child in its pivot, the opposite on
/// its parent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PivotLoad {
    /// The body that hangs.
    pub child: usize,
    /// The body it hangs on.
    pub parent: usize,
    /// Torque per angular velocity (N m s).
    pub resistance: f64,
    /// Torque without the turning of this step (N m).
    pub torque: Vector3<f64>,
}

/// Where bodies get to: `expected` plus `coefficient` (s) times what their velocities differ by from
/// those that lead there from `unmoved`.
///
/// In the plane this is `unmoved` plus `coefficient` times the velocity, whatever is expected.
/// Rotations in space do not commute: from `unmoved` on it would be off by half the coefficient times
/// the angular velocity x the turn of a spring, which is of first order in the step.
#[derive(Debug, Clone, Copy)]
pub struct PosesByVelocity<'a> {
    /// Poses without velocity.
    pub unmoved: &'a [Pose],
    /// Poses that are expected, such as those for which the flow is solved.
    pub expected: &'a [Pose],
    /// Change of a pose by the velocity (s).
    pub coefficient: f64,
}

impl PosesByVelocity<'_> {
    /// Of bodies that stay where they are.
    #[must_use]
    pub fn staying(poses: &[Pose]) -> PosesByVelocity<'_> {
        PosesByVelocity { unmoved: poses, expected: poses, coefficient: 0.0 }
    }

    /// The displacement of a body from a pose, to which the velocity adds its part.
    fn way_from(&self, body: usize, rest: &Pose) -> RigidVector {
        let expected = &self.expected[body];
        expected.displacement_from(rest) - self.led_by_velocity(body)
    }

    /// What the velocity that is expected does.
    fn led_by_velocity(&self, body: usize) -> RigidVector {
        self.expected[body].displacement_from(&self.unmoved[body])
    }
}

/// Motion of a body at an older time.
#[derive(Debug, Clone, Copy)]
pub struct OlderMotion<'a> {
    /// Shapes then.
    pub shapes: &'a BodyShapes,
    /// Poses then.
    pub poses: &'a [Pose],
    /// Velocities then.
    pub twists: &'a [Twist],
}

impl OlderMotion<'_> {
    /// The velocity with which a body of the mass matrix `next` has the momentum it had then.
    #[must_use]
    pub fn carried(&self, rigid: &RigidBody, body: usize, next: &Inertial) -> RigidVector {
        let inertia = rigid.inertia_with(self.shapes.deformed(body));
        let then = inertia.matrix(&self.poses[body]);
        carried_velocity(&then, &next.matrix, &self.twists[body].to_vector(), next.modes)
    }
}

/// A mass matrix with the motions it is of.
#[derive(Debug, Clone, Copy)]
pub struct Inertial {
    /// Mass matrix in the world, 6 x 6.
    pub matrix: Matrix6<f64>,
    /// Rigid motions of the geometry.
    pub modes: Modes,
}

impl Inertial {
    /// Of a body with an inertia and a pose.
    #[must_use]
    pub fn new(inertia: &Inertia, pose: &Pose, modes: Modes) -> Self {
        Self { matrix: inertia.matrix(pose), modes }
    }
}

impl RigidBodyEquations {
    /// Bodies without acceleration at poses, under the loads of a time (s).
    #[must_use]
    pub fn steady<const D: usize>(problem: &Problem<D>, poses: &[Pose], time: f64) -> Self {
        let mut equations = Self::without_loads(problem.bodies.len());
        equations.add_loads(problem, time, PosesByVelocity::staying(poses));
        equations
    }

    /// Bodies without acceleration and loads.
    #[must_use]
    pub fn without_loads(n_bodies: usize) -> Self {
        Self { bodies: vec![RigidBodyEquation::default(); n_bodies], ..Self::default() }
    }

    /// Adds the loads and springs of a time (s).
    pub fn add_loads<const D: usize>(
        &mut self,
        problem: &Problem<D>,
        time: f64,
        reached: PosesByVelocity<'_>,
    ) {
        let PosesByVelocity { expected, coefficient, .. } = reached;
        for (child, rigid) in problem.bodies.iter().enumerate() {
            let Some(joint) = &rigid.joint else { continue };
            let Turn::Free(pivot) = &joint.turn else { continue };
            let at_rest = expected[joint.parent].composed(&joint.rest);
            let turned = reached.way_from(child, &at_rest) + reached.led_by_velocity(joint.parent);
            let motor = pivot.motor.as_ref().map_or(0.0, |motor| motor(time));
            let axis = pivot.axis.map(|axis| expected[joint.parent].to_world(&axis));
            let about_axis = |value: f64| axis.map_or_else(Vector3::zeros, |axis| axis * value);
            let bend = turned.fixed_rows::<3>(3) - about_axis(pivot.rest);
            self.pivots.push(PivotLoad {
                child,
                parent: joint.parent,
                resistance: pivot.damping + pivot.stiffness * coefficient,
                torque: about_axis(motor) - bend * pivot.stiffness,
            });
        }
        for (body, (equation, rigid)) in self.bodies.iter_mut().zip(&problem.bodies).enumerate() {
            equation.external = rigid.external(time, &expected[body]);
            let Some(spring) = &rigid.spring else { continue };
            equation.resistance = spring.damping + spring.stiffness * coefficient;
            let way = reached.way_from(body, &spring.rest);
            equation.external -= spring.stiffness.component_mul(&way);
        }
    }

    /// Adds what bodies and pivots lack to balance the loads of the fluid at rigid velocities to the
    /// rows of a raw residual, `row(body, mode)` its index.
    pub(super) fn add_residual(
        &self,
        twists: &[Twist],
        modes: Modes,
        row: impl Fn(usize, usize) -> usize,
        raw: &mut [f64],
    ) {
        for (body, equation) in self.bodies.iter().enumerate() {
            let velocity = twists[body].to_vector();
            let momentum_rate = equation.inertia * (velocity * self.rate + equation.history);
            for (position, mode) in modes.iter().enumerate() {
                raw[row(body, position)] += momentum_rate[mode]
                    + equation.resistance[mode] * velocity[mode]
                    - equation.external[mode];
            }
        }
        for pivot in &self.pivots {
            let relative = twists[pivot.child].angular - twists[pivot.parent].angular;
            let torque = pivot.torque - relative * pivot.resistance;
            for (position, mode) in rotations(modes) {
                raw[row(pivot.child, position)] -= torque[mode.axis()];
                raw[row(pivot.parent, position)] += torque[mode.axis()];
            }
        }
    }
}

/// The rotations among some motions, with their positions among them.
pub(super) fn rotations(modes: Modes) -> impl Iterator<Item = (usize, Mode)> {
    modes.iter().enumerate().filter(|(_, mode)| mode.is_rotation())
}
