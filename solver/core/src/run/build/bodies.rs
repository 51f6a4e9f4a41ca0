//! Bodies of a case as rigid bodies.

use alewife_mesh::spatial::{Body as SolidBody, BodySurface};
use alewife_mesh::{BoundaryId, Mesh, Outline, PlacedShape, Point};
use nalgebra::{Isometry3, Vector3};

use super::rod::rod_shape;
use super::solid::{Solid, no_solid};
use crate::body::{Inertia, Mode, Orientation, Pose, RigidVector, Twist, Wrench};
use crate::case::{
    Body, Case, FlowModel, GaitSpec, Geometry, Lock, Motion, ShapeSpec, SlipGait, SpringSpec,
    SquirmerGait, TimeFunction,
};
use crate::coupling::{Drive, Lever, RigidBody, Spring, TimeValue};
use crate::gait::{Gait, GaitAbout, InTime, Slip, SlipSurface, Squirmer};
use crate::run::RunError;
use crate::run::shape_motion;
use crate::space::Metric;
use crate::time::factor_at;

/// A component of a vector of the case; those that are not written are zero.
fn component(values: &[f64], axis: usize) -> f64 {
    values.get(axis).copied().unwrap_or(0.0)
}

/// A vector of the case in space.
fn vector(values: &[f64]) -> Vector3<f64> {
    Vector3::from_fn(|axis, _| component(values, axis))
}

/// A body of a case with its boundary in the mesh.
pub(super) fn rigid_body<const D: usize>(
    case: &Case,
    body: &Body,
    mesh: &Mesh<D>,
    boundary: BoundaryId,
    metric: Metric,
) -> Result<RigidBody, RunError> {
    let Solid { volume, pose } = Solid::of(body, case.geometry, mesh, boundary)?;
    let density = body.density.unwrap_or(case.fluid.density);
    let inertia = match case.fluid.model {
        FlowModel::Stokes => Inertia::default(),
        FlowModel::UnsteadyStokes | FlowModel::NavierStokes => inertia(body, &volume, density),
    };
    // Weight less buoyancy: the pressure is the one without its hydrostatic part
    let net_mass = match body.mass {
        Some(mass) => mass - case.fluid.density * volume.mass,
        None => (density - case.fluid.density) * volume.mass,
    };
    let weight = vector(&case.fluid.gravity) * net_mass;
    let centroid = pose.center;
    let pose = about_center_of_mass(body, pose);
    let to_centroid = pose.to_body(&(centroid - pose.center));
    let buoyancy = vector(&case.fluid.gravity) * (-case.fluid.density * volume.mass);
    let rigid = RigidBody {
        drives: drives(body, metric, case.geometry),
        initial: Twist {
            linear: vector(&body.velocity),
            angular: Vector3::from(body.angular_velocity.0),
        },
        inertia,
        volume,
        weight: Wrench { force: weight, torque: Vector3::zeros() },
        buoyancy: (!body.center_of_mass.is_empty()).then(|| Lever::new(to_centroid, buoyancy)),
        load: Wrench { force: vector(&body.force), torque: Vector3::from(body.torque.0) },
        load_factor: body
            .load_factor
            .clone()
            .map(|factor| -> TimeValue { Box::new(move |time| factor_at(Some(&factor), time)) }),
        load_in_body: !body.load_frame.is_laboratory(),
        spring: body.spring.as_ref().map(|spring| rigid_spring(spring, &pose)),
        gait: slip(case, body, metric, &pose)?,
        shape: shape_motion(body, case.geometry)?,
        ..RigidBody::held(body.name.clone(), boundary, pose)
    };
    Ok(match rod_shape(case, body)? {
        Some(shape) => rigid.with_coordinates(shape),
        None => rigid,
    })
}

/// Mass and inertia of a body whose shape has this volume, with the density of what is not given (kg/m3).
fn inertia(body: &Body, volume: &Inertia, density: f64) -> Inertia {
    let even = volume.scaled(body.mass.map_or(density, |mass| mass / volume.mass));
    Inertia {
        mass: body.mass.unwrap_or(even.mass),
        tensor: body.inertia.map_or(even.tensor, |own| own.tensor()),
    }
}

/// A pose about the centre of mass that a body has apart from that of its shape, if it has.
fn about_center_of_mass(body: &Body, pose: Pose) -> Pose {
    if body.center_of_mass.is_empty() {
        return pose;
    }
    let center = vector(&body.center) + pose.to_world(&vector(&body.center_of_mass));
    Pose { center, ..pose }
}

/// What determines the velocities of a body.
fn drives(body: &Body, metric: Metric, geometry: Geometry) -> [Drive; 6] {
    let in_plane = geometry != Geometry::Spatial;
    let is_locked = |mode: Mode| match mode {
        Mode::X => body.locked.contains(&Lock::X),
        Mode::Y => body.locked.contains(&Lock::Y) || !metric.has_translation(1),
        Mode::Z => in_plane || body.locked.contains(&Lock::Z),
        Mode::AboutZ => body.locked.contains(&Lock::Rotation) || !metric.has_rotation(),
        Mode::AboutX | Mode::AboutY => in_plane || body.locked.contains(&Lock::Rotation),
    };
    Mode::ALL.map(|mode| match &body.motion {
        Motion::Free if !is_locked(mode) => Drive::Free,
        Motion::Free => driven(body, mode, in_plane).unwrap_or(Drive::Held),
        Motion::Held | Motion::ByAxis(_) => Drive::Held,
        Motion::Imposed(imposed) => {
            let value = match mode {
                Mode::AboutX | Mode::AboutY | Mode::AboutZ => {
                    imposed.angular_velocity.0[mode.axis()]
                }
                Mode::X | Mode::Y | Mode::Z => component(&imposed.velocity, mode.axis()),
            };
            let factor = if mode.is_rotation() {
                imposed.factor_of_turn().cloned()
            } else {
                imposed.factor.clone()
            };
            Drive::Given(Box::new(move |time| value * factor_at(factor.as_ref(), time)))
        }
    })
}

