//! Problems of title, geometry, domain and frame of reference.

use super::Findings;
use crate::rules::flow::given_mesh;
use crate::spec::units::{UnitLabel, defect};
use crate::text::type_error::suggestion;
use crate::{DomainSpec, Units};

pub fn check(findings: &mut Findings<'_>) {
    let case = findings.case();
    if case.title.trim().is_empty() {
        findings.warning(
            "title",
            "the title is empty".to_owned(),
            "say what is solved in one line",
        );
    }
    check_units(findings);
    check_domain(findings);
    check_frame(findings);
}

/// Units are words that can stand behind a number.
fn check_units(findings: &mut Findings<'_>) {
    let Units::Labels(labels) = &findings.case().units else { return };
    let help = "write a short word such as \"um\", \"mm\", \"s\", \"ms\" or \"pN\"";
    if labels.each().iter().all(|label| label.unit.is_none()) {
        findings.error(
            "units",
            "`units` names no unit".to_owned(),
            "write a text, such as \"SI\", or labels: { length = \"um\", time = \"s\", force = \"pN\" }",
        );
    }
    for UnitLabel { key, unit } in labels.each() {
        let key = format!("units.{key}");
        match unit {
            Some("") => findings.error(&key, format!("`{key}` is empty"), help),
            Some(unit) => {
                if let Some(defect) = defect(unit) {
                    findings.error(&key, format!("`{key}` is \"{unit}\", which {defect}"), help);
                }
            }
            None => {}
        }
    }
}

/// The domain has an inside.
fn check_domain(findings: &mut Findings<'_>) {
    match &findings.case().domain {
        DomainSpec::Box { min, max } => {
            let are_corners = findings.is_vector(min) && findings.is_vector(max);
            if are_corners && min.iter().zip(max).any(|(low, high)| high <= low) {
                findings.error(
                    "domain.box.max",
                    format!("the box from {min:?} to {max:?} is empty"),
                    "all numbers of `max` must be larger than those of `min`",
                );
            }
        }
        DomainSpec::Cylinder { x, .. } if x[1] <= x[0] => findings.error(
            "domain.cylinder.x",
            format!("the cylinder from {} to {} is empty", x[0], x[1]),
            "write x = [start, end] with start < end",
        ),
        DomainSpec::Mesh(_) | DomainSpec::Surface(_) => given_mesh::check(findings),
        _ => {}
    }
}

/// The frame travels with a body or a swimmer.
fn check_frame(findings: &mut Findings<'_>) {
    let (case, model) = (findings.case(), findings.model());
    if let (Some(name), None) = (&case.frame, model.frame_body()) {
        let bodies = model.bodies.iter().map(|body| body.name.as_str());
        let swimmers = model.swimmers.iter().map(|swimmer| swimmer.name.as_str());
        let names: Vec<&str> = bodies.chain(swimmers).collect();
        findings.error(
            "frame",
            format!("`frame` is \"{name}\", but no body or swimmer has that name"),
            &suggestion(name, &names),
        );
    }
}
