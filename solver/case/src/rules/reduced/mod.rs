//! Problems of `[reduced]`: coefficients that are none, and what no law of loads knows.

mod bodies;
pub mod calibration;
mod connection;
mod mechanics;
mod parts;

pub use self::parts::is_a_body;

use std::collections::BTreeMap;

use super::Findings;
use crate::text::nearest::nearest;
use crate::{
    Body, BoundaryCondition, CaseFile, Diagnostic, FlowModel, Geometry, LoadLaw, ReducedSpec,
    TimeSettings,
};

/// Problems of a case with `[reduced]`.
pub fn check(findings: &mut Findings<'_>) {
    if findings.case().reduced.is_some() {
        check_model(findings);
    }
}

/// All that keeps a case from being run by laws of loads, whether it has `[reduced]` or not.
#[must_use]
pub fn check_reduced(file: &CaseFile) -> Vec<Diagnostic> {
    let mut findings = Findings::new(file);
    check_model(&mut findings);
    findings.into_diagnostics()
}

fn check_model(findings: &mut Findings<'_>) {
    let spec = findings.case().reduced_model();
    coefficients(findings, &spec);
    law(findings, &spec);
    elongated(findings, &spec);
    whole_case(findings);
    sides(findings);
    bodies::check(findings, &spec);
    parts::check(findings, &spec);
    mechanics::check(findings, &spec);
    connection::check(findings, &spec);
}

/// Names and values of coefficients.
fn coefficients(findings: &mut Findings<'_>, spec: &ReducedSpec) {
    table(findings, spec.loads, "reduced.coefficients", &spec.coefficients);
    for (name, own) in &spec.body {
        let key = format!("reduced.body.{name}");
        if findings.model().body_index(name).is_none() {
            let names: Vec<&str> =
                findings.model().bodies.iter().map(|body| body.name.as_str()).collect();
            let help = format!("bodies: {}", names.join(", "));
            findings.error(&key, format!("there is no body \"{name}\""), &help);
        }
        table(findings, spec.loads, &key, own);
    }
    let help = "leave it out, or write loads = \"ellipsoid\"";
    let name = spec.loads.name();
    if spec.added_mass.is_some() && spec.loads != LoadLaw::Ellipsoid {
        let message = format!("the law \"{name}\" has a coefficient in its place");
        findings.error("reduced.added_mass", message, help);
    }
    if spec.lift.is_some() && spec.loads != LoadLaw::Ellipsoid {
        let message = format!("the law \"{name}\" has no lift by the angle of attack");
        findings.error("reduced.lift", message, help);
    }
}

fn table(findings: &mut Findings<'_>, law: LoadLaw, key: &str, values: &BTreeMap<String, f64>) {
    let known: Vec<&str> = law.coefficients().iter().map(|one| one.name).collect();
    for (name, value) in values {
        let key = format!("{key}.{name}");
        if known.is_empty() {
            let help = "leave it out: its numbers are those of [reduced.connection]";
            findings.error(&key, format!("the law \"{}\" has no coefficients", law.name()), help);
        } else if !known.contains(&name.as_str()) {
            let close = nearest(name, &known)
                .map_or(String::new(), |near| format!("; did you mean {near}?"));
            findings.error(
                &key,
                format!("the law \"{}\" has no coefficient \"{name}\"", law.name()),
                &format!("coefficients: {}{close}", known.join(", ")),
            );
        } else if !(value.is_finite() && *value >= 0.0) {
            let help = "a number of 0 or more";
            findings.error(&key, format!("the coefficient \"{name}\" is {value}"), help);
        }
    }
}

/// The law fits the fluid and the dimension.
fn law(findings: &mut Findings<'_>, spec: &ReducedSpec) {
    let case = findings.case();
    let (geometry, is_stokes) = (case.geometry, case.fluid.model == FlowModel::Stokes);
    let name = spec.loads.name();
    let is_slow = spec.loads.is_without_inertia();
    let wanted = match spec.loads {
        LoadLaw::Links | LoadLaw::Ebt if geometry != Geometry::Planar => "a planar case",
        LoadLaw::Ellipsoid if geometry != Geometry::Spatial => "a case in three dimensions",
        _ if is_stokes && !is_slow => "a fluid with inertia",
        _ if is_slow && !is_stokes => "a fluid without inertia, model = \"stokes\"",
        _ => return,
    };
    let help = "\"links\" and \"ebt\" in the plane and \"ellipsoid\" in space, \"fossen\" in both; \
                \"resistive\" and \"connection\" without inertia";
    findings.error("reduced.loads", format!("the law \"{name}\" is for {wanted}"), help);
}

