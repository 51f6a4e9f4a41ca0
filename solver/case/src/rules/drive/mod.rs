//! Whether anything drives a case: what can set its fluid or its bodies in motion.

#[cfg(test)]
mod tests;

use nalgebra::{UnitQuaternion, Vector3};

use super::body::joints::start;
use crate::model::speed::{norm, weight};
use crate::text::diagnostic::{Diagnostic, Severity};
use crate::{
    Activation, Body, BoundaryCondition, CaseFile, DomainSpec, Driven, DrivenLaw, Formula,
    GaitSpec, Geometry, Hold, Joint, JointKind, LoadFrame, Lock, MeanFlowSpec, Model, Motion,
    Orientation, ShapeSpec, Stroke, TimeFunction, TimeSettings,
};

/// Length over that of a body, or angle (rad), below which a spring is at rest.
const ROUNDING: f64 = 1e-9;

/// A warning of a case without errors that nothing drives.
#[must_use]
pub fn at_rest(file: &CaseFile) -> Option<Diagnostic> {
    (!is_driven(&file.model)).then(|| Diagnostic {
        severity: Severity::Warning,
        key: String::new(),
        message: "nothing drives this case: all is at rest and stays there".to_owned(),
        help: "give a body a load, a velocity, a density other than the fluid's with gravity, a gait or an imposed \
             motion, a side a velocity, a magnetic moment a field, joints a stroke, a motor or a spring that is not at rest, or \
             the fluid a `flow`"
            .to_owned(),
        location: None,
    })
}

/// Whether anything drives fluid or bodies. Where it would take more than a case to know, something may.
fn is_driven(model: &Model) -> bool {
    let case = &model.case;
    case.boundary.values().any(side_drives)
        || case.flow.as_ref().is_some_and(mean_flow_drives)
        || case.fluid.force.iter().any(is_not_zero)
        || case.initial.iter().flat_map(|initial| &initial.velocity).any(is_not_zero)
        || (0..model.bodies.len()).any(|body| {
            let own = &model.bodies[body];
            gait_drives(own)
                || motion_drives(own)
                || rod_drives(own)
                || spring_drives(own)
                || is_pulled(model, body)
                || field_drives(model, own)
        })
        || model.joints.iter().any(|joint| joint_drives(model, joint))
        || case
            .reduced
            .iter()
            .flat_map(|reduced| &reduced.thruster)
            .any(|one| any(&one.drive.range()))
        || case.reduced.iter().flat_map(|reduced| &reduced.servo).any(|one| one.rate != 0.0)
        || may_touch(model)
        // What diffuses needs no flow
        || !case.scalar.is_empty()
}

fn any(vector: &[f64]) -> bool {
    vector.iter().any(|part| *part != 0.0)
}

/// Whether a factor is not zero at all times.
fn acts(factor: Option<&TimeFunction>) -> bool {
    factor.is_none_or(|factor| factor.largest_integral(1.0) > 0.0)
}

fn is_not_zero(formula: &Formula) -> bool {
    formula.number() != Some(0.0)
}

fn side_drives(side: &BoundaryCondition) -> bool {
    match side {
        BoundaryCondition::Velocity { value, factor }
        | BoundaryCondition::Traction { value, factor, .. } => {
            value.iter().any(is_not_zero) && acts(factor.as_ref())
        }
        BoundaryCondition::Pressure { value, factor, .. } => {
            is_not_zero(value) && acts(factor.as_ref())
        }
        BoundaryCondition::Profile(profile) => {
            profile.largest_speed() > 0.0 && acts(profile.factor.as_ref())
        }
        BoundaryCondition::Developed { flux, peak, factor } => {
            flux.or(*peak).unwrap_or(0.0) != 0.0 && acts(factor.as_ref())
        }
        BoundaryCondition::Parabolic { peak, factor } => *peak != 0.0 && acts(factor.as_ref()),
        BoundaryCondition::Shear { rate, factor, .. } => *rate != 0.0 && acts(factor.as_ref()),
        BoundaryCondition::WavingSheet { amplitude, .. } => *amplitude != 0.0,
        BoundaryCondition::NoSlip
        | BoundaryCondition::DoNothing
        | BoundaryCondition::TractionFree
        | BoundaryCondition::Symmetry
        | BoundaryCondition::Axis
        | BoundaryCondition::Periodic(_) => false,
    }
}

