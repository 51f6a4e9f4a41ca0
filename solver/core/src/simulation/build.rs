//! From a `Case` to a mesh and a `Problem`.

use std::f64::consts::PI;

use alewife_mesh::{BoundaryKind, Mesh, PlacedShape, Point, SizeBox, Sizing};
use nalgebra::Vector3;

use super::RunError;
use super::opened::{Opened, open_first};
use super::shape_motion::shape_motion;
use crate::body::{Pose, Wrench};
use crate::case::{
    Body, BoundaryCondition, Case, ContactSpec, DomainSpec, FlowModel, GaitSpec, Geometry, Hinge,
    Joint, JointKind, Lock, Model, Motion, ShapeSpec, Stroke, SwimmerModel, TimeFunction,
    TimeSettings,
};
use crate::contact::{Law, LawKind};
use crate::coupling::{
    Arm, BodyShapes, Drive, Group, Link, Pivot, Problem, RateDiscontinuities, RigidBody,
    ShapeError, Side, Spring, TimeValue, Turn, VelocityProfile, second_moment,
};
use crate::gait::{Gait, InTime, Squirmer, WavingSheet};
use crate::space::Metric;
use crate::time::factor_at;

/// The mesh of a case.
///
/// # Errors
/// When a body does not fit, or the mesh cannot be made.
pub fn build_mesh(model: &Model) -> Result<Mesh<2>, RunError> {
    Ok(first_mesh(model)?.0)
}

/// The mesh of a case, with its domain and bodies as they are meshed.
pub(super) fn first_mesh(model: &Model) -> Result<(Mesh<2>, Opened), RunError> {
    let case = &model.case;
    let opened = open_first(&case.mesh_domain(), placed_bodies(model)?).map_err(RunError::Mesh)?;
    let mut mesh = opened.mesh(&sizing(case)).map_err(|error| RunError::Mesh(error.to_string()))?;
    // The side of a sheet is made straight, but will not stay so.
    for facet in &mesh.facets {
        if waving_sheet(case, &mesh.boundaries[facet.boundary].name).is_some() {
            mesh.curved[facet.cell] = true;
        }
    }
    Ok((mesh, opened))
}

/// The sheet that a side of the domain is, if it is one.
pub(super) fn waving_sheet(case: &Case, side: &str) -> Option<WavingSheet> {
    match case.boundary.get(side) {
        Some(&BoundaryCondition::WavingSheet { amplitude, wavelength, frequency, extensible }) => {
            Some(WavingSheet::new(amplitude, wavelength, frequency, extensible))
        }
        _ => None,
    }
}

/// The bodies of a case as they are meshed at time zero.
pub(super) fn placed_bodies(model: &Model) -> Result<Vec<PlacedShape>, RunError> {
    let placed = |body: &Body| {
        let mut placed = body.placed(model.case.mesh.scale);
        if let Some(motion) = shape_motion(body)? {
            let start = motion.at(0.0);
            let start = start.map_err(|reason| ShapeError { body: body.name.clone(), reason })?;
            placed.shape = start.shape();
        }
        Ok(placed)
    };
    model.bodies.iter().map(placed).collect()
}

/// The law of contact a case asks for.
pub(super) fn contact_law(contact: &ContactSpec) -> Result<Law, RunError> {
    let (kind, range) = match *contact {
        ContactSpec::Quadratic { range, epsilon } => (LawKind::Quadratic { epsilon }, range),
        ContactSpec::Barrier { range, stiffness } => (LawKind::Barrier { stiffness }, range),
    };
    Law::new(kind, range).map_err(|error| RunError::Unsupported(error.to_string()))
}

/// Angle by which an outline turns along one edge at most (rad), however large its size.
const LARGEST_TURN: f64 = 0.5;

/// The wanted cell sizes of a case.
#[must_use]
pub fn sizing(case: &Case) -> Sizing {
    let mesh = &case.mesh;
    let boxes = mesh.boxes.iter().map(|refined| SizeBox {
        min: refined.min.into(),
        max: refined.max.into(),
        size: refined.size * mesh.scale,
    });
    Sizing {
        size: mesh.size * mesh.scale,
        surface: mesh.surface.unwrap_or(mesh.size) * mesh.scale,
        sides: mesh.sides.iter().map(|(name, size)| (name.clone(), size * mesh.scale)).collect(),
        // A finer mesh has the same shape: more layers in gaps, slower growth.
        growth: mesh.growth * mesh.scale,
        gap_layers: mesh.gap_layers / mesh.scale,
        turn: LARGEST_TURN * mesh.scale,
        boxes: boxes.collect(),
        curved: mesh.curved,
    }
}

