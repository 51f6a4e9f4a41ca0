//! What bodies and joints of a case have that no law of loads knows: each is refused by its key.

use crate::rules::Findings;
use crate::{
    Body, FlowModel, Geometry, JointKind, LoadFrame, Lock, Model, Motion, ReducedSpec, ShapeSpec,
};

/// What helps where nothing else does.
const FULL: &str = "leave it out, or run the full solver: --fidelity ale";

pub fn check(findings: &mut Findings<'_>, spec: &ReducedSpec) {
    for (index, body) in findings.model().bodies.iter().enumerate() {
        let key = format!("body.{index}");
        rigid(findings, &key, body);
        pulled(findings, &key, body, spec);
        guided(findings, &key, index, body);
        shape(findings, &key, body);
    }
    weight(findings);
    joints(findings, spec);
    one_tree(findings);
}

fn is_slow(findings: &Findings<'_>) -> bool {
    findings.case().fluid.model == FlowModel::Stokes
}

/// A body is rigid.
fn rigid(findings: &mut Findings<'_>, key: &str, body: &Body) {
    let present = [
        ("gait", body.gait.is_some(), "gaits by slip or by an outline that deforms"),
        ("rod", body.rod.is_some(), "elastic rods"),
        ("attached", body.attached.is_some(), "bodies that are attached"),
    ];
    for (name, is_there, what) in present {
        if is_there {
            findings.error(
                &format!("{key}.{name}"),
                format!("the reduced model does not know {what}: \"{}\" has them", body.name),
                "rigid bodies on joints, or the full solver: --fidelity ale",
            );
        }
    }
}

/// Forces from outside: without inertia only those that turn with the swimmer, which it then goes steadily by.
fn pulled(findings: &mut Findings<'_>, key: &str, body: &Body, spec: &ReducedSpec) {
    let is_loaded = |values: &[f64]| values.iter().any(|value| *value != 0.0);
    let of_table = spec.loads == crate::LoadLaw::Connection;
    let is_fixed = body.load_frame == LoadFrame::Laboratory;
    if !(is_slow(findings) && (is_fixed || of_table)) {
        return;
    }
    let (what, help) = if of_table {
        ("a connection has no forces", FULL)
    } else {
        (
            "without inertia the reduced model knows forces that turn with the body only",
            "write load_frame = \"body\", take a fluid with inertia, or --fidelity ale",
        )
    };
    for (name, values) in [("force", &body.force[..]), ("torque", &body.torque.0[..])] {
        if is_loaded(values) {
            let message = format!("{what}: \"{}\" has a {name}", body.name);
            findings.error(&format!("{key}.{name}"), message, help);
        }
    }
}

/// The body that all hang on may be guided in the plane, and in space where it does not turn freely.
fn guided(findings: &mut Findings<'_>, key: &str, index: usize, body: &Body) {
    let model = findings.model();
    let name = &body.name;
    let is_root = is_root(model, index) && model.joint_above(index).is_none();
    let is_imposed = matches!(body.motion, Motion::Imposed(_));
    let turns_freely = !is_imposed && !body.locked.contains(&Lock::Rotation);
    // What is written may say how each motion is
    let written = findings.case().body.get(index);
    let is_by_axis = written.is_some_and(|own| matches!(own.motion, Motion::ByAxis(_)));
    let locked = if is_by_axis { "motion" } else { "locked" };
    let present = [
        (locked, !body.locked.is_empty() && body.driven.is_empty(), "locked motions"),
        ("motion", is_imposed || !body.driven.is_empty(), "given motions"),
        ("spring", body.spring.is_some(), "springs to a place"),
    ];
    for (below, is_there, what) in present {
        let why = if !is_there {
            continue;
        } else if !is_root {
            "of bodies that hang on others"
        } else if is_slow(findings) {
            "without inertia"
        } else if findings.case().geometry == Geometry::Spatial && turns_freely {
            "of bodies that turn freely in space"
        } else {
            continue;
        };
        findings.error(
            &format!("{key}.{below}"),
            format!("the reduced model does not know {what} {why}: \"{name}\" has them"),
            "in the plane, or in space with a rotation that is held or given, and with inertia; or \
             the full solver: --fidelity ale",
        );
    }
    let spring = body.spring.as_ref();
    if is_root && spring.is_some_and(|spring| spring.torsion != 0.0 && !turns_freely) {
        let message = format!("\"{name}\" does not turn freely, and its spring has a torsion");
        findings.error(&format!("{key}.spring.torsion"), message, "leave it out");
    }
}

/// Without inertia the reduced model has no weight.
fn weight(findings: &mut Findings<'_>) {
    let case = findings.case();
    let has_gravity = case.fluid.gravity.iter().any(|part| *part != 0.0);
    if !(is_slow(findings) && has_gravity) {
        return;
    }
    let is_heavy = |body: &&Body| {
        body.mass.is_some() || body.density.is_some_and(|one| one != case.fluid.density)
    };
    if let Some(body) = findings.model().bodies.iter().find(is_heavy) {
        let message = format!(
            "without inertia the reduced model does not know weight: \"{}\" has another than the \
             fluid",
            body.name
        );
        findings.error("fluid.gravity", message, FULL);
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

/// Joints of one coordinate.
fn joints(findings: &mut Findings<'_>, spec: &ReducedSpec) {
    for (index, joint) in findings.model().joints.iter().enumerate() {
        let what = match &joint.kind {
            JointKind::Ball(_) => "turn about all axes",
            JointKind::Hinge(_) | JointKind::Slider(_) if spec.loads.is_without_inertia() => {
                "are free without inertia"
            }
            _ => continue,
        };
        let child = &joint.child;
        findings.error(
            &format!("joint.{index}.kind"),
            format!("the reduced model does not know joints that {what}: that of \"{child}\" does"),
            "bent or arm, with inertia hinge or slider, or the full solver: --fidelity ale",
        );
    }
}

/// Whether a body hangs on no other.
fn is_root(model: &Model, body: usize) -> bool {
    model.joint_above(body).is_none_or(|joint| model.hangs_on_laboratory(&model.joints[joint]))
}

/// All bodies hang together.
fn one_tree(findings: &mut Findings<'_>) {
    let model = findings.model();
    let roots: Vec<usize> = (0..model.bodies.len()).filter(|body| is_root(model, *body)).collect();
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
