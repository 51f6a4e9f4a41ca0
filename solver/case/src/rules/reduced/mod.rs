//! Problems of `[reduced]`: coefficients that are none, and what no law of loads knows.

use std::collections::BTreeMap;

use super::Findings;
use crate::text::nearest::nearest;
use crate::{
    Body, BoundaryCondition, CaseFile, Diagnostic, FlowModel, Geometry, JointKind, LoadLaw, Motion,
    ReducedSpec, ShapeSpec, TimeSettings,
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
    whole_case(findings);
    sides(findings);
    for (index, body) in findings.model().bodies.iter().enumerate() {
        let key = format!("body.{index}");
        rigid_alone(findings, &key, body);
        shape(findings, &key, body);
    }
    joints(findings, &spec);
    one_tree(findings);
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
    if spec.added_mass.is_some() && spec.loads != LoadLaw::Ellipsoid {
        findings.error(
            "reduced.added_mass",
            format!("the law \"{}\" has a coefficient in its place", spec.loads.name()),
            "leave it out, or write loads = \"ellipsoid\"",
        );
    }
}

fn table(findings: &mut Findings<'_>, law: LoadLaw, key: &str, values: &BTreeMap<String, f64>) {
    let known: Vec<&str> = law.coefficients().iter().map(|one| one.name).collect();
    for (name, value) in values {
        let key = format!("{key}.{name}");
        if !known.contains(&name.as_str()) {
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
    let wanted = match spec.loads {
        LoadLaw::Links if geometry != Geometry::Planar => "a planar case",
        LoadLaw::Ellipsoid if geometry != Geometry::Spatial => "a case in three dimensions",
        LoadLaw::Links | LoadLaw::Ellipsoid if is_stokes => "a fluid with inertia",
        LoadLaw::Resistive if !is_stokes => "a fluid without inertia, model = \"stokes\"",
        _ => return,
    };
    let help = "\"links\" in the plane and \"ellipsoid\" in space, \"resistive\" without inertia";
    findings.error("reduced.loads", format!("the law \"{name}\" is for {wanted}"), help);
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

/// A body is rigid, and nothing pulls at it but its joints and the fluid.
fn rigid_alone(findings: &mut Findings<'_>, key: &str, body: &Body) {
    let is_loaded = |values: &[f64]| values.iter().any(|value| *value != 0.0);
    let present = [
        ("gait", body.gait.is_some(), "gaits by slip or by an outline that deforms"),
        ("rod", body.rod.is_some(), "elastic rods"),
        ("attached", body.attached.is_some(), "bodies that are attached"),
        ("spring", body.spring.is_some(), "springs to a place"),
        ("force", is_loaded(&body.force), "forces from outside"),
        ("torque", is_loaded(&body.torque.0), "torques from outside"),
        ("locked", !body.locked.is_empty(), "locked motions"),
        ("motion", matches!(body.motion, Motion::Imposed(_)), "imposed motions"),
        ("motion", !body.driven.is_empty(), "motions given by axis"),
        ("mass", body.mass.is_some(), "masses apart from a density"),
        ("inertia", body.inertia.is_some(), "inertia apart from a density"),
        ("center_of_mass", is_loaded(&body.center_of_mass), "centres of mass apart from the shape"),
        ("velocity", is_loaded(&body.velocity), "velocities at the start"),
        ("angular_velocity", is_loaded(&body.angular_velocity.0), "velocities at the start"),
    ];
    for (name, is_there, what) in present {
        if is_there {
            findings.error(
                &format!("{key}.{name}"),
                format!("the reduced model does not know {what}: \"{}\" has them", body.name),
                "rigid bodies on joints, free or held, or the full solver: --fidelity ale",
            );
        }
    }
}

/// In space masses and loads are those of ellipsoids.
fn shape(findings: &mut Findings<'_>, key: &str, body: &Body) {
    let is_ellipsoid = matches!(
        body.shape,
        ShapeSpec::Sphere { .. } | ShapeSpec::Spheroid { .. } | ShapeSpec::Ellipsoid { .. }
    );
    if findings.case().geometry == Geometry::Spatial && !is_ellipsoid {
        findings.error(
            &format!("{key}.shape"),
            format!("the reduced model takes ellipsoids for bodies: \"{}\" is none", body.name),
            "a sphere, a spheroid or an ellipsoid",
        );
    }
}

/// Joints of one coordinate that do as they are told.
fn joints(findings: &mut Findings<'_>, spec: &ReducedSpec) {
    for (index, joint) in findings.model().joints.iter().enumerate() {
        let key = format!("joint.{index}.kind");
        let child = &joint.child;
        if findings.model().hangs_on_laboratory(joint) {
            findings.error(
                &format!("joint.{index}.parent"),
                format!("the reduced model does not know joints to the laboratory: that of \"{child}\" is one"),
                "motion = \"held\" for the first body, or the full solver: --fidelity ale",
            );
        }
        let what = match &joint.kind {
            JointKind::Ball(_) => "turn about all axes",
            JointKind::Hinge(_) | JointKind::Slider(_) if spec.loads == LoadLaw::Resistive => {
                "are free without inertia"
            }
            _ => continue,
        };
        findings.error(
            &key,
            format!("the reduced model does not know joints that {what}: that of \"{child}\" does"),
            "bent or arm, with inertia hinge or slider, or the full solver: --fidelity ale",
        );
    }
}

/// All bodies hang together.
fn one_tree(findings: &mut Findings<'_>) {
    let model = findings.model();
    let roots: Vec<usize> =
        (0..model.bodies.len()).filter(|body| model.joint_above(*body).is_none()).collect();
    let message = match roots[..] {
        [_] => return,
        [] => "the reduced model needs a body".to_owned(),
        [_, second, ..] => format!(
            "the reduced model has one swimmer and knows no flow between several: \"{}\" is \
             not joined to \"{}\"",
            model.bodies[second].name, model.bodies[roots[0]].name
        ),
    };
    let key = roots.get(1).map_or_else(|| "body".to_owned(), |body| format!("body.{body}"));
    findings.error(&key, message, "one tree of bodies, or the full solver: --fidelity ale");
}
