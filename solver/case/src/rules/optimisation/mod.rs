//! Problems of `[optimisation]`: what is made large, by which numbers, and what the optimum is compared with.

mod constant;
mod constraints;
mod known;
mod parameters;

use self::constant::check_constant;
use self::known::check_known;
pub use self::parameters::{check_fitted, check_starts};
use super::Findings;
use crate::read::CaseFile;
use crate::spec::formula::mistake_in_name;
use crate::text::nearest::nearest;
use crate::{
    FlowConstraint, FlowObjective, FlowOptimisation, NoGradientInTime, ObjectiveExpression,
    TimeSettings, no_gradient_in_time,
};

pub fn check(findings: &mut Findings<'_>, file: &CaseFile) {
    let Some(spec) = &findings.case().optimisation else { return };
    if findings.case().is_searched_reduced() {
        check_motion(findings);
    } else if let Some(NoGradientInTime { key, message, help }) =
        no_gradient_in_time(findings.case())
    {
        let help = format!("{help}; with [reduced] the gradient is that of the reduced model");
        findings.error(key, format!("[optimisation] follows gradients, and {message}"), &help);
    }
    check_objective(findings, &spec.objective);
    parameters::check(findings, file, &spec.parameter);
    constraints::check(findings, spec);
    if spec.search.evaluations == 0 {
        let key = "optimisation.search.evaluations";
        findings.error(key, format!("`{key}` is 0"), "write 1 or more");
    }
    check_references(findings, file, spec);
}

/// Whether a reduced model makes steps of one length.
fn check_motion(findings: &mut Findings<'_>) {
    let (key, message) = match &findings.case().time {
        TimeSettings::Steady(_) => ("time.steady", "a reduced model has no steady flow"),
        TimeSettings::Unsteady(time) if time.adaptive.is_some() || !time.step.is_finite() => {
            ("time.unsteady", "the steps of a reduced model have one length")
        }
        TimeSettings::Unsteady(_) => return,
    };
    let message =
        format!("[optimisation] follows the gradient of the reduced model, and {message}");
    findings.error(key, message, "write [time.unsteady] with `step` and `end`");
}

/// Whether gradients are known of all quantities.
fn check_objective(findings: &mut Findings<'_>, objective: &FlowObjective) {
    for part in objective.quantities() {
        check_known(findings, &format!("optimisation.objective.{}", part.key), part.quantity);
    }
    if let FlowObjective::Expression(expression) = objective {
        check_expression(findings, expression);
    }
}

/// Whether an objective is understood.
fn check_expression(findings: &mut Findings<'_>, expression: &ObjectiveExpression) {
    let mut known = findings.case().define.clone();
    for name in expression.quantities.keys() {
        let key = format!("optimisation.objective.expression.quantities.{name}");
        let taken = "a number of [define] has this name";
        let is_taken = known.contains_key(name).then(|| taken.to_owned());
        if let Some(mistake) = mistake_in_name(name).or(is_taken) {
            let message = format!("a quantity cannot be called `{name}` in an expression");
            findings.error(&key, message, &mistake);
        }
        known.insert(name.clone(), 1.0);
    }
    check_constant(findings, "optimisation.objective.expression.value", &expression.value, &known);
}

fn check_references(findings: &mut Findings<'_>, file: &CaseFile, spec: &FlowOptimisation) {
    let mut known: Vec<String> = vec!["objective".to_owned()];
    known.extend(file.sought().into_iter().map(|number| number.name));
    known.extend(spec.objective.quantities().iter().map(|part| part.quantity.to_owned()));
    known.extend(spec.constraint.iter().map(FlowConstraint::name));
    for (index, reference) in spec.reference.iter().enumerate() {
        let at = format!("optimisation.reference.{index}");
        if !known.contains(&reference.quantity) {
            let meant = nearest(&reference.quantity, &known);
            let meant = meant.map(|name| format!("did you mean `{name}`? ")).unwrap_or_default();
            findings.error(
                &format!("{at}.quantity"),
                format!("an optimum has no `{}`", reference.quantity),
                &format!("{meant}it has {}", known.join(", ")),
            );
        }
        if reference.relative.is_some() == reference.absolute.is_some() {
            findings.error(
                &at,
                format!("the reference for `{}` has no single tolerance", reference.quantity),
                "write one of `relative` and `absolute`",
            );
        } else if reference.relative.is_some() && reference.value == 0.0 {
            findings.error(
                &format!("{at}.relative"),
                "no value but 0 is near 0 in relative terms".to_owned(),
                "write absolute = ... instead",
            );
        }
        if reference.source.trim().is_empty() {
            findings.error(
                &format!("{at}.source"),
                "the reference does not say where its value is from".to_owned(),
                "write who published it and where, or how it follows",
            );
        }
    }
}

#[cfg(test)]
mod tests;
