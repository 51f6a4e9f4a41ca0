//! From a `Case` to a `Problem`.

mod bodies;
mod formulas;
mod joints;
mod magnets;
mod motion_settings;
mod rod;
mod scalars;
mod shape_motion;
mod sides;
mod sizing;
mod solid;
mod tracers;

use alewife_mesh::{BoundaryId, BoundaryKind, Mesh, Point};

use self::bodies::rigid_body;
use self::formulas::vector;
use self::joints::add_joint;
use self::magnets::add_magnets;
pub use self::motion_settings::motion_settings;
use self::rod::attach;
pub(super) use self::rod::rod_shape;
pub use self::scalars::Scalars;
pub use self::shape_motion::{BodyRecoil, recoils, shape_motion};
use self::sides::{check_net_inflow, side};
pub(super) use self::sizing::limits;
pub use self::sizing::sizing;
pub(super) use self::solid::{no_solid, sides_of_bodies};
pub use self::tracers::Tracers;
use super::RunError;
use crate::body::{Orientation, Pose};
use crate::case::{
    Case, ContactSpec, DrivenLaw, FlowModel, Geometry, MeanFlowSpec, Model, ShearLaw, Stroke,
    SwimmerModel, TimeSettings, ViscositySpec, reports_sides,
};
use crate::contact::{ContactError, Dissipation, Law, LawKind};
use crate::coupling::{
    BodyShapes, Group, MeanFlow, MeanFlowAlong, Problem, RateDiscontinuities, Side,
};
use crate::flow::{Plateaus, Viscosity, YieldLaw};
use crate::space::Metric;
use crate::time::factor_at;

/// Speed of slip over the expected one.
const SLIP: f64 = 1e-3;

/// The law of contact a case asks for.
///
/// # Errors
/// When one of its numbers is not what it can be.
pub(super) fn contact_law(model: &Model) -> Result<Option<Law>, RunError> {
    let Some(contact) = &model.case.contact else { return Ok(None) };
    let kind = match *contact {
        ContactSpec::Quadratic { epsilon, .. } => LawKind::Quadratic { epsilon },
        ContactSpec::Barrier { stiffness, .. } => LawKind::Barrier { stiffness },
    };
    let refused = |error: ContactError| RunError::Unsupported(error.to_string());
    let law = Law::new(kind, contact.range()).map_err(refused)?;
    let losses = contact.losses();
    if !losses.are_any() {
        return Ok(Some(law));
    }
    let dissipation = Dissipation {
        restitution: losses.restitution.unwrap_or(1.0),
        friction: losses.friction.unwrap_or(0.0),
        slip: losses.slip.or(model.expected_speed().map(|speed| SLIP * speed)).unwrap_or(0.0),
    };
    Ok(Some(law.with_dissipation(dissipation).map_err(refused)?))
}

/// The problem of a case on its mesh.
///
/// # Errors
/// When the case asks for something that is not there yet.
pub fn build_problem<const D: usize>(
    model: &Model,
    mesh: &Mesh<D>,
) -> Result<Problem<D>, RunError> {
    let case = &model.case;
    let metric = match case.geometry {
        Geometry::Planar | Geometry::Spatial => Metric::Cartesian,
        Geometry::Axisymmetric => Metric::Revolved,
    };
    let mut sides = Vec::new();
    let mut bodies = Vec::new();
    for (boundary, known) in mesh.boundaries.iter().enumerate() {
        sides.push(match known.kind {
            BoundaryKind::Body(body) => {
                let boundary = BoundaryId::new(boundary);
                bodies.push(rigid_body(case, &model.bodies[body], mesh, boundary, metric)?);
                None
            }
            BoundaryKind::Axis => Some(Side::Symmetry { normal_axis: Metric::RADIAL }),
            BoundaryKind::Side => Some(side(case, mesh, &known.name)?),
        });
    }
    for body in 0..bodies.len() {
        attach(model, body, &mut bodies)?;
    }
    let frame = model.frame_body();
    if let (None, Some(name)) = (frame, &case.frame) {
        return Err(RunError::Unsupported(format!("frame = \"{name}\" names no body")));
    }
    for joint in &model.joints {
        add_joint(model, joint, &mut bodies)?;
    }
    add_magnets(model, &mut bodies);
    let has_inertia = case.fluid.model != FlowModel::Stokes;
    let mut problem = Problem {
        metric,
        density: if has_inertia { case.fluid.density } else { 0.0 },
        viscosity: viscosity(&case.fluid.viscosity),
        has_inertia,
        has_convection: case.fluid.model == FlowModel::NavierStokes,
        sides,
        reports_sides: reports_sides(model),
        bodies,
        groups: model.swimmers.iter().map(|swimmer| group(case, swimmer)).collect(),
        frame,
        mean_flow: mean_flow(case),
        force: (!case.fluid.force.is_empty())
            .then(|| vector(case, &case.fluid.force))
            .transpose()?,
        initial: case.initial.as_ref().map(|flow| vector(case, &flow.velocity)).transpose()?,
        rate_discontinuities: None,
    };
    problem.rate_discontinuities = rate_discontinuities(model, &problem);
    check_volumes(case, &problem)?;
    check_net_inflow(case, &problem, mesh)?;
    place_on_joints(&mut problem);
    Ok(problem)
}

/// Puts bodies where their joints have them at time zero.
fn place_on_joints<const D: usize>(problem: &mut Problem<D>) {
    let mut poses: Vec<Pose> = problem.bodies.iter().map(|body| body.pose).collect();
    problem.apply_joints(&mut poses, 0.0);
    for (body, pose) in problem.bodies.iter_mut().zip(poses) {
        if body.joint.is_some() {
            body.pose = match pose.orientation {
                // Within half a turn of x
                Orientation::Planar(_) => {
                    Pose::planar(pose.center.x, pose.center.y, pose.heading())
                }
                Orientation::Spatial(_) => pose,
            };
        }
    }
}

