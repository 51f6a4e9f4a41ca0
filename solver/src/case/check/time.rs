//! Problems of `[time]`.

use super::Findings;
use crate::case::{Model, TimeSettings};

/// Distance of end / step from a whole number above which the last step is not a whole one.
const WHOLE_STEPS: f64 = 1e-6;

pub fn check(findings: &mut Findings<'_>) {
    let case = findings.case();
    match &case.time {
        TimeSettings::Steady(steady) => {
            if case.fluid.model == Model::UnsteadyStokes {
                findings.error(
                    "time.steady",
                    "the model `unsteady-stokes` has no steady solution of its own".to_owned(),
                    "march with [time.unsteady], or write model = \"stokes\", to which it settles",
                );
            }
            findings.positive("time.steady.tolerance", steady.tolerance);
            if steady.tolerance >= 1.0 {
                findings.error(
                    "time.steady.tolerance",
                    format!("a residual {} times the first one is no solution", steady.tolerance),
                    "write a number below 1, such as 1e-11",
                );
            }
            if steady.max_iterations == 0 {
                findings.error(
                    "time.steady.max_iterations",
                    "no iterations are allowed".to_owned(),
                    "write 1 or more; 25 is usual",
                );
            }
            if case.fluid.model == Model::NavierStokes {
                steady_frame(findings);
            }
        }
        TimeSettings::Unsteady(unsteady) => {
            findings.positive("time.unsteady.step", unsteady.step);
            findings.positive("time.unsteady.end", unsteady.end);
            let steps = unsteady.end / unsteady.step;
            if steps > 0.0 && steps < 1.0 {
                findings.error(
                    "time.unsteady.step",
                    format!("the step {} is longer than the run, {}", unsteady.step, unsteady.end),
                    "lower the step, or raise time.unsteady.end",
                );
            } else if steps.is_finite() && (steps - steps.round()).abs() > WHOLE_STEPS * steps {
                findings.warning(
                    "time.unsteady.step",
                    format!("the step does not divide the end: {steps:.4} steps"),
                    &format!("write step = {}", unsteady.end / steps.ceil()),
                );
            }
        }
    }
}

/// A flow around a travelling body is steady only as seen from the body.
fn steady_frame(findings: &mut Findings<'_>) {
    let case = findings.case();
    for (index, body) in case.body.iter().enumerate() {
        if body.translates() && case.frame.as_deref() != Some(body.name.as_str()) {
            findings.warning(
                &format!("body.{index}.motion"),
                format!("a flow with inertia around the travelling body \"{}\" is steady only as seen from it", body.name),
                &format!("write frame = \"{}\" at the top", body.name),
            );
        }
    }
}
