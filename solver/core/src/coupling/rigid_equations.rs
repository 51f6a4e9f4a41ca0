//! `RigidBodyEquations`: Newton's and Euler's equations of the bodies at one time.
//!
//! With V the rigid velocities of a body, M its mass matrix in the world and h the older part of the
//! difference of its momentum divided by M: M (rate V + h) + resistance V = fluid + external.

use nalgebra::{Matrix3, Matrix6, Vector3};

use super::flexible_equation::FlexibleEquation;
use super::kinematics::Levers;
use super::problem::{FreeArm, Joint, JointLaw, Problem, RigidBody, Turn};
use super::shapes::BodyShapes;
use crate::body::{Inertia, Mode, Modes, Pose, RigidVector, Twist, Wrench, carried_velocity};

/// The equations of all bodies.
#[derive(Debug, Clone, Default)]
pub struct RigidBodyEquations {
    /// Factor of the new velocity in its time derivative (1/s), 0 when steady.
    pub rate: f64,
    /// One for each body.
    pub bodies: Vec<RigidBodyEquation>,
    /// Loads in free pivots and along arms of free length.
    pub joints: Vec<JointLoad>,
    /// Of bodies with coordinates, in which the rigid velocities of these have no part.
    pub flexible: Vec<FlexibleEquation>,
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
    /// Torque per angular velocity by which a magnetic field or buoyancy turns its body in a step (N m s/rad).
    pub magnetic: Option<Matrix3<f64>>,
}

impl RigidBodyEquation {
    /// Adds the torque of a field or of buoyancy by a stiffness (N m/rad) where the velocity that is expected has led to a turn, and
    /// a velocity adds `coefficient` (s) times itself.
    fn add_turning(&mut self, stiffness: &Matrix3<f64>, led: &RigidVector, coefficient: f64) {
        let turned = stiffness * led.fixed_rows::<3>(3);
        for axis in 0..3 {
            self.external[3 + axis] += turned[axis];
        }
        self.magnetic = Some(stiffness * coefficient);
    }

    /// Torque of field and buoyancy against an angular velocity about an axis, by one about another (N m s/rad).
    pub(super) fn magnetic_resistance(&self, one: Mode, other: Mode) -> Option<f64> {
        let is_turn = one.is_rotation() && other.is_rotation();
        let of_axes = |resistance: Matrix3<f64>| resistance[(one.axis(), other.axis())];
        self.magnetic.filter(|_| is_turn).map(of_axes)
    }
}

/// Load - resistance rate along a coordinate of a joint. The rate is on_child . V_child + on_parent .
/// V_parent with the rigid velocities V, so that the loads on the bodies are those vectors times it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointLoad {
    /// The body that hangs.
    pub child: usize,
    /// The body it hangs on, if it is one.
    pub parent: Option<usize>,
    /// Rate of the coordinate by velocities of the child.
    pub on_child: RigidVector,
    /// Rate of the coordinate by velocities of the parent.
    pub on_parent: RigidVector,
    /// Load per rate (N m s/rad, N s/m).
    pub resistance: f64,
    /// Load without the motion of this step (N m, N).
    pub load: f64,
}

impl JointLoad {
    /// The rate of the coordinate at rigid velocities.
    fn rate(&self, twists: &[Twist]) -> f64 {
        let parent = self.parent.map_or(0.0, |body| self.on_parent.dot(&twists[body].to_vector()));
        self.on_child.dot(&twists[self.child].to_vector()) + parent
    }
}