fn mean_flow_drives(flow: &MeanFlowSpec) -> bool {
    let given = [&flow.pressure_gradient, &flow.mean_velocity, &flow.body_force];
    given.into_iter().flatten().any(|values| any(values)) && acts(flow.factor.as_ref())
}

fn gait_drives(body: &Body) -> bool {
    match &body.gait {
        None => false,
        Some(GaitSpec::Squirmer(gait)) => {
            let factors = gait.factors_of_modes();
            gait.modes
                .iter()
                .zip(&factors)
                .any(|(mode, factor)| *mode != 0.0 && acts(factor.as_ref()))
        }
        Some(GaitSpec::Slip(gait)) => gait.velocity.iter().any(|one| one.number() != Some(0.0)),
        Some(GaitSpec::Carangiform(gait)) => {
            let strokes = [&gait.beat, &gait.bend];
            strokes.into_iter().flatten().any(moves)
                || gait.bending != 0.0
                || gait.curvature.iter().any(|pair| pair[1] != 0.0)
        }
        Some(GaitSpec::Anguilliform(gait)) => gait.amplitude != 0.0,
        Some(GaitSpec::Flagellum(gait)) => gait.amplitude != 0.0,
        Some(GaitSpec::Midline(_)) => true,
        Some(GaitSpec::Pulsating(gait)) => {
            let differs = gait.table.windows(2).any(|pair| pair[0][1] != pair[1][1]);
            gait.amplitude.is_some_and(|amplitude| amplitude != 0.0) || differs
        }
        Some(GaitSpec::Joints(gait)) => gait.joints.iter().any(|joint| moves(&joint.angle)),
    }
}

fn motion_drives(body: &Body) -> bool {
    let Motion::Imposed(motion) = &body.motion else {
        let is_driven = |driven: &Driven| match &driven.law {
            DrivenLaw::Way(stroke) => moves(stroke),
            DrivenLaw::Rate(rate) => rate.value != 0.0 && acts(rate.factor.as_ref()),
        };
        return any(&body.velocity)
            || !body.angular_velocity.is_zero()
            || body.driven.iter().any(is_driven);
    };
    (any(&motion.velocity) && acts(motion.factor.as_ref()))
        || (!motion.angular_velocity.is_zero() && acts(motion.factor_of_turn()))
}

/// Whether a field acts on a body that is free; where it would take more than a case to know, it may move it.
fn field_drives(model: &Model, body: &Body) -> bool {
    let is_there = model.case.magnetic_field().is_some() && !body.magnetic_moment.is_empty();
    is_there && body.motion == Motion::Free
}

/// Whether a rod is bent from the shape it has at the start, which is that without loads, or its head is turned.
fn rod_drives(body: &Body) -> bool {
    let turns = body.attached.as_ref().is_some_and(|attached| match &attached.hold {
        Hold::Angle(angle) => moves(angle),
        Hold::Clamped | Hold::Hinged => false,
    });
    let acts = |stroke: &Stroke| moves(stroke) || stroke.at(0.0)[0] != 0.0;
    let active = body.activation.as_ref();
    let mut strokes = active.into_iter().flat_map(Activation::strokes);
    let mut loads = body.end_loads().flat_map(|at| at.load.strokes());
    turns || strokes.any(acts) || loads.any(acts)
}

