//! Problems of buoyancy and thrusters of a reduced model.

use crate::rules::Findings;
use crate::rules::body::joints::stroke;
use crate::{FlowModel, ReducedSpec, ThrusterSpec};

pub fn check(findings: &mut Findings<'_>, spec: &ReducedSpec) {
    for (name, buoyancy) in &spec.buoyancy {
        let key = format!("reduced.buoyancy.{name}");
        is_a_body(findings, &key, name);
        if let Some(volume) = buoyancy.volume.filter(|one| !(one.is_finite() && *one >= 0.0)) {
            let message = format!("the displaced volume is {volume}");
            findings.error(&format!("{key}.volume"), message, "a number of 0 or more");
        }
        if !buoyancy.center.is_empty() {
            vector(findings, &format!("{key}.center"), &buoyancy.center);
        }
    }
    for (index, thruster) in spec.thruster.iter().enumerate() {
        let key = format!("reduced.thruster.{index}");
        if spec.thruster[..index].iter().any(|other| other.name == thruster.name) {
            let message = format!("two thrusters are called \"{}\"", thruster.name);
            findings.error(&format!("{key}.name"), message, "give each its own name");
        }
        check_thruster(findings, &key, thruster);
    }
}

fn check_thruster(findings: &mut Findings<'_>, key: &str, thruster: &ThrusterSpec) {
    if findings.case().fluid.model == FlowModel::Stokes {
        findings.error(
            key,
            "thrusters need a fluid with inertia".to_owned(),
            "leave it out, or take fluid.model = \"navier-stokes\"",
        );
    }
    is_a_body(findings, &format!("{key}.body"), &thruster.body);
    if !thruster.position.is_empty() {
        vector(findings, &format!("{key}.position"), &thruster.position);
    }
    let direction = format!("{key}.direction");
    if vector(findings, &direction, &thruster.direction)
        && thruster.direction.iter().all(|part| *part == 0.0)
    {
        let help = "write a vector along its positive force, of any length";
        findings.error(&direction, "the direction has no length".to_owned(), help);
    }
    if thruster.curve.is_empty() || !thruster.curve.iter().all(|one| one.is_finite()) {
        let message = "the curve needs numbers".to_owned();
        let help = "write curve = [F1, F3, ...]: the force is F1 V + F3 V^3 + ...";
        findings.error(&format!("{key}.curve"), message, help);
    }
    stroke(findings, &format!("{key}.drive"), &thruster.drive);
    if let Some(lag) = thruster.lag {
        let is_finite = lag.numerator.iter().all(|one| one.is_finite());
        if !(is_finite && lag.is_stable()) {
            findings.error(
                &format!("{key}.lag.denominator"),
                format!("a lag of {:?} over {:?} does not settle", lag.numerator, lag.denominator),
                "positive a0, a1 and a2 with a1 a2 above a0",
            );
        }
    }
}

/// Whether there is such a body, which is told where there is none.
pub fn is_a_body(findings: &mut Findings<'_>, key: &str, name: &str) {
    if findings.model().body_index(name).is_some() {
        return;
    }
    let bodies = &findings.model().bodies;
    let names: Vec<&str> = bodies.iter().take(20).map(|body| body.name.as_str()).collect();
    let help = format!("bodies: {}", names.join(", "));
    findings.error(key, format!("there is no body \"{name}\""), &help);
}

/// Whether a vector has a finite number for each dimension, which is told where it has not.
pub fn vector(findings: &mut Findings<'_>, key: &str, values: &[f64]) -> bool {
    let is_right = findings.is_vector(values) && values.iter().all(|one| one.is_finite());
    if !is_right {
        let n = findings.case().geometry.dimensions();
        let message = format!("{values:?} is not {n} numbers");
        findings.error(key, message, "write one number per dimension of the case");
    }
    is_right
}
