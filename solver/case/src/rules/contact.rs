//! Problems of `[contact]`: laws too weak or of long range, and cases without contact.

use super::Findings;
use crate::model::speed::weight;
use crate::{ContactSpec, Convection, Lock, Motion, TimeSettings};

/// Range over half the least width of a body above which contact is no short-range force.
const SHORT_RANGE: f64 = 0.5;

pub fn check(findings: &mut Findings<'_>) {
    let case = findings.case();
    let (key, range) = match case.contact {
        None => return,
        Some(ContactSpec::Quadratic { range, .. }) => ("contact.quadratic.range", range),
        Some(ContactSpec::Barrier { range, .. }) => ("contact.barrier.range", range),
    };
    check_range(findings, key, range);
    match &case.time {
        TimeSettings::Steady(_) => findings.error(
            "contact",
            "a steady solution knows no contact".to_owned(),
            "use [time.unsteady], or leave [contact] out",
        ),
        TimeSettings::Unsteady(unsteady) => {
            if unsteady.convection == Convection::Newton {
                findings.error(
                    "time.unsteady.convection",
                    "contact is solved together with extrapolated convection only".to_owned(),
                    "write convection = \"extrapolated\", or leave [contact] out",
                );
            }
            check_yielding(findings);
            check_strength(findings, &case.contact);
        }
    }
}

/// A range is small beside the bodies, or they feel each other from afar.
fn check_range(findings: &mut Findings<'_>, key: &str, range: f64) {
    let widths = findings.model().bodies.iter().map(|body| (body.shape.half_width(), &body.name));
    let Some((width, name)) = widths.min_by(|one, other| one.0.total_cmp(&other.0)) else { return };
    if width > 0.0 && range > SHORT_RANGE * width {
        findings.warning(
            key,
            format!("the range {range} of contact is large beside \"{name}\", {width:.3} thin"),
            "about the edge length on the bodies is usual",
        );
    }
}

/// Contact needs a body that gives way.
fn check_yielding(findings: &mut Findings<'_>) {
    let case = findings.case();
    let motions: &[Lock] = case.geometry.motions();
    let yields = findings.model().bodies.iter().any(|body| {
        body.motion == Motion::Free && motions.iter().any(|lock| !body.locked.contains(lock))
    });
    if !yields {
        findings.warning(
            "contact",
            "contact has no effect: no body is free to give way".to_owned(),
            "leave [contact] out, or write motion = \"free\"",
        );
    } else if !findings.model().mesh_moves() {
        findings.warning(
            "contact",
            "contact has no effect: nothing moves as seen from the frame".to_owned(),
            "leave [contact] out, or leave `frame` out",
        );
    }
}