/// Whether the spring of a body is not at rest at the start.
fn spring_drives(body: &Body) -> bool {
    let Some(spring) = &body.spring else { return false };
    // Of other shapes the centre of mass, which the anchor is compared with, may be elsewhere
    let is_symmetric = matches!(
        body.shape,
        ShapeSpec::Disc { .. } | ShapeSpec::Ellipse { .. } | ShapeSpec::Box { .. }
    );
    let is_centred =
        !any(&body.center_of_mass) && (body.shape.semi_axes().is_some() || is_symmetric);
    let is_stretched = |(axis, anchor): (usize, &f64)| {
        let center = body.center.get(axis).copied().unwrap_or(0.0);
        let is_stiff = spring.stiffness.get(axis).is_some_and(|stiffness| *stiffness != 0.0);
        let is_locked = body.locked.contains(&[Lock::X, Lock::Y, Lock::Z][axis.min(2)]);
        let is_off = (anchor - center).abs() > ROUNDING * body.shape.reach();
        is_stiff && !is_locked && (is_off || !is_centred)
    };
    let rest = spring.rest_orientation.as_ref().map(Orientation::rotation);
    let is_turned = spring.rest_angle.is_some_and(|rest| (rest - body.angle).abs() > ROUNDING)
        || rest.is_some_and(|rest| {
            let start = body.orientation.as_ref().map(Orientation::rotation);
            rest.angle_to(&start.unwrap_or_else(UnitQuaternion::identity)) > ROUNDING
        });
    spring.anchor.iter().enumerate().any(is_stretched)
        || (spring.torsion != 0.0 && body.turns() && is_turned)
}

/// Whether a load acts on a body that can give way to it.
fn is_pulled(model: &Model, body: usize) -> bool {
    let (case, own) = (&model.case, &model.bodies[body]);
    let (is_heavy, is_given) = (weight(case, own) != 0.0, acts(own.load_factor.as_ref()));
    let is_pushed = is_given && any(&own.force);
    let is_buoyant = case.fluid.density != 0.0 && any(&case.fluid.gravity);
    let is_twisted =
        (is_given && !own.torque.is_zero()) || (is_buoyant && any(&own.center_of_mass));
    if !(is_heavy || is_pushed || is_twisted) {
        return false;
    }
    let mut root = body;
    while let Some(above) = model.joint_above(root) {
        let joint = &model.joints[above];
        if joint.kind.stroke().is_none() {
            return true;
        }
        let Some(parent) = model.body_index(&joint.parent) else { return false };
        root = parent;
    }
    let holder = &model.bodies[root];
    if holder.motion != Motion::Free {
        return false;
    }
    let translates = |axis: usize| {
        let motion = [Lock::X, Lock::Y, Lock::Z][axis];
        case.geometry.motions().contains(&motion) && !holder.locked.contains(&motion)
    };
    let turns = case.geometry != Geometry::Axisymmetric && holder.turns();
    // A load beside the body that gives way turns it, and so may one on a body that is not round
    let is_alone = root == body && own.is_round() && own.load_frame == LoadFrame::Laboratory;
    let along = |vector: &[f64]| {
        let is_along = |(axis, part): (usize, &f64)| *part != 0.0 && axis < 3 && translates(axis);
        vector.iter().enumerate().any(is_along)
    };
    let is_moved = (is_heavy && along(&case.fluid.gravity)) || (is_pushed && along(&own.force));
    is_moved
        || (turns && (is_twisted || !is_alone))
        || (!is_alone && (0..3).any(translates) && own.load_frame == LoadFrame::Body)
}

/// Whether a stroke is not the same at all times.
pub(super) fn moves(stroke: &Stroke) -> bool {
    match stroke {
        Stroke::Constant(_) => false,
        Stroke::Steady { rate, .. } => *rate != 0.0,
        other => {
            let [least, most] = other.range();
            least < most
        }
    }
}