/// Elongated-body theory is of a chain with a tail and a height.
fn elongated(findings: &mut Findings<'_>, spec: &ReducedSpec) {
    let name = spec.loads.name();
    if spec.loads != LoadLaw::Ebt {
        if spec.depth.is_some() {
            let message = format!("the law \"{name}\" has no height across the plane");
            findings.error("reduced.depth", message, "leave it out, or write loads = \"ebt\"");
        }
        return;
    }
    match spec.depth {
        None => {
            let message = "elongated-body theory needs the height of the body".to_owned();
            findings.error("reduced.loads", message, "write reduced.depth, across the plane (m)");
        }
        Some(depth) if !(depth.is_finite() && depth > 0.0) => {
            findings.error("reduced.depth", format!("the height is {depth}"), "a number above 0");
        }
        Some(_) => {}
    }
    let model = findings.model();
    let joined = || model.joints.iter().filter(|joint| !model.hangs_on_laboratory(joint));
    let neighbours = |body: &Body| {
        joined().filter(|joint| joint.parent == body.name || joint.child == body.name).count()
    };
    let is_chain = model.bodies.len() > 1
        && joined().count() + 1 == model.bodies.len()
        && model.bodies.iter().all(|body| neighbours(body) < 3)
        && model.bodies.last().is_some_and(|body| neighbours(body) == 1);
    if !is_chain {
        let message = "elongated-body theory is of a chain of links from head to tail".to_owned();
        let help =
            "join the bodies in a row, the tail the last of them, or write loads = \"links\"";
        findings.error("reduced.loads", message, help);
    }
}

/// What the whole case has that no law of loads knows.
fn whole_case(findings: &mut Findings<'_>) {
    let case = findings.case();
    let present = [
        ("geometry", case.geometry == Geometry::Axisymmetric, "an axis: bodies turn about all"),
        ("contact", case.contact.is_some(), "contact"),
        ("flow", case.flow.is_some(), "a mean flow"),
        ("field", case.field.is_some(), "a field"),
        ("fluid.force", !case.fluid.force.is_empty(), "a force on the fluid"),
        ("initial", case.initial.is_some(), "a flow at the start"),
        ("probe", !case.probe.is_empty(), "a probe: there is no flow to be measured"),
        ("tracer", !case.tracer.is_empty(), "tracers: there is no flow to carry them"),
        ("scalar", !case.scalar.is_empty(), "scalars: there is no flow to carry them"),
        ("time.steady", matches!(case.time, TimeSettings::Steady(_)), "a steady flow"),
    ];
    for (key, is_there, what) in present {
        if is_there {
            let message = format!("the reduced model does not know {what}");
            findings.error(key, message, "leave it out, or run the full solver: --fidelity ale");
        }
    }
}

/// Sides that move the fluid; walls at rest are far away.
fn sides(findings: &mut Findings<'_>) {
    for (name, condition) in &findings.case().boundary {
        let moves = match condition {
            BoundaryCondition::NoSlip
            | BoundaryCondition::DoNothing
            | BoundaryCondition::TractionFree
            | BoundaryCondition::Symmetry
            | BoundaryCondition::Axis
            | BoundaryCondition::Periodic(_) => false,
            BoundaryCondition::Velocity { .. }
            | BoundaryCondition::Profile(_)
            | BoundaryCondition::Parabolic { .. }
            | BoundaryCondition::Developed { .. }
            | BoundaryCondition::Pressure { .. }
            | BoundaryCondition::Traction { .. }
            | BoundaryCondition::Shear { .. }
            | BoundaryCondition::WavingSheet { .. } => true,
        };
        if moves {
            findings.error(
                &format!("boundary.{name}"),
                "the reduced model has its fluid at rest far away".to_owned(),
                "a side that does not move, or the full solver: --fidelity ale",
            );
        }
    }
}
