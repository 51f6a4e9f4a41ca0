//! Problems of `body.spring`: springs that do nothing, and motions that do not follow them.

use crate::rules::Findings;
use crate::{Body, Lock, Motion, SpringSpec, TimeSettings};

pub fn check(findings: &mut Findings<'_>, key: &str, body: &Body) {
    let Some(spring) = &body.spring else { return };
    let key = format!("{key}.spring");
    if matches!(findings.case().time, TimeSettings::Steady(_)) {
        findings.error(
            &key,
            format!("\"{}\" is on a spring, which acts in unsteady runs only", body.name),
            "use [time.unsteady], or leave the spring out",
        );
    }
    if body.motion == Motion::Free {
        check_hold(findings, &key, body, spring);
    } else {
        findings.error(
            &key,
            format!("\"{}\" is on a spring, but is not free to follow it", body.name),
            "write motion = \"free\", with locked = [...] for motions it may not make",
        );
    }
}

/// Whether every number of the spring has something to act on.
fn check_hold(findings: &mut Findings<'_>, key: &str, body: &Body, spring: &SpringSpec) {
    let name = &body.name;
    let along = |axis: usize| {
        let is_given = |values: &[f64]| values.get(axis).is_some_and(|value| *value != 0.0);
        is_given(&spring.stiffness) || is_given(&spring.damping)
    };
    let turning = spring.torsion != 0.0 || spring.torsion_damping != 0.0;
    if !(along(0) || along(1) || along(2) || turning) {
        findings.warning(
            key,
            format!("the spring of \"{name}\" does nothing: all its numbers are 0"),
            "give it a stiffness, damping, torsion or torsion_damping, or leave it out",
        );
        return;
    }
    for (lock, acts, motion, keys) in [
        (Lock::X, along(0), "along x", "stiffness and damping"),
        (Lock::Y, along(1), "along y", "stiffness and damping"),
        (Lock::Z, along(2), "along z", "stiffness and damping"),
        (Lock::Rotation, turning, "against turning", "torsion and torsion_damping"),
    ] {
        if acts && body.locked.contains(&lock) {
            findings.warning(
                key,
                format!("the spring of \"{name}\" acts {motion}, where the body is locked"),
                &format!("set its {keys} there to 0, or unlock the motion"),
            );
        }
    }
    let is_stiff = spring.stiffness.iter().any(|value| *value != 0.0);
    for (name, is_idle, wanted) in [
        ("anchor", !spring.anchor.is_empty() && !is_stiff, "stiffness"),
        ("rest_angle", spring.rest_angle.is_some() && spring.torsion == 0.0, "torsion"),
        ("rest_orientation", spring.rest_orientation.is_some() && spring.torsion == 0.0, "torsion"),
    ] {
        if is_idle {
            findings.warning(
                &format!("{key}.{name}"),
                format!("`{name}` has no effect without `{wanted}`"),
                &format!("add {wanted} = ..., or leave it out"),
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{Case, Severity, check};

    /// Keys and messages of the problems of a case with these lines for its body.
    fn problems(lines: &str, severity: Severity) -> Vec<(String, String)> {
        let text = format!(
            "
title = 'A disc on a spring'
geometry = 'planar'
fluid = {{ model = 'stokes', viscosity = 1.0 }}
domain = {{ disc = {{ radius = 2.0 }} }}
boundary = {{ wall = 'no-slip' }}
mesh = {{ size = 0.2 }}
time = {{ unsteady = {{ step = 0.1, end = 1.0 }} }}
[[body]]
name = 'disc'
shape = {{ disc = {{ radius = 0.3 }} }}
center = [0.0, 0.0]
{lines}
"
        );
        let file = Case::parse("t.toml", &text, &[]).unwrap();
        let found = check(&file).into_iter().filter(|p| p.severity == severity);
        found.map(|problem| (problem.key, problem.message)).collect()
    }

    #[track_caller]
    fn assert_one(found: &[(String, String)], key: &str, message: &str) {
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(found[0].0, key);
        assert!(found[0].1.contains(message), "{found:?}");
    }

    #[test]
    fn a_spring_with_a_hold_is_right() {
        for spring in [
            "{ stiffness = [1.0, 0.0], damping = [0.0, 0.1], anchor = [0.1, 0.0] }",
            "{ torsion = 1.0, rest_angle = 0.3 }",
            "{ torsion_damping = 2.0 }",
        ] {
            let lines = format!("motion = 'free'\nspring = {spring}");
            assert_eq!(problems(&lines, Severity::Error), []);
            assert_eq!(problems(&lines, Severity::Warning), [], "{spring}");
        }
    }

    #[test]
    fn numbers_that_make_no_spring_are_refused() {
        for (spring, key, message) in [
            ("{ stiffness = [1.0] }", "stiffness", "has 1 number,"),
            ("{ stiffness = [1.0, -2.0] }", "stiffness.1", "is -2, but must not be negative"),
            ("{ damping = [-1.0, 0.0] }", "damping.0", "is -1, but must not be negative"),
            ("{ torsion = -1.0 }", "torsion", "is -1, but must not be negative"),
            ("{ torsion_damping = -1.0 }", "torsion_damping", "must not be negative"),
            ("{ stiffness = [1.0, 1.0], anchor = [1, 2, 3] }", "anchor", "has 3 numbers"),
        ] {
            let found = problems(&format!("motion = 'free'\nspring = {spring}"), Severity::Error);
            assert_one(&found, &format!("body.0.spring.{key}"), message);
        }
        let held = problems("motion = 'held'\nspring = { torsion = 1.0 }", Severity::Error);
        assert_one(&held, "body.0.spring", "is not free to follow it");
    }

    #[test]
    fn a_spring_without_a_hold_is_warned_about() {
        for (lines, key, message) in [
            ("spring = {}", "body.0.spring", "does nothing"),
            ("spring = { stiffness = [0.0, 0.0] }", "body.0.spring", "does nothing"),
            (
                "locked = ['x']\nspring = { stiffness = [1.0, 1.0] }",
                "body.0.spring",
                "acts along x",
            ),
            ("locked = ['y']\nspring = { damping = [0.0, 1.0] }", "body.0.spring", "acts along y"),
            (
                "locked = ['rotation']\nspring = { torsion = 1.0 }",
                "body.0.spring",
                "against turning",
            ),
            (
                "spring = { damping = [1.0, 1.0], anchor = [0.0, 0.0] }",
                "body.0.spring.anchor",
                "no effect without `stiffness`",
            ),
            (
                "spring = { torsion_damping = 1.0, rest_angle = 0.0 }",
                "body.0.spring.rest_angle",
                "no effect without `torsion`",
            ),
            ("load_frame = 'body'", "body.0.load_frame", "no force or torque"),
        ] {
            let found = problems(&format!("motion = 'free'\n{lines}"), Severity::Warning);
            assert_one(&found, key, message);
        }
    }
}