/// The problem of a case on its mesh.
///
/// # Errors
/// When the case asks for something that is not there yet.
pub fn build_problem(model: &Model, mesh: &Mesh<2>) -> Result<Problem, RunError> {
    let case = &model.case;
    let metric = match case.geometry {
        Geometry::Planar => Metric::Cartesian,
        Geometry::Axisymmetric => Metric::Revolved,
    };
    let mut sides = Vec::new();
    let mut bodies = Vec::new();
    for (boundary, known) in mesh.boundaries.iter().enumerate() {
        sides.push(match known.kind {
            BoundaryKind::Body(body) => {
                bodies.push(rigid_body(case, &model.bodies[body], boundary, metric)?);
                None
            }
            BoundaryKind::Axis => Some(Side::Symmetry { normal_axis: Metric::RADIAL }),
            BoundaryKind::Side => Some(side(case, &known.name)?),
        });
    }
    let frame = model.frame_body();
    if let (None, Some(name)) = (frame, &case.frame) {
        return Err(RunError::Unsupported(format!("frame = \"{name}\" names no body")));
    }
    for joint in &model.joints {
        link(model, joint, &mut bodies)?;
    }
    let has_inertia = case.fluid.model != FlowModel::Stokes;
    let mut problem = Problem {
        metric,
        density: if has_inertia { case.fluid.density } else { 0.0 },
        viscosity: case.fluid.viscosity,
        has_inertia,
        has_convection: case.fluid.model == FlowModel::NavierStokes,
        sides,
        bodies,
        groups: model.swimmers.iter().map(|swimmer| group(case, swimmer)).collect(),
        frame,
        body_force: None,
        rate_discontinuities: None,
    };
    problem.rate_discontinuities = rate_discontinuities(model, &problem);
    check_volumes(case, &problem)?;
    let mut places: Vec<[f64; 3]> = problem.bodies.iter().map(RigidBody::start).collect();
    problem.hang(&mut places, 0.0);
    for (body, [x, y, angle]) in problem.bodies.iter_mut().zip(places) {
        if body.link.is_some() {
            body.pose = Pose::planar(x, y, angle);
        }
    }
    Ok(problem)
}

fn group(case: &Case, swimmer: &SwimmerModel) -> Group {
    let SwimmerModel { name, bodies, period, resistance } = swimmer.clone();
    // A steady solution knows no cycle
    let period = period.filter(|_| matches!(case.time, TimeSettings::Unsteady(_)));
    Group { name, bodies, period, resistance }
}

/// Hangs a child on its parent.
fn link(model: &Model, joint: &Joint, bodies: &mut [RigidBody]) -> Result<(), RunError> {
    let find = |name: &str| {
        model.body_index(name).ok_or_else(|| {
            RunError::Unsupported(format!("a joint names \"{name}\", which is no body"))
        })
    };
    let (parent, child) = (find(&joint.parent)?, find(&joint.child)?);
    let from_center = |body: usize, point: [f64; 2]| {
        let centroid = model.bodies[body].shape.outline().moments().map(|moments| moments.centroid);
        Point::<2>::from(point) - centroid.unwrap_or_default()
    };
    let bend = model.bodies[child].angle - model.bodies[parent].angle;
    let mut arm = None;
    let turn = match joint.kind.clone() {
        JointKind::Arm { length, direction } => {
            // Along an axis to the last bit
            let snap = |part: f64| if part.abs() < 1e-15 { 0.0 } else { part };
            let along = Point::<2>::new(snap(direction.cos()), snap(direction.sin()));
            arm = Some(Arm { along, length: Box::new(move |time| length.at(time)) });
            Turn::Given(Box::new(move |_| [bend, 0.0]))
        }
        JointKind::Bent { angle } => Turn::Given(Box::new(move |time| angle.at(time))),
        JointKind::Hinge(hinge) => {
            let motor = hinge
                .torque
                .map(|torque| -> TimeValue { Box::new(move |time| torque.at(time)[0]) });
            let Hinge { stiffness, damping, rest, .. } = hinge;
            Turn::Free(Pivot { stiffness, damping, rest, motor })
        }
    };
    let is_planar = model.case.geometry == Geometry::Planar;
    let is_free = matches!(turn, Turn::Free(_)) && is_planar;
    let on_parent = from_center(parent, joint.on_parent);
    let on_child = from_center(child, joint.on_child);
    let body = &mut bodies[child];
    body.drives[0] = Drive::Linked;
    if is_planar {
        body.drives[1] = Drive::Linked;
        body.drives[2] = if is_free { Drive::Free } else { Drive::Linked };
    }
    body.link = Some(Link { parent, on_parent, arm, on_child, turn });
    Ok(())
}