/// A motion whose rate is given while others may be free.
fn driven(body: &Body, mode: Mode, in_plane: bool) -> Option<Drive> {
    let motion =
        if mode.is_rotation() { Lock::Rotation } else { [Lock::X, Lock::Y, Lock::Z][mode.axis()] };
    let driven = body.driven.iter().find(|driven| driven.motion == motion)?;
    let along = match (mode.is_rotation(), in_plane) {
        (false, _) => 1.0,
        (true, true) => f64::from(u8::from(mode == Mode::AboutZ)),
        (true, false) => Vector3::from(driven.axis).normalize()[mode.axis()],
    };
    let law = driven.law.clone();
    Some(Drive::Given(Box::new(move |time| along * law.rate(time))))
}

fn rigid_spring(spring: &SpringSpec, pose: &Pose) -> Spring {
    let in_space = matches!(pose.orientation, Orientation::Spatial(_));
    let rigid = |linear: &[f64], angular: f64| {
        let about: &[Mode] =
            if in_space { &[Mode::AboutX, Mode::AboutY, Mode::AboutZ] } else { &[Mode::AboutZ] };
        let mut rigid = RigidVector::zeros();
        for axis in 0..3 {
            rigid[Mode::along(axis)] = component(linear, axis);
        }
        for mode in about {
            rigid[*mode] = angular;
        }
        rigid
    };
    let anchor = |axis: usize| spring.anchor.get(axis).copied().unwrap_or(pose.center[axis]);
    let rest = match pose.orientation {
        Orientation::Planar(angle) => {
            Pose::planar(anchor(0), anchor(1), spring.rest_angle.unwrap_or(angle))
        }
        Orientation::Spatial(rotation) => {
            let rest = spring.rest_orientation.map_or(rotation, |rest| rest.rotation());
            Pose::spatial(Vector3::from_fn(|axis, _| anchor(axis)), rest)
        }
    };
    Spring {
        stiffness: rigid(&spring.stiffness, spring.torsion),
        damping: rigid(&spring.damping, spring.torsion_damping),
        rest,
    }
}

/// Slip of the surface of a body with a pose; gaits that deform the body are in `shape_motion`.
fn slip(
    case: &Case,
    body: &Body,
    metric: Metric,
    pose: &Pose,
) -> Result<Option<Box<dyn Gait>>, RunError> {
    // From the centre of mass to the origin of the shape
    let center = pose.to_body(&(vector(&body.center) - pose.center));
    Ok(match &body.gait {
        Some(GaitSpec::Squirmer(gait)) => {
            let gait = squirmer(body, gait, metric);
            if body.center_of_mass.is_empty() {
                return Ok(Some(Box::new(gait)));
            }
            Some(Box::new(GaitAbout { gait, center }))
        }
        Some(GaitSpec::Slip(gait)) => {
            let gait = slip_by_expressions(case, body, gait)?;
            Some(Box::new(GaitAbout { gait, center }))
        }
        None
        | Some(
            GaitSpec::Carangiform(_)
            | GaitSpec::Anguilliform(_)
            | GaitSpec::Flagellum(_)
            | GaitSpec::Midline(_)
            | GaitSpec::Pulsating(_)
            | GaitSpec::Joints(_),
        ) => None,
    })
}

fn squirmer(body: &Body, squirmer: &SquirmerGait, metric: Metric) -> Squirmer {
    let axis = squirmer.axis_in_body(metric.is_revolved());
    let in_time =
        |function: TimeFunction| InTime(Box::new(move |time| factor_at(Some(&function), time)));
    let factors = squirmer.factors_of_modes().into_iter();
    Squirmer {
        modes: squirmer.modes.clone(),
        factors: factors.map(|factor| factor.map(in_time)).collect(),
        axis,
        turn: squirmer.turn.clone().map(in_time),
        is_sphere: matches!(body.shape, ShapeSpec::Sphere { .. }),
    }
}

/// Slip by expressions along the shape of a body, in the frame of the shape.
fn slip_by_expressions(case: &Case, body: &Body, gait: &SlipGait) -> Result<Slip, RunError> {
    let refused = |error: String| RunError::Unsupported(format!("body `{}`: {error}", body.name));
    let velocity =
        gait.parsed(case.geometry.dimensions()).map_err(|error| refused(error.to_string()))?;
    let surface = if case.geometry == Geometry::Spatial {
        let solid = body.solid(1.0).ok_or_else(|| no_solid(body))?;
        let own = BodySurface::new(&SolidBody { pose: Isometry3::identity(), ..solid });
        SlipSurface::Surface(own.map_err(|error| refused(error.to_string()))?)
    } else {
        let (center, angle) = (Point::<2>::zeros(), 0.0);
        let own = Outline::new(&PlacedShape { center, angle, ..body.placed(1.0) });
        SlipSurface::Curve(own.map_err(|error| refused(error.to_string()))?)
    };
    Ok(Slip { velocity, surface })
}
