//! What joints do: their coordinates and the loads by which bodies hang on others.
//!
//! No unknown stands for them: Newton's and Euler's equations of all that hangs beyond a joint give the
//! force and the torque that come through it.

use nalgebra::{Rotation2, Vector2};

use super::link::Turn;
use super::problem::Problem;
use super::shapes::BodyShapes;

/// What is known of the bodies at one time; entries for x, y and the turn of each.
#[derive(Debug, Clone, Copy)]
pub struct BodyStates<'a> {
    /// Their shapes, and when this is.
    pub shapes: &'a BodyShapes,
    /// Centres of mass and angles (m, rad).
    pub places: &'a [[f64; 3]],
    /// Velocities (m/s, rad/s).
    pub velocities: &'a [[f64; 3]],
    /// Accelerations (m/s2, rad/s2); of no account where bodies have no inertia.
    pub accelerations: &'a [[f64; 3]],
    /// Loads of the fluid and of contact (N, N m).
    pub loads: &'a [[f64; 3]],
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
}

impl JointReport {
    /// Rate of work on the bodies (W).
    #[must_use]
    pub fn power(&self) -> f64 {
        self.load * self.rate
    }
}

/// All joints, in the order of the bodies that hang by them.
#[must_use]
pub fn joint_reports(problem: &Problem, now: &BodyStates<'_>) -> Vec<JointReport> {
    if !problem.has_links() {
        return Vec::new();
    }
    // What comes through the joint of each body, about its own centre; of the outer ones first
    let mut carried: Vec<[f64; 3]> =
        (0..problem.bodies.len()).map(|body| missing(problem, now, body)).collect();
    let mut reports = Vec::new();
    for child in problem.outwards().into_iter().rev() {
        let Some(link) = &problem.bodies[child].link else { continue };
        let parent = link.parent;
        let force = Vector2::new(carried[child][0], carried[child][1]);
        let center = |body: usize| Vector2::new(now.places[body][0], now.places[body][1]);
        let cross = |lever: Vector2<f64>| lever.x * force.y - lever.y * force.x;
        let to_joint = Rotation2::new(now.places[child][2]) * link.on_child;
        let report = match &link.arm {
            Some(arm) => {
                let [length, rate] = (arm.length)(now.shapes.time());
                let along = Rotation2::new(now.places[parent][2]) * arm.along;
                JointReport { child, coordinate: length, rate, load: force.dot(&along) }
            }
            None => {
                let torque = carried[child][2] - cross(to_joint);
                let coordinate = now.places[child][2] - now.places[parent][2];
                let rate = match &link.turn {
                    Turn::Given(angle) => angle(now.shapes.time())[1],
                    Turn::Free(_) => now.velocities[child][2] - now.velocities[parent][2],
                };
                JointReport { child, coordinate, rate, load: torque }
            }
        };
        let turned = carried[child][2] + cross(center(child) - center(parent));
        for (sum, share) in carried[parent].iter_mut().zip([force.x, force.y, turned]) {
            *sum += share;
        }
        reports.push(report);
    }
    reports.sort_by_key(|report| report.child);
    reports
}

/// What a body needs to move as it does besides fluid, contact and all that acts on it from outside.
fn missing(problem: &Problem, now: &BodyStates<'_>, body: usize) -> [f64; 3] {
    let rigid = &problem.bodies[body];
    let inertia = if problem.has_inertia {
        [rigid.mass, rigid.mass, rigid.inertia_with(now.shapes.deformed(body))]
    } else {
        [0.0; 3]
    };
    let (external, load) = (rigid.external(now.shapes.time()), now.loads[body]);
    [0, 1, 2].map(|mode| {
        let held = rigid.spring.as_ref().map_or(0.0, |spring| {
            spring.stiffness[mode] * (now.places[body][mode] - spring.rest[mode])
                + spring.damping[mode] * now.velocities[body][mode]
        });
        inertia[mode] * now.accelerations[body][mode] + held - external[mode] - load[mode]
    })
}
