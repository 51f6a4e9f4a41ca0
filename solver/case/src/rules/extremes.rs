//! Numbers that cannot be computed with, and lengths and times too far apart from each other.

use super::Findings;
use crate::model::speed::norm;
use crate::{CaseFile, TimeSettings};

/// Numbers above this, or below its inverse: their squares and cubes are no numbers any more.
const HUGE: f64 = 1e90;

/// Thickness of a body over the diagonal of the domain below which positions lose it to rounding.
const THINNEST: f64 = 1e-9;

/// Distance of the domain from the origin over its diagonal above which rounding bends surfaces.
const FARTHEST: f64 = 1e9;

/// Most steps of a run.
const MOST_STEPS: f64 = 1e9;

/// Most cycles of a run.
const MOST_CYCLES: f64 = 1e6;

/// Numbers as they are written; those that are none let no other check make sense.
pub fn check_numbers(findings: &mut Findings<'_>, file: &CaseFile) {
    for number in file.numbers() {
        let (key, value) = (&number.path, number.value);
        if !value.is_finite() {
            findings.error(
                key,
                format!("`{key}` is not a finite number"),
                "write a number such as 0.5 or 1e-3",
            );
        } else if value != 0.0 && !(1.0 / HUGE..HUGE).contains(&value.abs()) {
            findings.error(
                key,
                format!(
                    "`{key}` is {value:e}, and its powers are beyond what can be computed with"
                ),
                "choose units in which the numbers of the case are nearer to 1",
            );
        }
    }
}

/// Lengths beside the domain, and times beside the step.
pub fn check(findings: &mut Findings<'_>, file: &CaseFile) {
    lengths(findings);
    times(findings, file);
}

fn lengths(findings: &mut Findings<'_>) {
    let (case, model) = (findings.case(), findings.model());
    let extent = case.extent();
    let diagonal = norm(&extent.lengths());
    let distance = extent.min.iter().chain(&extent.max).fold(0.0f64, |most, x| most.max(x.abs()));
    if distance > FARTHEST * diagonal {
        findings.error(
            "domain",
            format!(
                "the domain is {diagonal:.3e} wide and {distance:.3e} from the origin, where \
                 rounding bends its surfaces"
            ),
            "move domain and bodies to the origin",
        );
    }
    // Nothing is made of the domain that stands for one that is left out
    if findings.case().is_reduced_only() {
        return;
    }
    let mut last = None;
    for (index, body) in model.bodies.iter().enumerate() {
        // Of a swimmer and its copies one body says it all
        let swimmer = model.swimmer_of_body(index);
        let width = body.shape.half_width();
        if width <= 0.0 || width >= THINNEST * diagonal || (swimmer.is_some() && swimmer == last) {
            continue;
        }
        last = swimmer;
        findings.error(
            &format!("body.{index}.shape"),
            format!(
                "\"{}\" is {width:.3e} thin in a domain of {diagonal:.3e}: less than {THINNEST:e} of \
                 it, and lost to rounding",
                body.name
            ),
            "make the body larger, or the domain smaller",
        );
    }
}

fn times(findings: &mut Findings<'_>, file: &CaseFile) {
    let TimeSettings::Unsteady(unsteady) = &findings.case().time else { return };
    let (step, end) = (unsteady.step, unsteady.end);
    if step <= 0.0 || end <= 0.0 {
        return;
    }
    if end / step > MOST_STEPS {
        // Where the number stands that is farther from 1
        let (key, shown) = if end * step > 1.0 { ("end", end) } else { ("step", step) };
        findings.error(
            &format!("time.unsteady.{key}"),
            format!("with `{key}` = {shown:e} the run would have {:.1e} steps", end / step),
            &format!(
                "write end = {:.1e} or less, or step = {:.1e} or more, for {MOST_STEPS:e} steps",
                step * MOST_STEPS,
                end / MOST_STEPS
            ),
        );
        return;
    }
    let is_fixed = unsteady.adaptive.is_none();
    let periods = file.numbers().into_iter().filter(|number| number.path.ends_with(".period"));
    for number in periods.filter(|number| number.value != 0.0) {
        let (key, period) = (&number.path, number.value.abs());
        if is_fixed && period < step {
            findings.error(
                key,
                format!("`{key}` is {:e}, shorter than a step of {step:e}", number.value),
                "lower time.unsteady.step to a tenth of the period or less, or raise the period",
            );
        } else if end / period > MOST_CYCLES {
            findings.error(
                key,
                format!(
                    "`{key}` is {:e}: {:.1e} cycles to the end are more than {MOST_CYCLES:e}",
                    number.value,
                    end / period
                ),
                "raise the period, or lower time.unsteady.end",
            );
        }
    }
}
