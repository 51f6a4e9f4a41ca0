//! Quantities of bodies in a steady flow, as functions of their loads and velocities.

use super::bodies::Coefficients;
use super::value::Value;
use crate::body::{Pose, Twist};
use crate::case::{BodyQuantity, Case, Column, Source, SwimmerQuantity};
use crate::coupling::{BodyLoads, Group, Problem, group_load, mean_motion};

/// Bodies in a steady flow.
#[derive(Clone, Copy)]
pub struct BodiesInFlow<'a, const D: usize> {
    /// What is solved.
    pub problem: &'a Problem<D>,
    /// Poses in the laboratory.
    pub poses: &'a [Pose],
    /// Rigid velocities.
    pub twists: &'a [Twist],
    /// Loads of the fluid.
    pub loads: &'a [BodyLoads],
}

/// The value of a quantity that follows from loads and velocities of bodies; `None` of any other.
#[must_use]
pub fn steady_value<const D: usize>(
    case: &Case,
    column: &Column,
    bodies: &BodiesInFlow<'_, D>,
) -> Option<f64> {
    let value = match column.source {
        Source::Body(body, quantity) => {
            of_body(case, quantity, &bodies.twists[body], &bodies.loads[body])?
        }
        Source::Swimmer(swimmer, quantity) => {
            of_swimmer(quantity, bodies, &bodies.problem.groups[swimmer])?
        }
        Source::Joint(..)
        | Source::Probe(..)
        | Source::Tracer(..)
        | Source::Scalar(..)
        | Source::ScalarSurface(..)
        | Source::ScalarProbe(..)
        | Source::Flow(_)
        | Source::Side(..) => return None,
    };
    Some(value.component(column.component))
}

fn of_body(case: &Case, quantity: BodyQuantity, twist: &Twist, loads: &BodyLoads) -> Option<Value> {
    let coefficients = Coefficients::of(case);
    let BodyLoads { load, power } = loads;
    Some(match quantity {
        BodyQuantity::Velocity => twist.linear.into(),
        BodyQuantity::AngularVelocity => twist.angular.into(),
        BodyQuantity::Force => load.force.into(),
        BodyQuantity::Torque => load.torque.into(),
        BodyQuantity::Power => (*power).into(),
        BodyQuantity::DragCoefficient => (load.force.x * coefficients.force).into(),
        BodyQuantity::LiftCoefficient => (load.force.y * coefficients.force).into(),
        BodyQuantity::SideCoefficient => (load.force.z * coefficients.force).into(),
        BodyQuantity::MomentCoefficient => (load.torque.z * coefficients.moment).into(),
        _ => return None,
    })
}

fn of_swimmer<const D: usize>(
    quantity: SwimmerQuantity,
    bodies: &BodiesInFlow<'_, D>,
    group: &Group,
) -> Option<Value> {
    let BodiesInFlow { problem, poses, twists, loads } = bodies;
    let motion = mean_motion(problem, group, poses, twists);
    let load = group_load(group, &motion.center, poses, loads);
    let power: f64 = group.bodies.iter().map(|body| loads[*body].power).sum();
    let twist = &motion.twist;
    Some(match quantity {
        SwimmerQuantity::Velocity => twist.linear.into(),
        SwimmerQuantity::AngularVelocity => twist.angular.into(),
        SwimmerQuantity::Force => load.force.into(),
        SwimmerQuantity::Torque => load.torque.into(),
        SwimmerQuantity::Power => power.into(),
        SwimmerQuantity::ShapePower => {
            (power + load.force.dot(&twist.linear) + load.torque.dot(&twist.angular)).into()
        }
        SwimmerQuantity::LighthillEfficiency => {
            (group.resistance? * twist.linear.norm_squared() / power).into()
        }
        _ => return None,
    })
}
