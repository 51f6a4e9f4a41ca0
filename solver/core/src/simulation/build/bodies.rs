//! Bodies of a case as rigid bodies.

use std::f64::consts::PI;

use alewife_mesh::BoundaryId;
use nalgebra::Vector3;

use crate::body::{Inertia, Mode, Pose, RigidVector, Wrench};
use crate::case::{
    Body, Case, FlowModel, GaitSpec, Lock, Motion, ShapeSpec, SpringSpec, TimeFunction,
};
use crate::coupling::{Drive, RigidBody, Spring, TimeValue, second_moments};
use crate::gait::{Gait, InTime, Squirmer};
use crate::simulation::RunError;
use crate::simulation::planar::shape_motion;
use crate::space::Metric;
use crate::time::factor_at;

/// The planar components of a vector of the case; those that are not written are zero.
fn component(values: &[f64], axis: usize) -> f64 {
    values.get(axis).copied().unwrap_or(0.0)
}

/// A body of a case with its boundary in the mesh.
pub(super) fn rigid_body(
    case: &Case,
    body: &Body,
    boundary: BoundaryId,
    metric: Metric,
) -> Result<RigidBody, RunError> {
    let moments = body.shape.outline().moments().ok_or_else(|| {
        RunError::Unsupported(format!("body `{}`: its spline has no valid outline", body.name))
    })?;
    let volume = Inertia { mass: moments.measure, tensor: second_moments(&moments) };
    let density = body.density.unwrap_or(case.fluid.density);
    let inertia = match case.fluid.model {
        FlowModel::Stokes => Inertia::default(),
        FlowModel::UnsteadyStokes | FlowModel::NavierStokes => volume.scaled(density),
    };
    // Weight less buoyancy: the pressure is the one without its hydrostatic part
    let net_mass = (density - case.fluid.density) * moments.measure;
    let vector = |x: f64, y: f64| Vector3::new(x, y, 0.0);
    let weight = [0, 1].map(|axis| net_mass * component(&case.fluid.gravity, axis));
    // The centre of mass of a spline is not the origin of its points
    let offset = nalgebra::Rotation2::new(body.angle) * moments.centroid;
    let pose = Pose::planar(body.center[0] + offset[0], body.center[1] + offset[1], body.angle);
    // Angles count turns from within (-pi, pi]
    let pose = Pose::planar(pose.center.x, pose.center.y, pose.heading());
    Ok(RigidBody {
        drives: drives(body, metric),
        inertia,
        volume,
        weight: Wrench { force: vector(weight[0], weight[1]), torque: Vector3::zeros() },
        load: Wrench {
            force: vector(component(&body.force, 0), component(&body.force, 1)),
            torque: Vector3::new(0.0, 0.0, body.torque),
        },
        load_factor: body
            .load_factor
            .clone()
            .map(|factor| -> TimeValue { Box::new(move |time| factor_at(Some(&factor), time)) }),
        spring: body.spring.as_ref().map(|spring| rigid_spring(spring, &pose)),
        gait: slip(body, metric),
        shape: shape_motion(body)?,
        ..RigidBody::held(body.name.clone(), boundary, pose)
    })
}

/// What determines the velocities of a body.
fn drives(body: &Body, metric: Metric) -> [Drive; 6] {
    let is_locked = |mode: Mode| match mode {
        Mode::X => body.locked.contains(&Lock::X),
        Mode::Y => body.locked.contains(&Lock::Y) || !metric.has_translation(1),
        Mode::AboutZ => body.locked.contains(&Lock::Rotation) || !metric.has_rotation(),
        Mode::Z | Mode::AboutX | Mode::AboutY => true,
    };
    Mode::ALL.map(|mode| match &body.motion {
        Motion::Free if !is_locked(mode) => Drive::Free,
        Motion::Held | Motion::Free => Drive::Held,
        Motion::Imposed(imposed) => {
            let value = match mode {
                Mode::AboutZ => imposed.angular_velocity,
                Mode::AboutX | Mode::AboutY => 0.0,
                Mode::X | Mode::Y | Mode::Z => component(&imposed.velocity, mode.axis()),
            };
            let factor = imposed.factor.clone();
            Drive::Given(Box::new(move |time| value * factor_at(factor.as_ref(), time)))
        }
    })
}

fn rigid_spring(spring: &SpringSpec, pose: &Pose) -> Spring {
    let vector = |linear: &[f64], angular: f64| {
        let mut vector = RigidVector::zeros();
        (vector[Mode::X], vector[Mode::Y]) = (component(linear, 0), component(linear, 1));
        vector[Mode::AboutZ] = angular;
        vector
    };
    let anchor = |axis: usize| spring.anchor.get(axis).copied().unwrap_or(pose.center[axis]);
    Spring {
        stiffness: vector(&spring.stiffness, spring.torsion),
        damping: vector(&spring.damping, spring.torsion_damping),
        rest: Pose::planar(anchor(0), anchor(1), spring.rest_angle.unwrap_or_else(|| pose.angle())),
    }
}

/// Slip of the surface; gaits that deform the body are in `shape_motion`.
fn slip(body: &Body, metric: Metric) -> Option<Box<dyn Gait>> {
    let squirmer = match &body.gait {
        Some(GaitSpec::Squirmer(squirmer)) => squirmer,
        None
        | Some(
            GaitSpec::Carangiform(_)
            | GaitSpec::Anguilliform(_)
            | GaitSpec::Flagellum(_)
            | GaitSpec::Pulsating(_)
            | GaitSpec::Joints(_),
        ) => return None,
    };
    // On the axis the heading is 0 or pi, and must be so to the last bit
    let axis = if metric.is_revolved() {
        Vector3::x() * if (squirmer.heading.abs() - PI).abs() < 1e-3 { -1.0 } else { 1.0 }
    } else {
        Vector3::new(squirmer.heading.cos(), squirmer.heading.sin(), 0.0)
    };
    let in_time =
        |function: TimeFunction| InTime(Box::new(move |time| factor_at(Some(&function), time)));
    let factors = squirmer.factors_of_modes().into_iter();
    Some(Box::new(Squirmer {
        modes: squirmer.modes.clone(),
        factors: factors.map(|factor| factor.map(in_time)).collect(),
        axis,
        turn: squirmer.turn.clone().map(in_time),
        is_sphere: matches!(body.shape, ShapeSpec::Sphere { .. }),
    }))
}
