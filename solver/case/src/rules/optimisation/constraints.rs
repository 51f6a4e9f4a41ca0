//! Problems of what a search holds: what it is, its value, and how far it may be off.

use super::known::check_known;
use crate::rules::Findings;
use crate::text::nearest::nearest;
use crate::{FlowConstraint, FlowOptimisation, Geometry, ShapeSpec};

pub fn check(findings: &mut Findings<'_>, spec: &FlowOptimisation) {
    for (index, constraint) in spec.constraint.iter().enumerate() {
        let at = format!("optimisation.constraint.{index}");
        check_what(findings, &at, constraint);
        let limits = constraint.limits();
        if limits.len() != 1 {
            let message = format!("the constraint has {} of three values", limits.len());
            findings.error(&at, message, "write one of `equals`, `at_most` and `at_least`");
        }
        if let (Some(_), Some(limit)) = (&constraint.volume, limits.first())
            && limit.value <= 0.0
        {
            let message = format!("a volume is held at {}", limit.value);
            findings.error(&at, message, "write a number above 0");
        }
    }
}

/// Whether what is held is known.
fn check_what(findings: &mut Findings<'_>, at: &str, constraint: &FlowConstraint) {
    match (&constraint.quantity, &constraint.volume) {
        (Some(quantity), None) => check_known(findings, &format!("{at}.quantity"), quantity),
        (None, Some(body)) => check_volume(findings, &format!("{at}.volume"), body),
        (both, _) => {
            let found = if both.is_some() { "two things" } else { "nothing" };
            let message = format!("the constraint holds {found}");
            findings.error(at, message, "write one of `quantity` and `volume = \"BODY\"`");
        }
    }
}

/// Whether a body has a volume that is known from its shape.
fn check_volume(findings: &mut Findings<'_>, key: &str, name: &str) {
    let bodies: Vec<String> =
        findings.model().bodies.iter().map(|body| body.name.clone()).collect();
    let Some(body) = findings.model().bodies.iter().find(|body| body.name == name) else {
        let meant = nearest(name, &bodies).map(|name| format!("did you mean `{name}`? "));
        let help = format!("{}bodies are {}", meant.unwrap_or_default(), bodies.join(", "));
        findings.error(key, format!("there is no body `{name}`"), &help);
        return;
    };
    let unknown = match body.shape {
        ShapeSpec::Union(_) => "its parts overlap",
        ShapeSpec::Revolved { .. } if findings.case().geometry == Geometry::Spatial => {
            "in space that of a turned profile is known to some per cent only"
        }
        _ => return,
    };
    let message = format!("the volume of `{name}` is not known: {unknown}");
    findings.error(key, message, "hold that of a body of another shape");
}