/// Times at which rates of strokes and shapes jump.
fn rate_discontinuities(model: &Model, problem: &Problem) -> Option<RateDiscontinuities> {
    // Torques of hinges may jump: nothing moves by them at once
    let strokes: Vec<Stroke> =
        model.joints.iter().filter_map(|joint| joint.kind.stroke().cloned()).collect();
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
fn check_volumes(case: &Case, problem: &Problem) -> Result<(), RunError> {
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

/// Extent of the domain along y, where profiles are zero, and its lower end.
fn height_range(case: &Case) -> [f64; 2] {
    match &case.domain {
        DomainSpec::Box { min, max } => [min[1], max[1]],
        DomainSpec::Channel { height, .. } => [0.0, *height],
        DomainSpec::Disc { center, radius } => [center[1] - radius, center[1] + radius],
        // Symmetric about the axis.
        DomainSpec::HalfDisc { radius, .. } | DomainSpec::Cylinder { radius, .. } => {
            [-radius, *radius]
        }
    }
}

fn side(case: &Case, name: &str) -> Result<Side, RunError> {
    let condition = case.boundary.get(name).ok_or_else(|| {
        RunError::Unsupported(format!("side `{name}` of the domain has no condition in [boundary]"))
    })?;
    let scaled = |profile: VelocityProfile, factor: &Option<TimeFunction>| {
        let factor = factor.clone();
        Side::Velocity {
            profile: Box::new(move |place, time| {
                profile(place, time) * factor_at(factor.as_ref(), time)
            }),
            is_wall: false,
        }
    };
    Ok(match condition {
        BoundaryCondition::NoSlip => {
            Side::Velocity { profile: Box::new(|_, _| Point::<2>::zeros()), is_wall: true }
        }
        BoundaryCondition::WavingSheet { amplitude, wavelength, frequency, extensible } => {
            let sheet = WavingSheet::new(*amplitude, *wavelength, *frequency, *extensible);
            let profile: VelocityProfile =
                Box::new(move |place, time| sheet.velocity(place[0], time));
            Side::Velocity { profile, is_wall: true }
        }
        BoundaryCondition::DoNothing => Side::DoNothing,
        BoundaryCondition::TractionFree => Side::TractionFree,
        BoundaryCondition::Periodic(_) => Side::Periodic,
        BoundaryCondition::Axis => Side::Symmetry { normal_axis: Metric::RADIAL },
        BoundaryCondition::Symmetry => match name {
            "left" | "right" => Side::Symmetry { normal_axis: 0 },
            "bottom" | "top" => Side::Symmetry { normal_axis: Metric::RADIAL },
            "wall" if matches!(case.domain, DomainSpec::Cylinder { .. }) => {
                Side::Symmetry { normal_axis: Metric::RADIAL }
            }
            _ => {
                return Err(RunError::Unsupported(format!(
                    "side `{name}` is curved, and a symmetry plane is straight"
                )));
            }
        },
        BoundaryCondition::Velocity { value, factor } => {
            let value = Point::<2>::new(value[0], value[1]);
            scaled(Box::new(move |_, _| value), factor)
        }
        BoundaryCondition::Parabolic { peak, factor } => {
            let ([low, high], peak) = (height_range(case), *peak);
            scaled(
                Box::new(move |place, _| {
                    let s = (place[1] - low) / (high - low);
                    Point::<2>::new(4.0 * peak * s * (1.0 - s), 0.0)
                }),
                factor,
            )
        }
        BoundaryCondition::Shear { rate, origin, factor } => {
            let (rate, origin) = (*rate, *origin);
            scaled(
                Box::new(move |place, _| Point::<2>::new(rate * (place[1] - origin), 0.0)),
                factor,
            )
        }
    })
}

fn rigid_body(
    case: &Case,
    body: &Body,
    boundary: usize,
    metric: Metric,
) -> Result<RigidBody, RunError> {
    let moments = body.shape.outline().moments().ok_or_else(|| {
        RunError::Unsupported(format!("body `{}`: its spline has no valid outline", body.name))
    })?;
    let second_moment = second_moment(&moments);
    let has_inertia = case.fluid.model != FlowModel::Stokes;
    let density = body.density.unwrap_or(case.fluid.density);
    // Weight less buoyancy: the pressure is the one without its hydrostatic part.
    let net_mass = (density - case.fluid.density) * moments.measure;
    let along = |values: &[f64], axis: usize| values.get(axis).copied().unwrap_or(0.0);
    let force = [0, 1].map(|axis| along(&body.force, axis));
    let weight = [0, 1].map(|axis| net_mass * along(&case.fluid.gravity, axis));
    let locked = |mode: usize| {
        let lock = [Lock::X, Lock::Y, Lock::Rotation][mode];
        let is_possible =
            if mode == 2 { metric.has_rotation() } else { metric.has_translation(mode) };
        body.locked.contains(&lock) || !is_possible
    };
    let drives = [0, 1, 2].map(|mode| match &body.motion {
        Motion::Free if !locked(mode) => Drive::Free,
        Motion::Held | Motion::Free => Drive::Given(Box::new(|_| 0.0)),
        Motion::Imposed(imposed) => {
            let value =
                if mode == 2 { imposed.angular_velocity } else { along(&imposed.velocity, mode) };
            let factor = imposed.factor.clone();
            let value: TimeValue = Box::new(move |time| value * factor_at(factor.as_ref(), time));
            Drive::Given(value)
        }
    });
    // The centre of mass of a spline is not the origin of its points.
    let offset = nalgebra::Rotation2::new(body.angle) * moments.centroid;
    let shape = shape_motion(body)?;
    let gait: Option<Box<dyn Gait>> = match &body.gait {
        // The others deform the body: `shape_motion`
        None
        | Some(
            GaitSpec::Carangiform(_)
            | GaitSpec::Anguilliform(_)
            | GaitSpec::Flagellum(_)
            | GaitSpec::Pulsating(_),
        ) => None,
        Some(GaitSpec::Squirmer(squirmer)) => {
            // On the axis the heading is 0 or pi, and must be so to the last bit.
            let axis = if metric.is_revolved() {
                Vector3::x() * if (squirmer.heading.abs() - PI).abs() < 1e-3 { -1.0 } else { 1.0 }
            } else {
                Vector3::new(squirmer.heading.cos(), squirmer.heading.sin(), 0.0)
            };
            let in_time = |function: TimeFunction| {
                InTime(Box::new(move |time| factor_at(Some(&function), time)))
            };
            let factors = squirmer.factors_of_modes().into_iter();
            Some(Box::new(Squirmer {
                modes: squirmer.modes.clone(),
                factors: factors.map(|factor| factor.map(in_time)).collect(),
                axis,
                turn: squirmer.turn.clone().map(in_time),
                is_sphere: matches!(body.shape, ShapeSpec::Sphere { .. }),
            }))
        }
    };
    let center = Point::<2>::new(body.center[0] + offset[0], body.center[1] + offset[1]);
    let pose = Pose::planar(center.x, center.y, body.angle);
    Ok(RigidBody {
        name: body.name.clone(),
        boundary,
        pose,
        drives,
        volume: moments.measure,
        second_moment,
        mass: if has_inertia { density * moments.measure } else { 0.0 },
        inertia: if has_inertia { density * second_moment } else { 0.0 },
        weight: Wrench::planar([weight[0], weight[1], 0.0]),
        load: Wrench::planar([force[0], force[1], body.torque]),
        load_factor: body
            .load_factor
            .clone()
            .map(|factor| -> TimeValue { Box::new(move |time| factor_at(Some(&factor), time)) }),
        spring: body.spring.as_ref().map(|spring| Spring {
            stiffness: [along(&spring.stiffness, 0), along(&spring.stiffness, 1), spring.torsion],
            damping: [along(&spring.damping, 0), along(&spring.damping, 1), spring.torsion_damping],
            rest: [
                spring.anchor.first().copied().unwrap_or(center.x),
                spring.anchor.get(1).copied().unwrap_or(center.y),
                spring.rest_angle.unwrap_or_else(|| pose.heading()),
            ],
        }),
        gait,
        shape,
        link: None,
    })
}
