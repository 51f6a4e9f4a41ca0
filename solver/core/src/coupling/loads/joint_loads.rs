//! What joints do: their coordinates and the loads by which bodies hang on others.
//!
//! No unknown stands for them: Newton's and Euler's equations of all that hangs beyond a joint give the
//! force and the torque that come through it.

use nalgebra::Vector3;

use super::super::kinematics::Levers;
use super::super::problem::{Joint, Length, Pivot, Problem, Turn};
use super::super::shapes::BodyShapes;
use crate::body::{Pose, RigidVector, Twist, Wrench};

/// What is known of the bodies at one time.
#[derive(Debug, Clone, Copy)]
pub struct BodyStates<'a> {
    /// Their shapes, and the time.
    pub shapes: &'a BodyShapes,
    /// Poses.
    pub poses: &'a [Pose],
    /// Velocities (m/s, rad/s).
    pub twists: &'a [Twist],
    /// Accelerations (m/s2, rad/s2); of no account where bodies have no inertia.
    pub accelerations: &'a [Twist],
    /// Loads of the fluid and of contact (N, N m).
    pub loads: &'a [Wrench],
}

/// A joint at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointReport {
    /// The body that hangs by it.
    pub child: usize,
    /// Angle of the child less that of the parent (rad), or the length of an arm (m).
    pub coordinate: f64,
    /// Its rate (rad/s or m/s).
    pub rate: f64,
    /// Torque on the child (N m), or force on it along the arm (N); the opposite acts on the parent.
    pub load: f64,
    /// Rate of work on the bodies (W).
    pub power: f64,
}

/// All joints, in the order of the bodies that hang by them.
#[must_use]
pub fn joint_reports<const D: usize>(
    problem: &Problem<D>,
    now: &BodyStates<'_>,
) -> Vec<JointReport> {
    if !problem.has_joints() {
        return Vec::new();
    }
    // What comes through the joint of each body, about its own centre; of the outer ones first
    let mut carried: Vec<Wrench> =
        (0..problem.bodies.len()).map(|body| missing_load(problem, now, body)).collect();
    let mut reports = Vec::new();
    for child in problem.parents_first().into_iter().rev() {
        let Some(joint) = &problem.bodies[child].joint else { continue };
        let Wrench { force, torque } = carried[child];
        reports.push(report(joint, child, &carried[child], now));
        let Some(above) = joint.parent else { continue };
        let way = now.poses[child].center - now.poses[above].center;
        let parent = &mut carried[above];
        parent.force += force;
        parent.torque += torque + way.cross(&force);
    }
    reports.sort_by_key(|report| report.child);
    reports
}

/// A joint through which this load comes, about the centre of the child.
fn report(joint: &Joint, child: usize, load: &Wrench, now: &BodyStates<'_>) -> JointReport {
    let time = now.shapes.time();
    let parent = &joint.parent_pose(now.poses, child);
    let of_parent = joint.parent.map_or_else(Twist::default, |above| now.twists[above]);
    if let Some(arm) = &joint.arm {
        let along = parent.to_world(&arm.along);
        let poses = [parent, &now.poses[child]];
        let [length, rate] = match &arm.length {
            Length::Given(length) => length(time),
            Length::Free(_) => {
                let levers = Levers::new(joint, poses, time);
                let twists = [(of_parent, levers.parent), (now.twists[child], levers.child)];
                let [on_parent, on_child] = twists.map(|(twist, lever)| twist.velocity_at(&lever));
                [joint.length_along(arm, poses), (on_child - on_parent).dot(&along)]
            }
        };
        let load = load.force.dot(&along);
        return JointReport { child, coordinate: length, rate, load, power: load * rate };
    }
    let to_joint = now.poses[child].to_world(&joint.on_child);
    let torque = load.torque - to_joint.cross(&load.force);
    let relative = now.twists[child].angular - of_parent.angular;
    let turned = now.poses[child].displacement_from(&parent.composed(&joint.rest));
    let turned = Vector3::from(turned.fixed_rows::<3>(3));
    let about = |axis: Vector3<f64>, coordinate: f64, rate: f64| {
        let load = torque.dot(&axis);
        JointReport { child, coordinate, rate, load, power: load * rate }
    };
    match &joint.turn {
        // In space angles beyond half a turn are known to the joint alone
        Turn::Given { axis, angle } => {
            let [coordinate, rate] = angle(time);
            about(parent.to_world(axis), coordinate, rate)
        }
        Turn::Free(Pivot { axis: Some(axis), .. }) => {
            let axis = parent.to_world(axis);
            about(axis, turned.dot(&axis), relative.dot(&axis))
        }
        // The angle of the rotation, about what it has turned about
        Turn::Free(Pivot { axis: None, .. }) => {
            let axis = turned.try_normalize(0.0).unwrap_or_else(Vector3::x);
            let report = about(axis, turned.norm(), relative.dot(&axis));
            JointReport { power: torque.dot(&relative), ..report }
        }
    }
}

/// What a body needs to move as it does besides fluid, contact and all that acts on it from outside.
fn missing_load<const D: usize>(problem: &Problem<D>, now: &BodyStates<'_>, body: usize) -> Wrench {
    let rigid = &problem.bodies[body];
    let (pose, twist) = (&now.poses[body], now.twists[body].to_vector());
    let mut load = RigidVector::zeros();
    if problem.has_inertia {
        let inertia = rigid.inertia_with(now.shapes.deformed(body));
        load += inertia.matrix(pose) * now.accelerations[body].to_vector();
    }
    if let Some(spring) = &rigid.spring {
        let way = pose.displacement_from(&spring.rest);
        load += spring.stiffness.component_mul(&way) + spring.damping.component_mul(&twist);
    }
    load -= rigid.external(now.shapes.time(), pose);
    load -= now.loads[body].to_vector();
    Wrench::from_vector(&load)
}
