//! Problems of `[flow]`, and of periodic domains in which nothing determines the mean flow.

use super::boundary::check_factor;
use crate::model::numbers::significant;
use crate::model::region::normal_axis;
use crate::model::speed::load_in_space;
use crate::rules::Findings;
use crate::rules::body::rod::beside;
use crate::{
    Body, BoundaryCondition, FlowModel, LoadFrame, Lock, MeanFlowSpec, Motion, SpringSpec,
    TimeSettings,
};

/// Part of all loads that is taken for rounding.
const ROUNDING: f64 = 1e-9;

const AXES: [&str; 3] = ["x", "y", "z"];

pub fn check(findings: &mut Findings<'_>) {
    let case = findings.case();
    if let Some(flow) = &case.flow {
        check_given(findings, flow);
    }
    let is_instantaneous =
        case.fluid.model == FlowModel::Stokes || matches!(case.time, TimeSettings::Steady(_));
    let periodic = case.periodic_axes();
    for axis in (0..AXES.len()).filter(|&axis| is_instantaneous && periodic[axis]) {
        if !sides_hold(findings, axis) {
            check_determined(findings, axis);
        }
    }
}

/// Whether the numbers fit to the domain.
fn check_given(findings: &mut Findings<'_>, flow: &MeanFlowSpec) {
    let periodic = findings.case().periodic_axes();
    let MeanFlowSpec { pressure_gradient, mean_velocity, body_force, factor } = flow;
    if pressure_gradient.is_some() && mean_velocity.is_some() {
        findings.error(
            "flow.mean_velocity",
            "a mean velocity and a mean pressure gradient are given, and one follows from the other"
                .to_owned(),
            "leave out one of them",
        );
    }
    if pressure_gradient.is_none() && mean_velocity.is_none() && body_force.is_none() {
        findings.error(
            "flow",
            "`flow` drives nothing".to_owned(),
            "give mean_velocity = [u, v], pressure_gradient = [gx, gy] or body_force = [fx, fy]",
        );
    }
    for (name, values) in [
        ("pressure_gradient", pressure_gradient),
        ("mean_velocity", mean_velocity),
        ("body_force", body_force),
    ] {
        let key = format!("flow.{name}");
        let Some(values) = values.as_ref().filter(|values| findings.is_vector(values)) else {
            continue;
        };
        for (axis, value) in values.iter().enumerate() {
            if *value != 0.0 && !periodic[axis] {
                let along = AXES[axis];
                findings.error(
                    &key,
                    format!("`{key}` is {value} along {along}, where the domain is not periodic"),
                    "write 0 there and drive the flow by a side, or make the two sides periodic",
                );
            }
        }
    }
    if let Some(factor) = factor {
        check_factor(findings, "flow.factor", factor);
    }
}

/// Whether a side holds the fluid along a coordinate.
fn sides_hold(findings: &Findings<'_>, axis: usize) -> bool {
    findings.case().boundary.iter().any(|(side, condition)| match condition {
        BoundaryCondition::Periodic(_) => false,
        BoundaryCondition::Symmetry => {
            // The wall of an axisymmetric cylinder is normal to y
            normal_axis(side).unwrap_or(1) == axis
        }
        BoundaryCondition::Axis => axis == 1,
        _ => true,
    })
}

/// Whether a body has a given velocity along a coordinate.
fn is_held(body: &Body, axis: usize) -> bool {
    let lock = [Lock::X, Lock::Y, Lock::Z][axis];
    match &body.motion {
        Motion::Free => body.locked.contains(&lock),
        Motion::Held | Motion::Imposed(_) | Motion::ByAxis(_) => true,
    }
}

/// A flow without memory in a domain whose sides hold nothing along a coordinate.
fn check_determined(findings: &mut Findings<'_>, axis: usize) {
    let (case, model) = (findings.case(), findings.model());
    let along = AXES[axis];
    let given = |values: &Option<Vec<f64>>| values.as_ref().and_then(|all| all.get(axis).copied());
    let flow = case.flow.clone().unwrap_or_default();
    let [gradient, velocity, force] =
        [&flow.pressure_gradient, &flow.mean_velocity, &flow.body_force].map(given);
    let holder = model.bodies.iter().position(|body| is_held(body, axis));
    let has_spring = model.bodies.iter().any(|body| body.spring.is_some());
    let resists = |all: &[f64]| all.get(axis).is_some_and(|value| *value != 0.0);
    let ties = |spring: &SpringSpec| resists(&spring.stiffness) || resists(&spring.damping);
    if holder.is_none() && !model.bodies.iter().filter_map(|body| body.spring.as_ref()).any(ties) {
        beside::unheld(findings, along);
    }
    let is_pushed = case.fluid.force.get(axis).is_some_and(|force| force.number() != Some(0.0));
    let is_driven = is_pushed || [gradient, force].iter().flatten().any(|value| *value != 0.0);
    match holder {
        Some(body) if gradient.or(velocity).or(force).is_none() => findings.error(
            &format!("body.{body}.motion"),
            format!(
                "nothing determines the mean flow along {along}: the domain is periodic and has no \
                 walls along it, so that all the fluid takes the velocity of `{}` and no force is left",
                model.bodies[body].name
            ),
            "add [flow] with mean_velocity = [0.0, 0.0] for a cell without net flux, or another \
             mean velocity or pressure gradient",
        ),
        None if is_driven && velocity.is_none() && !has_spring => findings.error(
            "flow",
            format!("nothing resists the flow along {along}: no wall, and no body that is held"),
            "give mean_velocity instead, hold a body, or put a wall along it",
        ),
        None if velocity.or(gradient).or(force).is_none() => check_balance(findings, axis),
        _ => {}
    }
}

/// Constant loads on free bodies where nothing holds fluid and bodies along a coordinate: they must sum up
/// to nothing.
fn check_balance(findings: &mut Findings<'_>, axis: usize) {
    let (case, model) = (findings.case(), findings.model());
    let along = AXES[axis];
    let is_plain = |body: &Body| {
        body.load_factor.is_none()
            && body.load_frame == LoadFrame::Laboratory
            && body.spring.is_none()
            && body.gait.is_none()
            && body.magnetic_moment.is_empty()
    };
    if case.fluid.model != FlowModel::Stokes || !model.bodies.iter().all(is_plain) {
        return;
    }
    let load = |body: &Body| load_in_space(case, body)[axis];
    let loads: Vec<f64> = model.bodies.iter().map(load).collect();
    let (sum, size) = (loads.iter().sum::<f64>(), loads.iter().map(|load| load.abs()).sum::<f64>());
    if sum.abs() > ROUNDING * size {
        let first = loads.iter().position(|load| *load != 0.0).unwrap_or(0);
        let key = if model.bodies[first].force.is_empty() { "density" } else { "force" };
        findings.error(
            &format!("body.{first}.{key}"),
            format!(
                "the loads on the bodies sum up to {} along {along}, where nothing holds fluid and bodies",
                significant(sum)
            ),
            "balance them, hold a body or a side, or add [flow] with mean_velocity: the mean pressure gradient \
             then balances them",
        );
    }
}
