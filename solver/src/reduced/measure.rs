//! Quantities of bodies and joints of a reduced model, under the names of a full run.

use alewife_reduced::tree::compiled::{Compiled, Looked};
use alewife_reduced::tree::{Drive, Number, Pose, State, Tree, Twist, Wrench, real};
use nalgebra::{Quaternion, Rotation3, UnitQuaternion, Vector3};

use super::build::Reduced;
use super::inputs::told::Told;
use crate::case::{BodyQuantity, Component, JointQuantity, Source, SwimmerQuantity};

/// A quantity.
#[derive(Debug, Clone, Copy)]
pub(super) enum Value<T: Number = f64> {
    Scalar(T),
    Vector(Vector3<T>),
    Quaternion(Quaternion<f64>),
}

impl<T: Number> Value<T> {
    pub fn component(self, component: Component) -> T {
        match (self, component) {
            (Self::Scalar(value), _) => value,
            (Self::Vector(v), Component::X) => v.x,
            (Self::Vector(v), Component::Y) => v.y,
            (Self::Vector(v), _) => v.z,
            (Self::Quaternion(q), Component::X) => real(q.i),
            (Self::Quaternion(q), Component::Y) => real(q.j),
            (Self::Quaternion(q), Component::Z) => real(q.k),
            (Self::Quaternion(q), _) => real(q.w),
        }
    }
}

/// Whether a quantity is a load or made of loads.
pub(super) fn is_load(source: Source) -> bool {
    match source {
        Source::Body(_, quantity) => {
            matches!(quantity, BodyQuantity::Force | BodyQuantity::Torque | BodyQuantity::Power)
        }
        Source::Joint(_, quantity) => {
            matches!(quantity, JointQuantity::Torque | JointQuantity::Force | JointQuantity::Power)
        }
        Source::Swimmer(_, quantity) => matches!(
            quantity,
            SwimmerQuantity::Force
                | SwimmerQuantity::Torque
                | SwimmerQuantity::Power
                | SwimmerQuantity::ShapePower
                | SwimmerQuantity::CyclePower
                | SwimmerQuantity::CycleCostOfTransport
        ),
        Source::Probe(..)
        | Source::Tracer(..)
        | Source::Scalar(..)
        | Source::ScalarSurface(..)
        | Source::ScalarProbe(..)
        | Source::Flow(_)
        | Source::Side(..) => true,
    }
}

/// A body at one time, about its centre, in axes of the world.
#[derive(Debug, Clone)]
pub(super) struct Moving<T: Number = f64> {
    pub pose: Pose<T>,
    pub twist: Twist<T>,
    /// Of the fluid.
    pub load: Wrench<T>,
    /// Angle over all turns (rad).
    pub angle: T,
    pub acceleration: Vector3<T>,
}

impl<T: Number> Moving<T> {
    /// Work of its surface on the fluid (W).
    pub fn power(&self) -> T {
        -self.twist.dot(&self.load)
    }
}

impl Moving {
    /// A quantity of a body; none of those that only a flow has.
    pub fn value(&self, quantity: BodyQuantity) -> Option<Value> {
        let rotation = Rotation3::from_matrix_unchecked(self.pose.rotation);
        Some(match quantity {
            BodyQuantity::Position => Value::Vector(self.pose.position),
            BodyQuantity::Angle => Value::Scalar(self.angle),
            BodyQuantity::Orientation => {
                Value::Quaternion(*UnitQuaternion::from_rotation_matrix(&rotation).quaternion())
            }
            BodyQuantity::Direction => Value::Vector(rotation * Vector3::x()),
            BodyQuantity::Velocity => Value::Vector(self.twist.linear),
            BodyQuantity::AngularVelocity => Value::Vector(self.twist.angular),
            BodyQuantity::BodyAngularVelocity => {
                Value::Vector(rotation.inverse() * self.twist.angular)
            }
            BodyQuantity::Acceleration => Value::Vector(self.acceleration),
            BodyQuantity::Force => Value::Vector(self.load.force),
            BodyQuantity::Torque => Value::Vector(self.load.torque),
            BodyQuantity::Power => Value::Scalar(self.power()),
            _ => return None,
        })
    }
}

