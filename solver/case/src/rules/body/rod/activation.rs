//! Problems of `activation`, and of strokes that move rods: rates that jump, bends that fold, waves of what is not known.

use super::slender::{Slender, rises_along, too_sharp};
use crate::rules::body::joints::stroke as numbers_of_stroke;
use crate::rules::{Findings, OneOf};
use crate::{Activation, Stroke, TimeSettings};

/// Part of the run that is rounding.
const ROUNDING: f64 = 1e-9;

/// Numbers of an activation.
pub fn check(findings: &mut Findings<'_>, key: &str, active: &Activation, body: Slender) {
    let of = OneOf {
        what: "an activation",
        names: ["curvature", "moment"],
        given: [
            active.curvature.is_some() || active.curvature_y.is_some(),
            active.moment.is_some() || active.moment_y.is_some(),
        ],
        help: "curvature = ... (1/m) is what the rod would have at rest, moment = ... (N m; N planar) what bends it",
    };
    findings.one_of(key, &of);
    if !active.envelope.is_empty() {
        rises_along(findings, &format!("{key}.envelope"), &active.envelope, body);
    }
    for (name, given) in [
        ("curvature", &active.curvature),
        ("moment", &active.moment),
        ("curvature_y", &active.curvature_y),
        ("moment_y", &active.moment_y),
    ] {
        let Some(given) = given else { continue };
        // What bends from within may jump, at the start as later: moments stay finite
        numbers_of_stroke(findings, &format!("{key}.{name}"), given);
        if let Some(speed) = active.wave_speed {
            is_known_along(findings, key, name, given, body.length / speed);
        }
    }
    for (name, given) in [("curvature", &active.curvature), ("curvature_y", &active.curvature_y)] {
        if let Some(curvature) = given {
            sharpness(findings, &format!("{key}.{name}"), active, curvature, body);
        }
    }
}

/// A stroke by which the end of a rod is moved.
pub fn moved(findings: &mut Findings<'_>, key: &str, stroke: &Stroke) {
    numbers_of_stroke(findings, key, stroke);
    has_rate(findings, key, stroke);
}

/// Rates of a motion that jump would need infinite loads of a body with mass.
fn has_rate(findings: &mut Findings<'_>, key: &str, stroke: &Stroke) {
    let name = match stroke {
        Stroke::Table(_) => "a `table`",
        Stroke::Legs { smooth: false, .. } => "`legs` of straight lines",
        _ => return,
    };
    findings.error(
        key,
        format!("the rate of {name} jumps, and a rod that is held by it cannot follow that"),
        "write a `sine`, a `file`, or `legs` with smooth = true",
    );
}

/// A wave needs its stroke at other times than that of the run, by a delay (s) at the tail.
fn is_known_along(findings: &mut Findings<'_>, key: &str, name: &str, stroke: &Stroke, delay: f64) {
    let end = match &findings.case().time {
        TimeSettings::Steady(_) => 0.0,
        TimeSettings::Unsteady(time) => time.end,
    };
    match stroke {
        Stroke::Command(_) if delay < 0.0 => findings.error(
            &format!("{key}.wave_speed"),
            "a wave from tail to head would need what will be asked for later".to_owned(),
            "write a positive wave_speed, or leave it out",
        ),
        Stroke::Cubic(knots) => {
            let [from, to] = [-delay.max(0.0), end - delay.min(0.0)];
            let (Some([first, ..]), Some([last, ..])) = (knots.first(), knots.last()) else {
                return;
            };
            let rounding = ROUNDING * (to - from);
            if *first > from + rounding || *last < to - rounding {
                findings.error(
                    &format!("{key}.{name}.cubic"),
                    format!(
                        "its times go from {first} to {last}, and the wave along the body needs it from {from} to {to}"
                    ),
                    "give values for all these times, or a faster wave",
                );
            }
        }
        _ => {}
    }
}

/// The body is not bent more sharply than it is thick.
fn sharpness(
    findings: &mut Findings<'_>,
    key: &str,
    active: &Activation,
    curvature: &Stroke,
    body: Slender,
) {
    let factor = active.envelope.iter().map(|row| row[1].abs()).fold(0.0, f64::max);
    let factor = if active.envelope.is_empty() { 1.0 } else { factor };
    let range = match (curvature, &findings.case().time) {
        // It goes on for ever, and the run does not
        (Stroke::Steady { start, .. }, TimeSettings::Unsteady(time)) => {
            [*start, curvature.at(time.end)[0]]
        }
        _ => curvature.range(),
    };
    let sharpest = factor * range.map(f64::abs).into_iter().fold(0.0, f64::max);
    if sharpest.is_finite() {
        too_sharp(findings, key, sharpest, body, "at its sharpest");
    } else if curvature.command().is_some() {
        findings.error(
            &format!("{key}.command.limits"),
            "any curvature may be asked for, and one above that of its thickness folds the body"
                .to_owned(),
            &format!("write limits = [lowest, highest] within {}", 1.0 / body.half_width),
        );
    }
}