/// A law that cannot hold a body against gravity, or only in a film that no mesh resolves.
fn check_strength(findings: &mut Findings<'_>, contact: &Option<ContactSpec>) {
    let case = findings.case();
    // At a hundredth of the range.
    let (key, greatest) = match *contact {
        Some(ContactSpec::Quadratic { range, epsilon }) => {
            ("contact.quadratic.epsilon", range * range / epsilon)
        }
        Some(ContactSpec::Barrier { range, stiffness }) => {
            let (gap, short) = (0.01f64, 0.99f64);
            let force = short * short / gap - 2.0 * short * gap.ln();
            ("contact.barrier.stiffness", stiffness * range * force)
        }
        None => return,
    };
    for body in &findings.model().bodies {
        let weight = weight(case, body);
        if body.motion == Motion::Free && greatest > 0.0 && greatest < weight {
            findings.warning(
                key,
                format!(
                    "contact can hold {greatest:.3e} at a hundredth of its range, and \"{}\" \
                     weighs {weight:.3e} less its buoyancy",
                    body.name
                ),
                "make the law stronger: it carries a body at half its range when that is its force \
                 there",
            );
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{Case, ContactSpec, Diagnostic, Severity, check};

    const CASE: &str = "
title = 'A disc in a box'
geometry = 'planar'
fluid = { model = 'stokes', viscosity = 1.0 }
domain = { box = { min = [-1.0, -1.0], max = [1.0, 1.0] } }
mesh = { size = 0.2 }
[time.unsteady]
step = 0.1
end = 1.0
[boundary]
left = 'no-slip'
right = 'no-slip'
bottom = 'no-slip'
top = 'no-slip'
[[body]]
name = 'disc'
shape = { disc = { radius = 0.3 } }
center = [0.0, 0.0]
motion = 'free'
[contact.quadratic]
range = 0.03
epsilon = 1e-6
";

    /// Problems of the case with these settings, and with another contact if one is given.
    fn problems(settings: &[&str], contact: Option<ContactSpec>) -> Vec<Diagnostic> {
        let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
        let mut file = Case::parse("t.toml", CASE, &settings).unwrap();
        file.model.case.contact = contact.or(file.model.case.contact);
        check(&file)
    }

    /// Keys and messages of the errors of a case with this contact.
    fn errors(contact: ContactSpec) -> Vec<(String, String)> {
        let errors =
            problems(&[], Some(contact)).into_iter().filter(|p| p.severity == Severity::Error);
        errors.map(|problem| (problem.key, problem.message)).collect()
    }

    #[test]
    fn contact_is_refused_where_it_is_not_solved() {
        assert_eq!(problems(&[], None), []);
        for (setting, key, message) in [
            ("time.steady={}", "contact", "a steady solution knows no contact"),
            ("time.unsteady.convection=newton", "time.unsteady.convection", "extrapolated"),
        ] {
            let found = problems(&[setting], None);
            assert_eq!(found.len(), 1, "{found:?}");
            assert_eq!((found[0].key.as_str(), found[0].severity), (key, Severity::Error));
            assert!(found[0].message.contains(message), "{found:?}");
        }
    }

    #[test]
    fn contact_without_effect_or_of_long_range_is_warned_about() {
        for (settings, key, message) in [
            (["body.0.motion=held"].as_slice(), "contact", "no body is free"),
            (&["body.0.locked=['x', 'y', 'rotation']"], "contact", "no body is free"),
            (&["contact.quadratic.range=0.16"], "contact.quadratic.range", "0.300 thin"),
            (
                &[
                    "body.0.shape={ellipse={semi_axes=[0.5, 0.05]}}",
                    "contact={barrier={range=0.03, stiffness=1.0}}",
                ],
                "contact.barrier.range",
                "0.050 thin",
            ),
        ] {
            let mut found = problems(settings, None);
            // That a body with all locks is held is told besides
            found.retain(|one| one.key != "body.0.locked");
            assert_eq!(found.len(), 1, "{found:?}");
            assert_eq!((found[0].key.as_str(), found[0].severity), (key, Severity::Warning));
            assert!(found[0].message.contains(message), "{found:?}");
        }
    }

    #[test]
    fn numbers_that_are_not_positive_are_refused() {
        assert_eq!(errors(ContactSpec::Quadratic { range: 0.03, epsilon: 1e-6 }), []);
        assert_eq!(errors(ContactSpec::Barrier { range: 0.03, stiffness: 10.0 }), []);
        let refused = |contact, key: &str, value: &str| {
            let wanted = (key.to_owned(), format!("`{key}` is {value}, but must be positive"));
            assert_eq!(errors(contact), [wanted]);
        };
        let quadratic = |range, epsilon| ContactSpec::Quadratic { range, epsilon };
        refused(quadratic(0.0, 1e-6), "contact.quadratic.range", "0");
        refused(quadratic(0.03, -1.0), "contact.quadratic.epsilon", "-1");
        let barrier = |range, stiffness| ContactSpec::Barrier { range, stiffness };
        refused(barrier(-0.03, 10.0), "contact.barrier.range", "-0.03");
        refused(barrier(0.03, 0.0), "contact.barrier.stiffness", "0");
    }
}
