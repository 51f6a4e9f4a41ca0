//! Problems of `[field]` and of the magnetic moments it turns.

mod moments;
mod parts;
mod strokes;
#[cfg(test)]
mod tests;

use self::strokes::strokes;
use super::Findings;
use crate::{MagneticSpec, Scheme, TimeSettings};

/// Turns of a field in a step above which it is warned of.
const MOST_TURNED: f64 = 0.1;

/// Step times the rate at which a field turns a magnet in slow flow above which the explicit scheme may overshoot; it is
/// stable below 2.5.
const MOST_EXPLICIT: f64 = 1.0;

pub fn check(findings: &mut Findings<'_>) {
    moments::check(findings);
    let Some(field) = &findings.case().field else { return };
    let Some(magnetic) = &field.magnetic else {
        findings.error(
            "field",
            "`field` has no field in it".to_owned(),
            "write field.magnetic = { ... }, or leave it out",
        );
        return;
    };
    parts::check(findings, magnetic);
    if !findings.is_right("field") {
        return;
    }
    moments::check_effect(findings);
    if findings.model().bodies.iter().all(|body| body.magnetic_moment.is_empty()) {
        findings.warning(
            "field.magnetic",
            "the magnetic field turns nothing: no body has a magnetic moment".to_owned(),
            "write magnetic_moment = [...] for a body, or leave the field out",
        );
    }
    in_time(findings, magnetic);
}

/// What the field does in time beside the steps of the run.
fn in_time(findings: &mut Findings<'_>, field: &MagneticSpec) {
    let rotating = field.rotating.as_ref();
    let own = rotating.map(|one| ("field.magnetic.rotating".to_owned(), one.frequency));
    match &findings.case().time {
        TimeSettings::Steady(_) => {
            let varying = strokes(field).into_iter().filter(|one| super::drive::moves(one.stroke));
            for key in own.map(|(key, _)| key).into_iter().chain(varying.map(|one| one.key)) {
                findings.error(
                    &key,
                    "the field changes in time, and a steady flow has no time".to_owned(),
                    "use [time.unsteady], or write constants: what they do to bodies as they lie is a steady flow",
                );
            }
        }
        TimeSettings::Unsteady(time) if time.adaptive.is_none() => {
            let step = time.step;
            let periodic = strokes(field).into_iter();
            let periodic = periodic.filter_map(|one| Some((one.key, 1.0 / one.stroke.period()?)));
            let all = own.into_iter().chain(periodic);
            for (key, frequency) in all.filter(|(_, frequency)| frequency * step > MOST_TURNED) {
                findings.warning(
                    &key,
                    format!("a step of {step} is {:.3} of a period of the field", frequency * step),
                    &format!("write time.unsteady.step = {:.3e} or less", 0.02 / frequency),
                );
            }
            if time.scheme == Scheme::Rk3 {
                explicit_steps(findings, field, step);
            }
        }
        TimeSettings::Unsteady(_) => {}
    }
}

/// The explicit scheme of fixed steps follows magnets that turn slowly.
fn explicit_steps(findings: &mut Findings<'_>, field: &MagneticSpec, step: f64) {
    let model = findings.model();
    let rates = model.bodies.iter().map(|body| model.magnetic_rate(field, body));
    let fastest = rates.fold(0.0, f64::max);
    if fastest * step > MOST_EXPLICIT {
        findings.error(
            "time.unsteady.scheme",
            format!(
                "the scheme `rk3` cannot be used: the field may turn a magnet by {:.2} rad in a step",
                fastest * step
            ),
            &format!(
                "leave `scheme` out for `bdf2`, which takes the torque implicitly, write \
                 [time.unsteady.adaptive], or a step of {:.2e} or less",
                MOST_EXPLICIT / fastest
            ),
        );
    }
}
