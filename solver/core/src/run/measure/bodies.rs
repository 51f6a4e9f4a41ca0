//! The quantities of bodies and of the joints they hang by.

use nalgebra::Vector3;

use crate::body::{Twist, Wrench, on_mesh};
use crate::case::{BodyQuantity, Case, Geometry, JointQuantity};
use crate::coupling::{
    BodyLoads, BodyShapes, BodyStates, JointReport, Problem, RigidBody, joint_reports,
};
use crate::run::RunError;
use crate::run::simulation::Simulation;
use crate::run::snapshot::BodyReport;
use crate::state::State;

/// Factors that make coefficients of loads; not numbers without `[scales]`.
pub(super) struct Coefficients {
    /// Coefficient per force (1/N).
    force: f64,
    /// Coefficient per torque (1/(N m)).
    moment: f64,
}

impl Coefficients {
    /// c = 2 F / (rho U^2 A) and the same with a length for torques.
    pub(super) fn of(case: &Case) -> Self {
        let Some(scales) = case.scales.filter(|_| case.has_coefficients()) else {
            return Self { force: f64::NAN, moment: f64::NAN };
        };
        let area = scales.area.unwrap_or(match case.geometry {
            Geometry::Planar => scales.length,
            Geometry::Axisymmetric | Geometry::Spatial => {
                std::f64::consts::PI * scales.length.powi(2) / 4.0
            }
        });
        let force = 2.0 / (case.fluid.density * scales.velocity.powi(2) * area);
        Self { force, moment: force / scales.length }
    }
}

/// A body as it moves, with its loads.
pub(super) struct BodyMotion<'a> {
    pub report: &'a BodyReport,
    /// Angle over all turns (rad).
    pub angle: f64,
    pub acceleration: &'a Twist,
    pub coefficients: &'a Coefficients,
}

impl BodyMotion<'_> {
    pub(super) fn value(&self, quantity: BodyQuantity) -> f64 {
        let BodyReport { pose, twist, load, surface_load, contact, power, .. } = self.report;
        match quantity {
            BodyQuantity::X => pose.center.x,
            BodyQuantity::Y => pose.center.y,
            BodyQuantity::Z => pose.center.z,
            BodyQuantity::Angle => self.angle,
            BodyQuantity::OrientationW => pose.rotation().w,
            BodyQuantity::OrientationX => pose.rotation().i,
            BodyQuantity::OrientationY => pose.rotation().j,
            BodyQuantity::OrientationZ => pose.rotation().k,
            BodyQuantity::DirectionX => pose.to_world(&Vector3::x()).x,
            BodyQuantity::DirectionY => pose.to_world(&Vector3::x()).y,
            BodyQuantity::DirectionZ => pose.to_world(&Vector3::x()).z,
            BodyQuantity::VelocityX => twist.linear.x,
            BodyQuantity::VelocityY => twist.linear.y,
            BodyQuantity::VelocityZ => twist.linear.z,
            BodyQuantity::AngularVelocityX => twist.angular.x,
            BodyQuantity::AngularVelocityY => twist.angular.y,
            BodyQuantity::AngularVelocity | BodyQuantity::AngularVelocityZ => twist.angular.z,
            BodyQuantity::BodyAngularVelocityX => pose.to_body(&twist.angular).x,
            BodyQuantity::BodyAngularVelocityY => pose.to_body(&twist.angular).y,
            BodyQuantity::BodyAngularVelocityZ => pose.to_body(&twist.angular).z,
            BodyQuantity::AccelerationX => self.acceleration.linear.x,
            BodyQuantity::AccelerationY => self.acceleration.linear.y,
            BodyQuantity::AccelerationZ => self.acceleration.linear.z,
            BodyQuantity::ForceX => load.force.x,
            BodyQuantity::ForceY => load.force.y,
            BodyQuantity::ForceZ => load.force.z,
            BodyQuantity::TorqueX => load.torque.x,
            BodyQuantity::TorqueY => load.torque.y,
            BodyQuantity::Torque | BodyQuantity::TorqueZ => load.torque.z,
            BodyQuantity::SurfaceForceX => surface_load.force.x,
            BodyQuantity::SurfaceForceY => surface_load.force.y,
            BodyQuantity::SurfaceForceZ => surface_load.force.z,
            BodyQuantity::SurfaceTorqueX => surface_load.torque.x,
            BodyQuantity::SurfaceTorqueY => surface_load.torque.y,
            BodyQuantity::SurfaceTorque | BodyQuantity::SurfaceTorqueZ => surface_load.torque.z,
            BodyQuantity::Power => *power,
            BodyQuantity::DragCoefficient => load.force.x * self.coefficients.force,
            BodyQuantity::LiftCoefficient => load.force.y * self.coefficients.force,
            BodyQuantity::SideCoefficient => load.force.z * self.coefficients.force,
            BodyQuantity::MomentCoefficient => load.torque.z * self.coefficients.moment,
            BodyQuantity::ContactForceX => contact.force.x,
            BodyQuantity::ContactForceY => contact.force.y,
            BodyQuantity::ContactForceZ => contact.force.z,
            BodyQuantity::ContactTorqueX => contact.torque.x,
            BodyQuantity::ContactTorqueY => contact.torque.y,
            BodyQuantity::ContactTorque | BodyQuantity::ContactTorqueZ => contact.torque.z,
        }
    }
}

pub(super) fn joint_value(joint: &JointReport, quantity: JointQuantity) -> f64 {
    match quantity {
        JointQuantity::Angle | JointQuantity::Length => joint.coordinate,
        JointQuantity::Rate => joint.rate,
        JointQuantity::Torque | JointQuantity::Force => joint.load,
        JointQuantity::Power => joint.power,
    }
}

/// Reports of all bodies.
///
/// # Errors
/// When a gait fails.
pub(super) fn body_reports<const D: usize>(
    simulation: &Simulation<D>,
    loads: &[BodyLoads],
) -> Result<Vec<BodyReport>, RunError> {
    let Simulation { problem, state, work, .. } = simulation;
    let stress = work.system.surface_stress(problem, &state.mesh, &state.now);
    let in_mesh = state.in_mesh(&state.poses);
    let report = |(body, rigid): (usize, &RigidBody)| {
        Ok(BodyReport {
            name: rigid.name.clone(),
            pose: state.poses[body],
            twist: state.now.twists[body],
            load: loads[body].load,
            surface_load: stress.load(
                rigid.boundary,
                problem.metric,
                &on_mesh(&in_mesh[body].center),
            ) + work.system.mean_load(body, &state.now),
            contact: state.contact.wrenches[body],
            power: loads[body].power,
            recoil: rigid.deformed_at(state.time)?.map(|deformed| deformed.recoil),
        })
    };
    problem.bodies.iter().enumerate().map(report).collect()
}

/// The joints of all bodies, in the order of their children.
///
/// # Errors
/// When a gait fails.
pub(super) fn measure_joints<const D: usize>(
    problem: &Problem<D>,
    state: &State<D>,
    loads: &[BodyLoads],
) -> Result<Vec<JointReport>, RunError> {
    if !problem.has_joints() {
        return Ok(Vec::new());
    }
    let contact = &state.contact.wrenches;
    let loads: Vec<Wrench> =
        loads.iter().zip(contact).map(|(fluid, contact)| fluid.load + *contact).collect();
    let now = BodyStates {
        shapes: &BodyShapes::at(&problem.bodies, state.time)?,
        poses: &state.poses,
        twists: &state.now.twists,
        accelerations: &state.accelerations,
        loads: &loads,
    };
    Ok(joint_reports(problem, &now))
}