/// Whether a stroke, motor or spring of a joint moves its child.
fn joint_drives(model: &Model, joint: &Joint) -> bool {
    let motor = |stroke: &Option<Stroke>| match stroke {
        None => false,
        Some(Stroke::Steady { start, rate }) => *start != 0.0 || *rate != 0.0,
        Some(stroke) => any(&stroke.range()),
    };
    let is_off = |stiffness: f64, now: Option<f64>, rest: f64| {
        stiffness != 0.0 && now.is_none_or(|now| (now - rest).abs() > ROUNDING * (1.0 + rest.abs()))
    };
    match &joint.kind {
        JointKind::Arm { length, .. } => moves(length),
        JointKind::Bent { angle, .. } => moves(angle),
        JointKind::Hinge(hinge) => {
            let axis = hinge.axis.map_or_else(Vector3::z, Vector3::from);
            motor(&hinge.torque) || is_off(hinge.stiffness, angle(model, joint, axis), hinge.rest)
        }
        JointKind::Slider(slider) => {
            let along = slider.along.map(Vector3::from);
            motor(&slider.force)
                || is_off(slider.stiffness, length(model, joint, along), slider.rest)
        }
        // At rest as it starts
        JointKind::Ball(_) => false,
    }
}

/// The bodies of a joint.
fn ends(model: &Model, joint: &Joint) -> Option<[usize; 2]> {
    Some([model.body_index(&joint.parent)?, model.body_index(&joint.child)?])
}

/// Angle of a hinge at the start (rad).
fn angle(model: &Model, joint: &Joint, axis: Vector3<f64>) -> Option<f64> {
    let [parent, child] = ends(model, joint)?.map(|body| &model.bodies[body]);
    if model.case.geometry != Geometry::Spatial {
        return Some(child.angle - parent.angle);
    }
    let [parent, child] = [parent, child].map(|body| body.pose_in_space().rotation);
    let turn = parent.inverse() * child;
    Some(2.0 * turn.imag().dot(&axis.normalize()).atan2(turn.w))
}

/// Length of a slider at the start (m).
fn length(model: &Model, joint: &Joint, along: Option<Vector3<f64>>) -> Option<f64> {
    let ends = ends(model, joint)?;
    match (&joint.kind, along) {
        (JointKind::Slider(slider), None) => {
            let poses = ends.map(|body| start(model, body));
            Some(slider.length_in_plane(poses, joint.ends_in_plane()))
        }
        (_, along) => {
            let [parent, child] = ends.map(|body| model.bodies[body].pose_in_space());
            let [on_parent, on_child] = joint.ends();
            let end = parent.inverse_transform_point(&(child * nalgebra::Point3::from(on_child)));
            Some((end.coords - on_parent).dot(&along?.normalize()))
        }
    }
}

/// Whether contact may act at the start, by circles around bodies, and by boxes where walls are along
/// coordinates.
fn may_touch(model: &Model) -> bool {
    let case = &model.case;
    let (Some(contact), TimeSettings::Unsteady(_)) = (case.contact, &case.time) else {
        return false;
    };
    let (range, extent, is_periodic) = (contact.range(), case.extent(), case.periodic_axes());
    let has_plane_walls = match &case.domain {
        DomainSpec::Box { .. } | DomainSpec::Channel { .. } => true,
        DomainSpec::Cylinder { .. } => case.geometry == Geometry::Axisymmetric,
        _ => false,
    };
    let center = |body: &Body, axis: usize| body.center.get(axis).copied().unwrap_or(0.0);
    let is_at_wall = |body: &Body| {
        let reach = body.shape.reach() + range;
        (0..case.geometry.dimensions()).any(|axis| {
            let at = center(body, axis);
            !is_periodic[axis] && (at - reach < extent.min[axis] || at + reach > extent.max[axis])
        })
    };
    let are_near = |one: &Body, other: &Body| {
        let across = (0..case.geometry.dimensions()).map(|axis| {
            let (far, period) = (center(one, axis) - center(other, axis), extent.lengths()[axis]);
            if is_periodic[axis] { far - period * (far / period).round() } else { far }
        });
        norm(&across.collect::<Vec<_>>()) < one.shape.reach() + other.shape.reach() + range
    };
    model.bodies.iter().enumerate().any(|(nth, one)| {
        !has_plane_walls
            || is_at_wall(one)
            || model.bodies[..nth].iter().any(|other| are_near(one, other))
    })
}
