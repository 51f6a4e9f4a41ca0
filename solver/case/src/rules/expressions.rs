//! Problems of expressions and of the numbers they use: every one of a case, with the character where it fails.

use super::Findings;
use crate::spec::formula::mistake_in_name;
use crate::{CaseExpression, FlowModel, Initial, TimeSettings};

pub fn check(findings: &mut Findings<'_>) {
    let case = findings.case();
    for name in case.define.keys() {
        if let Some(mistake) = mistake_in_name(name) {
            findings.error(
                &format!("define.{name}"),
                format!("a number of [define] cannot be called `{name}`"),
                &mistake,
            );
        }
    }
    for one in case.flow_expressions() {
        check_one(findings, &one);
    }
    if case.initial.is_some() {
        if matches!(&case.time, TimeSettings::Unsteady(time) if time.initial == Initial::Stokes) {
            findings.error(
                "initial",
                "a run starts from a flow of its own or from the Stokes flow".to_owned(),
                "leave `initial` or `time.unsteady.initial` out",
            );
        }
        let is_unsteady = matches!(case.time, TimeSettings::Unsteady(_));
        if !is_unsteady || case.fluid.model == FlowModel::Stokes {
            findings.error(
                "initial",
                "only unsteady flows with inertia start from a flow of their own".to_owned(),
                "leave it out, or take [time.unsteady] and the model \"navier-stokes\"",
            );
        }
    }
}

/// Whether an expression is understood, and is a number at the middle of the domain at time zero.
pub(super) fn check_one(findings: &mut Findings<'_>, expression: &CaseExpression<'_>) {
    let (case, CaseExpression { key, formula, .. }) = (findings.case(), expression);
    match formula.parsed(&case.define, case.geometry.dimensions()) {
        Err(error) => findings.error(
            key,
            format!("{formula} at character {}: {}", error.column, error.found),
            &error.accepted,
        ),
        Ok(parsed) if parsed.is_constant() && !parsed.at(&[0.0; 4]).is_finite() => findings.error(
            key,
            format!("{formula} is {}", parsed.at(&[0.0; 4])),
            "write an expression of a finite value",
        ),
        Ok(_) => {}
    }
}

#[cfg(test)]
mod tests {
    use crate::{Case, check};

    const CASE: &str = r#"
title = "t"
geometry = "planar"
fluid = { model = "stokes", viscosity = 1.0 }
domain.channel = { length = 2.0, height = 1.0 }
mesh.size = 0.5
time.steady = {}
define.u_max = 1.5
[boundary]
left.velocity.value = ["4*u_max*y*(1-y)", 0]
right = "do-nothing"
bottom = "no-slip"
top = "no-slip"
"#;

    fn first(setting: &str) -> Option<String> {
        let file = Case::parse("t.toml", CASE, &[setting.to_owned()]).unwrap();
        check(&file).first().map(|found| format!("{} {} {}", found.key, found.message, found.help))
    }

    #[test]
    fn expressions_are_checked_where_they_are_written() {
        assert_eq!(first("title=u"), None);
        for (setting, words) in [
            (
                "boundary.left.velocity.value=['4*umax*y', 0]",
                "value.0 \"4*umax*y\" at character 3: there is no `umax` did you mean `u_max`",
            ),
            (
                "boundary.left.velocity.value=[1.0, 'z']",
                "value.1 \"z\" at character 1: there is no `z`",
            ),
            (
                "boundary.right={ pressure = { value = '1 +' } }",
                "boundary.right.pressure.value \"1 +\" at character 4",
            ),
            ("boundary.right={ traction = { value = [0.0, 'sin y'] } }", "traction.value.1"),
            ("fluid.force=['1/0', 0]", "fluid.force.0 \"1/0\" is inf"),
            ("initial.velocity=[1.0, 0.0]", "initial only unsteady flows"),
            ("define.sin=1.0", "define.sin a number of [define] cannot be called `sin`"),
            ("boundary.left.velocity.value=['y']", "has 1 number"),
            ("boundary.left={ developed = { flux = 1.0, peak = 2.0 } }", "one of them"),
            ("boundary.left={ developed = {} }", "one of them"),
        ] {
            let found = first(setting).unwrap_or_else(|| panic!("{setting} is accepted"));
            assert!(found.contains(words), "{setting}: {found}");
        }
        let located = CASE.replace("4*u_max*y", "4*u_max*w");
        let file = Case::parse("t.toml", &located, &[]).unwrap();
        let place = check(&file)[0].location.clone().unwrap();
        assert_eq!((place.line, place.column), (10, 24));
    }
}