/// The viscosity of the fluid.
fn viscosity(spec: &ViscositySpec) -> Viscosity {
    let plateaus = |law: &crate::case::Plateaus| Plateaus {
        zero: law.zero,
        infinite: law.infinite,
        time: law.time,
        index: law.index,
    };
    match spec {
        ViscositySpec::Newtonian(value) => Viscosity::Newtonian(*value),
        ViscositySpec::Law(ShearLaw::Carreau(law)) => Viscosity::Carreau(plateaus(law)),
        ViscositySpec::Law(ShearLaw::Cross(law)) => Viscosity::Cross(plateaus(law)),
        ViscositySpec::Law(ShearLaw::PowerLaw(law)) => Viscosity::HerschelBulkley(YieldLaw {
            yield_stress: 0.0,
            consistency: law.consistency,
            index: law.index,
            least_rate: law.regularised,
        }),
        ViscositySpec::Law(ShearLaw::HerschelBulkley(law)) => {
            Viscosity::HerschelBulkley(YieldLaw {
                yield_stress: law.yield_stress,
                consistency: law.consistency,
                index: law.index,
                least_rate: law.regularised,
            })
        }
    }
}

/// What drives the fluid along periodic directions.
fn mean_flow<const D: usize>(case: &Case) -> Option<MeanFlow<D>> {
    let MeanFlowSpec { pressure_gradient, mean_velocity, body_force, factor } =
        case.flow.clone()?;
    let component = |values: &Option<Vec<f64>>, axis: usize| {
        values.as_ref().map(|values| values.get(axis).copied().unwrap_or(0.0))
    };
    let is_periodic = case.periodic_axes();
    let along = std::array::from_fn(|axis| {
        let given = (component(&pressure_gradient, axis), component(&mean_velocity, axis));
        match given {
            (Some(value), _) => MeanFlowAlong::PressureGradient(value),
            (None, Some(value)) if is_periodic[axis] => MeanFlowAlong::Velocity(value),
            _ => MeanFlowAlong::Nothing,
        }
    });
    let body_force =
        Point::<D>::from_fn(|axis, _| component(&body_force, axis).unwrap_or_default());
    let factor = Box::new(move |time| factor_at(factor.as_ref(), time));
    Some(MeanFlow { along, body_force, factor })
}

fn group(case: &Case, swimmer: &SwimmerModel) -> Group {
    let SwimmerModel { name, bodies, period, resistance } = swimmer.clone();
    // A steady solution knows no cycle
    let period = period.filter(|_| matches!(case.time, TimeSettings::Unsteady(_)));
    Group { name, bodies, period, resistance }
}

/// Times at which rates of strokes and shapes jump.
fn rate_discontinuities<const D: usize>(
    model: &Model,
    problem: &Problem<D>,
) -> Option<RateDiscontinuities> {
    // Torques of hinges may jump: nothing moves by them at once
    let of_joints = model.joints.iter().filter_map(|joint| joint.kind.stroke());
    let of_bodies = model.bodies.iter().flat_map(|body| &body.driven);
    let of_bodies = of_bodies.filter_map(|driven| match &driven.law {
        DrivenLaw::Way(stroke) => Some(stroke),
        DrivenLaw::Rate(_) => None,
    });
    let strokes: Vec<Stroke> = of_joints.chain(of_bodies).cloned().collect();
    let shapes: Vec<_> = problem.bodies.iter().filter_map(|body| body.shape.clone()).collect();
    if strokes.is_empty() && shapes.is_empty() {
        return None;
    }
    Some(Box::new(move |from, to| {
        let of_strokes = strokes.iter().flat_map(|stroke| stroke.rate_discontinuities(from, to));
        let of_shapes = shapes.iter().flat_map(|shape| shape.discontinuities(from, to));
        let mut times: Vec<f64> = of_strokes.chain(of_shapes).collect();
        times.sort_by(f64::total_cmp);
        times.dedup_by(|later, earlier| *later - *earlier <= 1e-12 * later.abs());
        times
    }))
}

/// Times of a run at which volumes of bodies are compared.
const VOLUME_TRIALS: u32 = 50;

/// In an enclosed fluid bodies cannot grow or shrink together.
fn check_volumes<const D: usize>(case: &Case, problem: &Problem<D>) -> Result<(), RunError> {
    let TimeSettings::Unsteady(settings) = &case.time else { return Ok(()) };
    let is_rigid = problem.bodies.iter().all(|body| body.shape.is_none());
    if is_rigid || !problem.is_enclosed() {
        return Ok(());
    }
    let volume = |time: f64| -> Result<f64, RunError> {
        let shapes = BodyShapes::at(&problem.bodies, time)?;
        let deformed = (0..problem.bodies.len()).filter_map(|body| shapes.deformed(body));
        Ok(deformed.map(|deformed| deformed.moments.measure).sum())
    };
    let start = volume(0.0)?;
    for trial in 1..VOLUME_TRIALS {
        // Not in step with any period
        let time = settings.end.min(100.0 * settings.step) * (f64::from(trial) * 0.618_034).fract();
        let now = volume(time)?;
        if (now - start).abs() > SAME_VOLUME * start {
            return Err(RunError::Unsupported(format!(
                "the bodies that deform have the volume {start:.6e} at time 0 and {now:.6e} at time \
                 {time:.4}, and no side of the domain lets fluid out: give two bodies gaits that \
                 exchange their volume, or open a side"
            )));
        }
    }
    Ok(())
}

/// Change of a volume over itself that is the error of an interpolated outline.
const SAME_VOLUME: f64 = 1e-6;
