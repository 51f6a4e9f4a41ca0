//! Problems of `[time]`.

use super::Findings;
use crate::{
    Adaptive, BoundaryCondition, ContactSpec, FlowModel, Motion, Scheme, TimeSettings, Unsteady,
    Until,
};

/// Distance of end / step from a whole number above which the last step is not a whole one.
const WHOLE_STEPS: f64 = 1e-6;

pub fn check(findings: &mut Findings<'_>) {
    let case = findings.case();
    match &case.time {
        TimeSettings::Steady(_) => {
            if case.fluid.model == FlowModel::UnsteadyStokes {
                findings.error(
                    "time.steady",
                    "the model `unsteady-stokes` has no steady solution of its own".to_owned(),
                    "use [time.unsteady], or write model = \"stokes\", to which it tends",
                );
            }
            if case.fluid.model == FlowModel::NavierStokes {
                steady_frame(findings);
            }
        }
        TimeSettings::Unsteady(unsteady) => {
            let steps = unsteady.end / unsteady.step;
            if steps > 0.0 && steps < 1.0 {
                findings.error(
                    "time.unsteady.step",
                    format!("the step {} is longer than the run, {}", unsteady.step, unsteady.end),
                    "lower the step, or raise time.unsteady.end",
                );
            } else if unsteady.adaptive.is_none()
                && steps > 0.0
                && steps.is_finite()
                && (steps - steps.round()).abs() > WHOLE_STEPS * steps
            {
                findings.warning(
                    "time.unsteady.step",
                    format!("the step does not divide the end: {steps:.4} steps"),
                    &format!("write step = {}", unsteady.end / steps.ceil()),
                );
            }
            if let Some(adaptive) = &unsteady.adaptive {
                adaptive_steps(findings, unsteady, adaptive);
            }
            if let Some(until) = &unsteady.until {
                check_until(findings, until);
            }
        }
    }
}

/// Numbers that choose the steps.
fn adaptive_steps(findings: &mut Findings<'_>, unsteady: &Unsteady, adaptive: &Adaptive) {
    let key = |name: &str| format!("time.unsteady.adaptive.{name}");
    if unsteady.scheme == Scheme::Bdf1 {
        findings.error(
            "time.unsteady.scheme",
            "the error of a step is known for the schemes `bdf2` and `rk3` only".to_owned(),
            "write scheme = \"bdf2\", or give time.unsteady.step and leave [time.unsteady.adaptive] out",
        );
    }
    let step = unsteady.step;
    if let Some(largest) = adaptive.largest.filter(|largest| *largest > 0.0 && *largest < step) {
        findings.error(
            &key("largest"),
            format!("the largest step, {largest}, is shorter than the first one, {step}"),
            "raise it, or lower time.unsteady.step",
        );
    }
    if let Some(smallest) = adaptive.smallest.filter(|smallest| *smallest > step) {
        findings.error(
            &key("smallest"),
            format!("the smallest step, {smallest}, is longer than the first one, {step}"),
            "lower it, or raise time.unsteady.step",
        );
    }
}

/// Bodies leave through a side that is open, before contact keeps them from it.
fn check_until(findings: &mut Findings<'_>, until: &Until) {
    let key = format!("time.unsteady.{}", until.key());
    let case = findings.case();
    if !case.boundary.values().any(BoundaryCondition::is_open) {
        findings.error(
            &key,
            "no side is open, so that no body can leave".to_owned(),
            "write \"do-nothing\" or \"traction-free\" for one, or leave `until` out",
        );
    }
    let free = findings.model().bodies.iter().any(|body| body.motion == Motion::Free);
    if !free || !findings.model().mesh_moves() {
        findings.error(
            &key,
            "no body is free to leave".to_owned(),
            "write motion = \"free\" for one, or leave `until` out",
        );
    }
    let range = case.contact.as_ref().map_or(0.0, ContactSpec::range);
    if until.distance() <= range {
        findings.error(
            &key,
            format!("contact acts within {range}, and open sides are walls for it"),
            "write a larger distance, about the edge length on the bodies and more",
        );
    }
}

/// A flow around a travelling body is steady only as seen from the body.
fn steady_frame(findings: &mut Findings<'_>) {
    let model = findings.model();
    let frame = model.frame_body();
    for (index, body) in model.bodies.iter().enumerate() {
        if body.translates(model.case.geometry) && frame != Some(index) {
            findings.warning(
                &format!("body.{index}.motion"),
                format!("a flow with inertia around the travelling body \"{}\" is steady only as seen from it", body.name),
                &format!("write frame = \"{}\" at the top", body.name),
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{Case, check};

    /// Keys of the errors in a case of a free disc in a channel, with some settings.
    fn wrong(settings: &[&str]) -> Vec<String> {
        let text = "title = 't'
geometry = 'planar'
fluid = { model = 'stokes', viscosity = 1.0 }
domain.channel = { length = 8.0, height = 4.0 }
boundary = { left = { parabolic = { peak = 1.0 } }, right = 'do-nothing', bottom = 'no-slip', top = 'no-slip' }
mesh = { size = 0.3 }
time.unsteady = { step = 0.1, end = 1.0, until = { one-leaves = 0.5 } }
contact.quadratic = { range = 0.1, epsilon = 1e-3 }
body = [{ name = 'b', shape.disc.radius = 0.5, center = [2.0, 2.0], motion = 'free' }]
";
        let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
        let file = Case::parse("t.toml", text, &settings).unwrap();
        let errors =
            check(&file).into_iter().filter(|found| found.severity == crate::Severity::Error);
        errors.map(|found| found.key).collect()
    }

    #[test]
    fn bodies_leave_through_open_sides_before_contact_keeps_them() {
        let key = "time.unsteady.until.one-leaves";
        assert!(wrong(&[]).is_empty(), "{:?}", wrong(&[]));
        assert!(wrong(&["time.unsteady.until={ all-leave = 0.5 }"]).is_empty());
        for setting in [
            "boundary.right={ parabolic = { peak = -1.0 } }",
            "contact.quadratic.range=0.5",
            "body.0.motion='held'",
            "time.unsteady.until.one-leaves=-1.0",
        ] {
            assert!(wrong(&[setting]).contains(&key.to_owned()), "{setting}");
        }
    }
}