/// What is remembered of a body.
#[derive(Debug, Clone, Copy)]
pub(super) struct Last<T: Number = f64> {
    /// Angle over all turns (rad).
    pub angle: T,
    pub velocity: Vector3<T>,
}

/// All bodies at a state, with their angles over all turns and their accelerations by the velocities `before`, a
/// step (s) ago.
pub(super) fn bodies(
    reduced: &Reduced,
    state: &State<f64>,
    before: &[Moving],
    step: f64,
) -> Vec<Moving> {
    bodies_in(reduced, &reduced.tree, state, before, step)
}

/// The same by the angle and the velocity that each body had last; loads only where they are asked for.
pub(super) fn bodies_after(
    reduced: &Reduced,
    state: &State<f64>,
    step: f64,
    last: &dyn Fn(usize) -> Option<Last>,
    has_loads: bool,
) -> Vec<Moving> {
    bodies_of(reduced, f64::look(&reduced.tree, state, has_loads), step, last)
}

/// All bodies where the links of a tree over any kind of number are, with their loads.
pub(super) fn bodies_in<T: Compiled>(
    reduced: &Reduced,
    tree: &Tree<T>,
    state: &State<T>,
    before: &[Moving<T>],
    step: T,
) -> Vec<Moving<T>> {
    let last = |number: usize| {
        before
            .get(number)
            .map(|body: &Moving<T>| Last { angle: body.angle, velocity: body.twist.linear })
    };
    bodies_of(reduced, T::look(tree, state, true), step, &last)
}

fn bodies_of<T: Number>(
    reduced: &Reduced,
    looked: Looked<T>,
    step: T,
    last: &dyn Fn(usize) -> Option<Last<T>>,
) -> Vec<Moving<T>> {
    let Looked { poses, twists, wrenches } = looked;
    let moving = |(number, part): (usize, &super::part::Part)| {
        let (link, twist) = (&poses[part.link], &twists[part.link]);
        let load = wrenches.get(part.link).copied().unwrap_or_else(Wrench::zero);
        let inside: Pose<T> = super::part::pose(&part.inside);
        let arm = link.rotation * inside.position;
        let pose = link.then(&inside);
        let linear = twist.linear + twist.angular.cross(&arm);
        let force = link.rotation * load.force;
        let torque = link.rotation * load.torque - arm.cross(&force);
        let heading = pose.rotation[(1, 0)].atan2(pose.rotation[(0, 0)]);
        let last = last(number);
        let turns =
            |last: Last<T>| ((last.angle.re() - heading.re()) / std::f64::consts::TAU).round();
        let standing = Vector3::repeat(real(0.0));
        Moving {
            angle: heading + std::f64::consts::TAU * last.map_or(0.0, turns),
            acceleration: last.map_or(standing, |last| (linear - last.velocity) / step),
            pose,
            twist: Twist { linear, angular: twist.angular },
            load: Wrench { force, torque },
        }
    };
    reduced.parts.iter().enumerate().map(moving).collect()
}

/// A quantity of the joint above a link.
pub(super) fn joint(
    reduced: &Reduced,
    state: &State<f64>,
    link: usize,
    quantity: JointQuantity,
) -> f64 {
    let Some(velocity) = reduced.tree.velocity_of(link) else { return f64::NAN };
    let (place, rate) = (state.coordinates[velocity], state.velocities[velocity]);
    let joint = &reduced.tree.links()[link].joint;
    let effort = || {
        let own = -joint.stiffness * (place - joint.rest) - joint.damping * rate;
        let told = &reduced.told[link];
        if let Drive::Servo { gain, limit } = joint.drive {
            let asked = gain * (told.command(state.time).rate - rate);
            return own + asked.clamp(-limit, limit);
        }
        match told {
            Told::Given(_) | Told::Way(_) | Told::Rate(..) => state.efforts[velocity],
            Told::Nothing => own,
            Told::Effort(stroke) => own + stroke.at(state.time)[0],
        }
    };
    match quantity {
        JointQuantity::Angle | JointQuantity::Length => place,
        JointQuantity::Rate => rate,
        JointQuantity::Torque | JointQuantity::Force => effort(),
        JointQuantity::Power => effort() * rate,
    }
}