/// A joint with the child that hangs by it, at a time (s).
#[derive(Clone, Copy)]
struct JointAt<'a> {
    joint: &'a Joint,
    child: usize,
    time: f64,
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

    /// What the velocity that is expected does to what a joint hangs on.
    fn led_parent(&self, joint: &Joint) -> RigidVector {
        joint.parent.map_or_else(RigidVector::zeros, |parent| self.led_by_velocity(parent))
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
    /// Bodies without acceleration at poses, those with coordinates as they start, under the loads of a time (s).
    #[must_use]
    pub fn steady<const D: usize>(problem: &Problem<D>, poses: &[Pose], time: f64) -> Self {
        let mut equations = Self::without_loads(problem.bodies.len());
        equations.add_loads(problem, time, PosesByVelocity::staying(poses));
        equations.add_flexible(problem, time);
        equations
    }

    /// Bodies that loads have not moved yet, at a time (s).
    #[must_use]
    pub fn unloaded<const D: usize>(problem: &Problem<D>, time: f64) -> Self {
        let mut equations = Self::without_loads(problem.bodies.len());
        equations.add_flexible(problem, time);
        for equation in &mut equations.flexible {
            equation.is_unloaded = true;
        }
        equations
    }

    /// The same equations, with inner forces of bodies with coordinates as they are after a time (s). At once they fix no
    /// rates that the fluid does not see, such as those of a rod whose elements are shorter than the cells beside it.
    #[must_use]
    pub fn relaxing_within(mut self, time: f64) -> Self {
        for equation in &mut self.flexible {
            equation.relaxation = time;
        }
        self
    }

    /// Adds bodies with coordinates as they start.
    fn add_flexible<const D: usize>(&mut self, problem: &Problem<D>, time: f64) {
        for (body, own) in problem.bodies.iter().zip(problem.coordinates()) {
            let Some(flexible) = body.flexible() else { continue };
            let initial = flexible.initial();
            let steady = FlexibleEquation::steady(own.start, flexible, initial.as_slice(), time);
            self.flexible.push(steady);
        }
    }

    /// Bodies without acceleration and loads.
    #[must_use]
    pub fn without_loads(n_bodies: usize) -> Self {
        Self { bodies: vec![RigidBodyEquation::default(); n_bodies], ..Self::default() }
    }

    /// Adds loads from outside, one on each body.
    pub fn add_external(&mut self, loads: &[Wrench]) {
        for (equation, wrench) in self.bodies.iter_mut().zip(loads) {
            equation.external += wrench.to_vector();
        }
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
            let at = JointAt { joint, child, time };
            self.add_pivot(at, reached);
            self.add_free_arm(at, reached);
        }
        for (body, (equation, rigid)) in self.bodies.iter_mut().zip(&problem.bodies).enumerate() {
            equation.external = rigid.external(time, &expected[body]);
            if coefficient != 0.0
                && let Some(stiffness) = rigid.turning_stiffness(time, &expected[body])
            {
                equation.add_turning(&stiffness, &reached.led_by_velocity(body), coefficient);
            }
            let Some(spring) = &rigid.spring else { continue };
            equation.resistance = spring.damping + spring.stiffness * coefficient;
            let way = reached.way_from(body, &spring.rest);
            equation.external -= spring.stiffness.component_mul(&way);
        }
    }

    /// Adds the torque of a free pivot: about its axis, or about all.
    fn add_pivot(&mut self, at: JointAt<'_>, reached: PosesByVelocity<'_>) {
        let joint = at.joint;
        let expected = &joint.parent_pose(reached.expected, at.child);
        let Turn::Free(pivot) = &joint.turn else { return };
        let at_rest = expected.composed(&joint.rest);
        let turned = reached.way_from(at.child, &at_rest) + reached.led_parent(joint);
        let axes = match &pivot.axis {
            Some(axis) => vec![expected.to_world(axis)],
            None => vec![Vector3::x(), Vector3::y(), Vector3::z()],
        };
        for axis in axes {
            let about = Wrench { force: Vector3::zeros(), torque: axis }.to_vector();
            let numbers = [turned.dot(&about), reached.coefficient];
            self.add_joint(at, [about, -about], &pivot.law, numbers);
        }
    }

    /// Adds the force along an arm of free length, at its end.
    fn add_free_arm(&mut self, at: JointAt<'_>, reached: PosesByVelocity<'_>) {
        let (joint, child) = (at.joint, at.child);
        let Some(FreeArm { arm, law }) = joint.free_arm() else { return };
        let parent = joint.parent_pose(reached.expected, child);
        let poses = [&parent, &reached.expected[child]];
        let levers = Levers::new(joint, poses, at.time);
        let along = poses[0].to_world(&arm.along);
        let pull =
            |lever: &Vector3<f64>| Wrench { force: along, torque: lever.cross(&along) }.to_vector();
        let (on_child, on_parent) = (pull(&levers.child), -pull(&levers.parent));
        let led = on_child.dot(&reached.led_by_velocity(child))
            + on_parent.dot(&reached.led_parent(joint));
        let numbers = [joint.length_along(arm, poses) - led, reached.coefficient];
        self.add_joint(at, [on_child, on_parent], law, numbers);
    }

    /// Adds a coordinate of a joint by its value without the motion of this step, with the loads on child
    /// and parent that a unit load along it is.
    fn add_joint(
        &mut self,
        at: JointAt<'_>,
        [on_child, on_parent]: [RigidVector; 2],
        law: &JointLaw,
        [coordinate, coefficient]: [f64; 2],
    ) {
        self.joints.push(JointLoad {
            child: at.child,
            parent: at.joint.parent,
            on_child,
            on_parent,
            resistance: law.damping + law.stiffness * coefficient,
            load: law.motor_load(at.time) - law.stiffness * (coordinate - law.rest),
        });
    }

    /// Adds what bodies and joints lack to balance the loads of the fluid at rigid velocities to the
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
                for other in modes.iter() {
                    if let Some(resistance) = equation.magnetic_resistance(mode, other) {
                        raw[row(body, position)] += resistance * velocity[other];
                    }
                }
            }
        }
        for joint in &self.joints {
            let load = joint.load - joint.resistance * joint.rate(twists);
            for (position, mode) in modes.iter().enumerate() {
                raw[row(joint.child, position)] -= load * joint.on_child[mode];
                if let Some(parent) = joint.parent {
                    raw[row(parent, position)] -= load * joint.on_parent[mode];
                }
            }
        }
    }
}
